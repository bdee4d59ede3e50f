// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/schemas/safetensors.h"

namespace doorforge {
namespace {

constexpr const char* kPpoState = "training.safetensors";
constexpr const char* kPpoKind = "doorforge.ppo";

// Calls visit(name, vector) for all flat vectors.
template <class State, class Visit>
void VisitPpoVectors(State& state, const Visit& visit) {
  visit("actor", state.networks.actor);
  visit("log_deviation", state.networks.log_deviation);
  visit("critic", state.networks.critic);
  visit("adam.first", state.first_moment);
  visit("adam.second", state.second_moment);
}

std::vector<double> NumbersOf(const std::vector<PpoUpdate>& updates) {
  std::vector<double> numbers;
  for (const PpoUpdate& update : updates)
    for (const PpoColumn& column : PpoColumns()) numbers.push_back(update.*column.value);
  return numbers;
}

std::vector<PpoUpdate> UpdatesOf(const std::vector<double>& numbers) {
  std::vector<PpoUpdate> updates(numbers.size() / PpoColumns().size());
  auto number = numbers.begin();
  for (PpoUpdate& update : updates)
    for (const PpoColumn& column : PpoColumns()) update.*column.value = *number++;
  return updates;
}

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

void WritePpoState(const std::filesystem::path& folder, const PpoState& state,
                   const PpoOrigin& origin) {
  TensorFile file;
  VisitPpoVectors(state, [&](const std::string& name, const std::vector<float>& values) {
    file.tensors[name] = MakeTensor<float>(values, {values.size()});
  });
  const std::vector<double> numbers = NumbersOf(state.updates);
  file.tensors["updates"] =
      MakeTensor<double>(numbers, {state.updates.size(), PpoColumns().size()});
  file.tensors["gradient_steps"] = MakeTensor<std::int64_t>(
      std::vector<std::int64_t>{static_cast<std::int64_t>(state.gradient_steps)}, {1});
  file.metadata = {
      {"kind", kPpoKind}, {"config", origin.config}, {"doors_sha256", origin.doors_sha256}};
  file.metadata["content_sha256"] = ContentHashOf(file);
  CommitFile(folder / kPpoState, EncodeTensors(file));
}

bool HasPpoState(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / kPpoState);
}

PpoState ReadPpoState(const std::filesystem::path& folder, const PpoOrigin& expected,
                      PpoState initial) {
  const std::string path = (folder / kPpoState).string();
  const TensorFile file = ReadTensors(path);
  if (WordOf(file, "kind") != kPpoKind)
    throw Error(ErrorCode::kFormat, path + ": not the state of a ppo training");
  if (WordOf(file, "content_sha256") != ContentHashOf(file))
    throw Error(ErrorCode::kFormat, path +
                                        ": damaged: its content is not what its own SHA-256 says; "
                                        "put back a copy, or train again with --overwrite");
  RequireOrigin(file, expected, path);
  PpoState state = std::move(initial);
  VisitPpoVectors(state, [&](const std::string& name, std::vector<float>& values) {
    values = ValuesOf<float>(TensorNamed(file, name, path), {values.size()}, path);
  });
  const Tensor& updates = TensorNamed(file, "updates", path);
  const std::uint64_t count = updates.shape.empty() ? 0 : updates.shape[0];
  state.updates = UpdatesOf(ValuesOf<double>(updates, {count, PpoColumns().size()}, path));
  state.gradient_steps = static_cast<std::uint64_t>(
      ValuesOf<std::int64_t>(TensorNamed(file, "gradient_steps", path), {1}, path)[0]);
  return state;
}

}  // namespace doorforge
