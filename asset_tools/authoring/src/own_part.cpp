// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "own_part.h"

#include <cmath>
#include <system_error>

#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/importers/import_objects.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr double kShortestHandle = 0.02;  // [m]
constexpr double kLongestHandle = 0.6;

// messages of import name its flags: --unit is --handle-unit here
std::string WithFlags(std::string message, PartRole role) {
  const std::string prefix = role == PartRole::kHandle ? "--handle-" : "--body-";
  for (const char* flag : {"unit", "size", "scale", "up", "front", "mount", "mechanism", "rose",
                           "license", "hinge", "frame"}) {
    const std::string name = std::string("--") + flag;
    for (std::size_t at = 0; (at = message.find(name, at)) != std::string::npos;
         at += prefix.size())
      message.replace(at, 2, prefix);
  }
  return message;
}

ErrorCode CodeOf(ImportOutcome outcome) {
  if (outcome == ImportOutcome::kIncomplete) return ErrorCode::kMissing;
  return outcome == ImportOutcome::kStopped ? ErrorCode::kIncomplete : ErrorCode::kInvalidArgument;
}

const std::string& PartOf(const ImportedObject& object, PartRole role) {
  return role == PartRole::kHandle ? object.handle_id : object.body_id;
}

// the one object that has such a part
const ImportedObject& OnlyObject(const ImportReport& report, const OwnPartRequest& request) {
  const ImportedObject* only = nullptr;
  std::string names;
  for (const ImportedObject& object : report.objects) {
    if (object.outcome != ImportOutcome::kImported)
      throw Error(CodeOf(object.outcome), object.name + ": " + std::string(NameOf(object.outcome)) +
                                              ": " + WithFlags(object.message, request.role));
    if (PartOf(object, request.role).empty()) continue;
    names += ' ' + object.name;
    if (only != nullptr && PartOf(*only, request.role) == PartOf(object, request.role)) continue;
    if (only != nullptr)
      throw Error(ErrorCode::kInvalidArgument,
                  request.source.string() + ": holds several of role " +
                      std::string(NameOf(request.role)) + ":" + names +
                      "; import them with `doorforge import` and name one part");
    only = &object;
  }
  if (only == nullptr)
    throw Error(ErrorCode::kInvalidArgument, request.source.string() + ": holds nothing of role " +
                                                 std::string(NameOf(request.role)));
  return *only;
}

Eigen::Vector3d SizeOf(const Part& part) {
  Eigen::AlignedBox3d bounds;
  for (const PartPiece& piece : part.pieces) {
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) bounds.extend(vertex);
  }
  return bounds.sizes();
}

std::string Millimetres(double metres) { return std::to_string(std::lround(metres * 1000)); }

std::string SizeNote(const Part& part) {
  const Eigen::Vector3d size = SizeOf(part);
  return Millimetres(size.y()) + " mm along the door, " + Millimetres(size.z()) + " mm high, " +
         Millimetres(size.x()) + " mm out of it";
}

}  // namespace

OwnPart::OwnPart(const OwnPartRequest& request, const fs::path& beside, double max_seconds)
    : scratch_(fs::absolute(beside).lexically_normal().parent_path(), kPartFolder) {
  Import(request, max_seconds);
}

void OwnPart::Import(const OwnPartRequest& request, double max_seconds) {
  ImportConfig config;
  config.max_seconds = max_seconds;
  config.read.category = NameOf(request.category);
  config.read.mesh = request.mesh;
  config.read.mesh.role = NameOf(request.role);
  const ImportReport report =
      ImportObjects(FindObjects(request.source), scratch_.path(), config, Existing::kRefuse);
  const ImportedObject& object = OnlyObject(report, request);
  folder_ = scratch_.path() / PartOf(object, request.role);
  part_ = ReadPart(folder_);
  notes_ = {SizeNote(part_)};
  for (const std::string& note : object.notes) notes_.push_back(WithFlags(note, request.role));
  if (request.role != PartRole::kHandle) return;
  CheckLength();
  notes_.push_back("mechanism " + object.mechanism);
  if (!object.grasp_holds)
    notes_.emplace_back(
        "no grasp was found that holds it: check --handle-front and --handle-up, or whether "
        "fingers fit behind it");
}

void OwnPart::CheckLength() const {
  const double length = SizeOf(part_).maxCoeff();
  if (length >= kShortestHandle && length <= kLongestHandle) return;
  throw Error(ErrorCode::kInvalidArgument,
              part_.id + ": as read it is " + Millimetres(length) +
                  " mm long, where a handle is 20 to 600 mm; pass --handle-unit, or --handle-size "
                  "with its length in m");
}

void OwnPart::MoveTo(const fs::path& folder) {
  if (fs::exists(fs::symlink_status(folder)))
    throw Error(ErrorCode::kInvalidArgument, folder.string() + ": is there already");
  fs::rename(folder_, folder);
  folder_ = folder;
}

}  // namespace doorforge
