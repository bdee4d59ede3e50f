// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/read_model.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <set>

#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/parts/model_message.h"

namespace doorforge {
namespace {

// By the clock: long beyond what the processor time allows, for a machine that does much else.
constexpr double kMostSeconds = 600;
constexpr std::uint64_t kMostAnswerBytes = 1ULL << 30U;

std::string EndOf(int status) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return "reading it took longer than the 60 s of processor time allowed";
  if (WIFSIGNALED(status))
    return std::string("the reader crashed on it (") + ::strsignal(WTERMSIG(status)) + ")";
  return "the reader ended with exit code " + std::to_string(WEXITSTATUS(status)) +
         " and no result";
}

bool IsSound(const UrdfShape& shape) {
  const auto* own = std::get_if<UrdfTriangles>(&shape.geometry);
  if (own == nullptr) return true;
  const auto count = static_cast<int>(own->mesh.vertices.size());
  return std::all_of(
      own->mesh.triangles.begin(), own->mesh.triangles.end(),
      [&](const Eigen::Vector3i& t) { return t.minCoeff() >= 0 && t.maxCoeff() < count; });
}

bool IsSound(const UrdfLink& link) {
  const auto sound = [](const UrdfShape& shape) { return IsSound(shape); };
  return std::all_of(link.visuals.begin(), link.visuals.end(), sound) &&
         std::all_of(link.collisions.begin(), link.collisions.end(), sound);
}

bool AnyUnusable(const std::vector<UrdfFault>& faults) {
  return std::any_of(faults.begin(), faults.end(),
                     [](const UrdfFault& fault) { return fault.kind == UrdfFaultKind::kUnusable; });
}

bool JointsHaveLinks(const UrdfModel& model) {
  std::set<std::string> links;
  for (const UrdfLink& link : model.links) links.insert(link.name);
  return std::all_of(model.joints.begin(), model.joints.end(), [&](const UrdfJoint& joint) {
    return links.contains(joint.parent) && links.contains(joint.child);
  });
}

// What the readers promise, whatever a file holds.
bool IsSound(const ReadModelAnswer& answer, ModelFormat format) {
  const UrdfModel& model = answer.model;
  const bool promised = format == ModelFormat::kUrdf && !AnyUnusable(answer.faults);
  return std::all_of(model.links.begin(), model.links.end(),
                     [](const UrdfLink& link) { return IsSound(link); }) &&
         (!promised || JointsHaveLinks(model));
}

}  // namespace

UrdfModel ReadModelApart(const std::filesystem::path& file, ModelFormat format,
                         std::vector<UrdfFault>& faults) {
  const ChildAnswer child =
      AskChild({SiblingProgram("doorforge-read-model", "DOORFORGE_READ_MODEL"),
                std::to_string(::getpid()), "model", file.string(), std::string(NameOf(format))},
               {kMostSeconds, kMostAnswerBytes});
  const auto refuse = [&](const std::string& problem) {
    return Error(ErrorCode::kFormat, file.string() + ": " + problem);
  };
  if (child.too_long) throw refuse("what it holds takes more than the 1 GiB allowed");
  ReadModelAnswer answer;
  MessageReader message(child.message);
  message(answer);
  if (!message.AtEnd()) throw refuse(EndOf(child.status));
  if (answer.failed) throw Error(answer.code, answer.problem);
  if (!IsSound(answer, format)) throw refuse("the reader gave no sound result");
  faults = std::move(answer.faults);
  return std::move(answer.model);
}

UrdfModel ReadUrdfApart(const std::filesystem::path& file) {
  std::vector<UrdfFault> faults;
  UrdfModel model = ReadModelApart(file, ModelFormat::kUrdf, faults);
  if (AnyUnusable(faults)) throw Error(ErrorCode::kFormat, UrdfFaultsText(file.string(), faults));
  return model;
}

}  // namespace doorforge
