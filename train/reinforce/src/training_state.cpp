// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "training_state.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/program.h"

namespace doorforge::internal {
namespace {

// It covers the bytes of all tensors with their names, and what the state belongs to.
std::string ContentHashOf(const TensorFile& file) {
  Sha256 hash;
  const auto add = [&](const std::string& text) {
    hash.Update(std::to_string(text.size()) + ":");
    hash.Update(text);
  };
  for (const auto& [name, tensor] : file.tensors) {
    add(name);
    add(tensor.bytes);
  }
  for (const auto& [key, text] : file.metadata) {
    if (key == "content_sha256") continue;
    add(key);
    add(text);
  }
  return hash.HexDigest();
}

constexpr const char* kSamplesKey = "samples_sha256";

std::filesystem::path SamplesPath(const std::filesystem::path& folder, std::uint64_t round) {
  char name[40];
  std::snprintf(name, sizeof name, "round_%04llu.safetensors",
                static_cast<unsigned long long>(round));
  return folder / "samples" / name;
}

std::vector<std::string> WordsOf(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

std::string WordOf(const TensorFile& file, const std::string& key) {
  const auto found = file.metadata.find(key);
  return found == file.metadata.end() ? "" : found->second;
}

void RequireOrigin(const TensorFile& file, const PpoOrigin& given, const std::string& path) {
  const auto refuse = [&](const std::string& what, const std::string& difference) {
    throw Error(
        ErrorCode::kInvalidArgument,
        path + ": " + what +
            "; give what is recorded to go on, --overwrite to begin anew, or another --out" +
            difference);
  };
  const std::string config = WordOf(file, "config");
  if (config != given.config)
    refuse("this training has other settings", ConfigDifference(config, given.config));
  const std::string doors = WordOf(file, "doors_sha256");
  if (doors != given.doors_sha256)
    refuse("this training has other doors than --doors",
           "\n  sha256: recorded " + doors + ", given " + given.doors_sha256);
}

}  // namespace

std::string HashOfDoors(const std::vector<FoundDoor>& doors) {
  std::string text;
  for (const FoundDoor& door : doors) text += door.identity.id + " " + door.identity.sha256 + "\n";
  return Sha256Hex(text);
}

SeenParts PartsOfDoors(const std::vector<FoundDoor>& doors) {
  SeenParts parts;
  for (const FoundDoor& door : doors)
    parts = Union(parts, SeenParts{{door.identity.body}, {door.identity.handle}});
  return parts;
}

void RequireUnusedFolder(const std::filesystem::path& folder, bool resume, bool overwrite) {
  if (resume || overwrite) return;
  for (const char* file : {kTrainingState, "policy.safetensors"})
    Require(!std::filesystem::exists(folder / file), ErrorCode::kInvalidArgument,
            folder.string() +
                ": holds a training already; pass --resume to go on, or "
                "--overwrite to start anew");
}

std::function<bool()> StopAfter(double minutes) {
  return [start = std::chrono::steady_clock::now(), minutes] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    return StopRequested() != 0 || (minutes > 0 && elapsed.count() > 60 * minutes);
  };
}

std::string OutcomeHead(const std::vector<std::string>& notes, const std::filesystem::path& out,
                        std::size_t doors) {
  const auto place = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().string() + "\n";
  };
  std::string text;
  for (const std::string& note : notes) text += "note:       " + note + "\n";
  return text + "policy:     " + place(out) + "curves:     " + place(out / "training.html") +
         "doors:      " + std::to_string(doors) + "\n";
}

void WriteTrainingState(const std::filesystem::path& folder, const std::string& kind,
                        const PpoOrigin& origin, TensorFile file) {
  file.metadata["kind"] = kind;
  file.metadata["config"] = origin.config;
  file.metadata["doors_sha256"] = origin.doors_sha256;
  file.metadata["content_sha256"] = ContentHashOf(file);
  CommitFile(folder / kTrainingState, EncodeTensors(file));
}

TensorFile ReadTrainingState(const std::filesystem::path& folder, const std::string& kind,
                             const PpoOrigin& expected) {
  const std::string path = (folder / kTrainingState).string();
  TensorFile file = ReadTensors(path);
  if (WordOf(file, "kind") != kind)
    throw Error(ErrorCode::kFormat,
                path + ": not the state of a " + kind.substr(kind.find('.') + 1) + " training");
  if (WordOf(file, "content_sha256") != ContentHashOf(file))
    throw Error(ErrorCode::kFormat, path +
                                        ": damaged: its content is not what its own SHA-256 says; "
                                        "put back a copy, or train again with --overwrite");
  RequireOrigin(file, expected, path);
  return file;
}

std::string WriteRoundSamples(const std::filesystem::path& folder, std::uint64_t round,
                              const TensorFile& samples) {
  const std::string bytes = EncodeTensors(samples);
  CommitFile(SamplesPath(folder, round), bytes);
  return Sha256Hex(bytes);
}

std::uint64_t RoundSamples::Rows(const char* name) const {
  const Tensor& tensor = TensorNamed(file, name, path);
  return tensor.shape.empty() ? 0 : tensor.shape[0];
}

RoundSamples ReadRoundSamples(const std::filesystem::path& folder, std::uint64_t round,
                              const std::string& sha256) {
  const std::string path = SamplesPath(folder, round).string();
  const std::string bytes = ReadFile(path);
  if (Sha256Hex(bytes) != sha256)
    throw Error(ErrorCode::kFormat, path +
                                        ": damaged: its SHA-256 is not the one that the training "
                                        "recorded; put back a copy, or train again with "
                                        "--overwrite");
  return {path, DecodeTensors(bytes, path)};
}

void NoteSamples(const std::vector<std::string>& sha256, TensorFile& state) {
  std::string& words = state.metadata[kSamplesKey];
  for (const std::string& word : sha256) words += (words.empty() ? "" : " ") + word;
}

std::vector<std::string> NotedSamples(const TensorFile& state, std::size_t rounds,
                                      const std::string& path) {
  std::vector<std::string> words = WordsOf(WordOf(state, kSamplesKey));
  if (words.size() != rounds)
    throw Error(ErrorCode::kFormat, path + ": samples_sha256: not a hash for each round");
  return words;
}

}  // namespace doorforge::internal
