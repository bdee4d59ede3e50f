// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>

#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/confined_child.h"
#include "doorforge/core/error.h"
#include "doorforge/foreign/answer_parent.h"
#include "doorforge/mesh/confine.h"
#include "doorforge/parts/read_model.h"
#include "doorforge/schemas/glb.h"
#include "doorforge/schemas/mjcf.h"
#include "doorforge/schemas/sdf.h"
#include "doorforge/schemas/usda.h"

#include "apart/glb_apart.h"
#include "read/glb_file.h"
#include "read/raw_mesh.h"
#include "run/ask_urdfdom.h"
#include "run/text_message.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;
using Arguments = std::span<char* const>;

constexpr std::size_t kFixed = 4;  // the program, its parent, the work, the file
constexpr std::uint64_t kMostTextBytes = 16ULL << 20U;
constexpr std::uint64_t kMostBytes = 512ULL << 20U;
constexpr const char* kTooMuchMemory = "reading it takes more than the 2 GiB of memory allowed";

void Confine([[maybe_unused]] std::span<const fs::path> readable) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they need more of the system
  internal::ConfineToReading(readable);
#endif
}

UrdfModel ReadModel(const fs::path& file, ModelFormat format, std::vector<UrdfFault>& faults) {
  switch (format) {
    case ModelFormat::kMjcf:
      return ReadMjcf(file, faults);
    case ModelFormat::kSdf:
      return ReadSdf(file, faults);
    case ModelFormat::kUsda:
      return ReadUsda(file, faults);
    case ModelFormat::kGlb:
      return ReadGlb(file, faults);
    default:
      return ReadUrdf(file, faults);
  }
}

std::string ModelAnswer(const fs::path& file, std::string_view format) {
  ReadModelAnswer answer;
  try {
    answer.model = ReadModel(file, ValueNamed<ModelFormat>(format).value_or(ModelFormat::kUrdf),
                             answer.faults);
    return MessageOf(std::move(answer));
  } catch (const Error& error) {
    answer = {true, error.code(), error.what(), {}, {}};
  } catch (const std::bad_alloc&) {
    answer = {true, ErrorCode::kFormat, file.string() + ": " + kTooMuchMemory, {}, {}};
  }
  return MessageOf(std::move(answer));
}

std::string TrianglesAnswer(const fs::path& file) {
  GlbAnswer answer;
  try {
    answer.mesh = GlbTriangles(ReadFile(file, kMostBytes));
  } catch (const RawMeshFault& fault) {
    answer = {fault.what(), {}};
  } catch (const Error& error) {
    answer = {error.what(), {}};
  } catch (const std::bad_alloc&) {
    answer = {kTooMuchMemory, {}};
  }
  return MessageOf(std::move(answer));
}

// Folders above that package:// and model:// of the file may stand for, though they lie outside of
// the root: those whose names it holds behind these words. It is looked at as bytes, before the
// process gives up its rights.
std::vector<fs::path> PackagesAbove(const fs::path& file) {
  std::vector<fs::path> found;
  std::string text;
  try {
    text = ReadFile(file, kMostTextBytes);
  } catch (const Error&) {
    return found;  // whoever reads it says so
  }
  if (text.find("package://") == std::string::npos && text.find("model://") == std::string::npos)
    return found;
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    const std::string named = "://" + at.filename().string() + "/";
    if (text.find(named) != std::string::npos) found.push_back(at);
  }
  return found;
}

MeshFiles::Places PlacesIn(Arguments arguments, const fs::path& file) {
  MeshFiles::Places places;
  places.folder = fs::absolute(file).lexically_normal().parent_path();
  places.root = arguments[kFixed];
  for (const char* pair : arguments.subspan(kFixed + 2)) {
    const std::string text = pair;
    const std::size_t equal = text.find('=');
    if (equal != std::string::npos) places.packages[text.substr(0, equal)] = text.substr(equal + 1);
  }
  return places;
}

TextAnswer ReadWithin(const fs::path& file, const MeshFiles::Places& places) {
  TextAnswer answer;
  try {
    answer.read = ReadText(file, places, answer.faults);
  } catch (const std::bad_alloc&) {
    answer = {};
    answer.problem = kTooMuchMemory;
  } catch (const std::exception& error) {
    answer = {};
    answer.problem = error.what();
  }
  return answer;
}

bool IsForUrdfdom(const TextAnswer& answer) {
  constexpr std::size_t kMost = 2000;
  return answer.problem.empty() && answer.read.kind == ValidatedKind::kUrdf &&
         answer.read.after != AfterText::kNothing && !answer.faults.Has("FIL003") &&
         !answer.faults.Has("FIL004") && answer.read.object.links.size() <= kMost &&
         answer.read.object.joints.size() <= kMost;
}

// In two parts, so that a crash of urdfdom loses its opinion alone.
bool SendText(Arguments arguments, const fs::path& file) {
  const MeshFiles::Places places = PlacesIn(arguments, file);
  std::vector<fs::path> readable = PackagesAbove(file);
  readable.insert(readable.end(), {file, places.root});
  for (const auto& [name, folder] : places.packages) readable.push_back(folder);
  Confine(readable);
  TextAnswer answer = ReadWithin(file, places);
  const bool ask = std::string_view(arguments[kFixed + 1]) == "1" && IsForUrdfdom(answer);
  std::string part;
  try {
    part = MessageOf(std::move(answer));
  } catch (const std::bad_alloc&) {
    TextAnswer too_much;
    too_much.problem = kTooMuchMemory;
    part = MessageOf(std::move(too_much));
  }
  std::uint64_t length = part.size();
  if (!SendAnswer(MessageOf(length)) || !SendAnswer(part)) return false;
  return !ask || SendAnswer(OpinionOfUrdfdom(file));
}

bool Send(Arguments arguments) {
  const std::string_view work = arguments[2];
  const fs::path file = arguments[3];
  if (work == "text" && arguments.size() >= kFixed + 2) return SendText(arguments, file);
  Confine(std::array{file});
  if (work == "model" && arguments.size() > kFixed)
    return SendAnswer(ModelAnswer(file, arguments[kFixed]));
  return work == "triangles" && SendAnswer(TrianglesAnswer(file));
}

}  // namespace

int AnswerParent(Arguments arguments) {
  if (arguments.size() < kFixed) {
    std::fprintf(stderr, "doorforge-read-model is started by the other doorforge programs\n");
    return 2;
  }
  ConfineProcess({.parent = std::atoi(arguments[1])});
  // what was read is not taken apart again
  ::_exit(Send(arguments) ? 0 : 3);
}

}  // namespace doorforge::foreign
