// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "doorforge/core/error.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/json_file.h"

#include "import_format.h"
#include "subtask.h"
#include "urdf_objects/handle_part.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxMeshes = 256;

// the three kinds of handle, by the folder they lie in
struct HandleKind {
  const char* folder;
  const char* name;
  Mechanism mechanism;
  double metres_a_unit;  // of the meshes, which are in mm; DoorGym enlarges levers
};
constexpr std::array<HandleKind, 3> kKinds = {{{"leverknobs", "lever", Mechanism::kLever, 0.0015},
                                               {"roundknobs", "round", Mechanism::kRound, 0.001},
                                               {"pullknobs", "pull", Mechanism::kNone, 0.001}}};

bool IsDoorGym(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path / "info.json", error) &&
         fs::is_regular_file(path / "body_1.stl", error);
}

const HandleKind& KindOf(const fs::path& folder) {
  const std::string parent =
      (fs::absolute(folder).lexically_normal() / "x").parent_path().parent_path().filename();
  for (const HandleKind& kind : kKinds) {
    if (parent == kind.folder) return kind;
  }
  throw Error(ErrorCode::kInvalidArgument,
              folder.string() + ": lies in \"" + parent +
                  "\", which does not tell the kind of handle; DoorGym's folders are leverknobs, "
                  "roundknobs and pullknobs");
}

// file: z out of the door, x along it, y up
Eigen::Affine3d PartFromFile(double metres_a_unit) {
  const Eigen::Matrix3d turn = (Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
  return Eigen::Affine3d(turn * metres_a_unit);
}

std::vector<SourceMesh> MeshesOf(const fs::path& folder, const Json& record, double unit) {
  const std::string path = (folder / "info.json").string();
  const Json& names = MemberOf(record, "model_names", path);
  if (!names.is_array() || names.empty() || names.size() > kMaxMeshes)
    throw Error(ErrorCode::kFormat,
                path + ": model_names is no list of 1 to " + std::to_string(kMaxMeshes) + " names");
  std::vector<SourceMesh> meshes;
  std::string missing;
  for (const Json& name : names) {
    if (!name.is_string()) throw Error(ErrorCode::kFormat, path + ": model_names: not a name");
    SourceMesh mesh;
    mesh.piece = "grip";
    mesh.part_from_raw = PartFromFile(unit);
    const std::string file = name.get<std::string>() + ".stl";
    try {
      mesh.file = FileInside(folder, file, path);
      mesh.sha256 = HashOfMeshFile(mesh.file);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMissing) throw;
      missing += ' ' + file;
    }
    meshes.push_back(std::move(mesh));
  }
  if (!missing.empty())
    throw Error(ErrorCode::kMissing,
                folder.string() + ": incomplete, missing" + missing + "; info.json names it");
  return meshes;
}

// stated in file units; empty if the record has none
Eigen::AlignedBox3d StatedBox(const fs::path& folder, const Json& record, double unit) {
  const auto boxes = record.find("bounding_box");
  if (boxes == record.end() || !boxes->is_array() || boxes->empty()) return {};
  const std::string path = (folder / "info.json").string() + ": bounding_box";
  Eigen::AlignedBox3d box;
  for (const char* corner : {"min", "max"}) {
    const Eigen::Vector3d at =
        Vector3FromJson(MemberOf((*boxes)[0], corner, path), path + "." + corner);
    box.extend(Eigen::Vector3d(PartFromFile(unit) * at));
  }
  return box;
}

std::vector<ForeignObject> ReadDoorGym(const fs::path& folder, const ReadConfig& config) {
  const HandleKind& kind = KindOf(folder);
  const Json record = ReadJsonFile(folder / "info.json");
  HandleSource handle;
  handle.name = std::string("doorgym/") + kind.name + "/" + ObjectNameOf(folder);
  handle.id = std::string("dg-") + kind.name + "-" + ObjectNameOf(folder);
  handle.source = std::string("DoorGym ") + kind.folder + "/" + ObjectNameOf(folder);
  handle.license = "BSD-3-Clause";
  handle.category = CategoryOr(config, Category::kInterior);
  handle.mechanism = kind.mechanism;
  handle.axis_point_m = Eigen::Vector3d::Zero();  // the files' own origin
  handle.meshes = MeshesOf(folder, record, kind.metres_a_unit);
  handle.stated_box = StatedBox(folder, record, kind.metres_a_unit);
  ForeignObject object = ReadHandle(handle);
  object.scale = kind.metres_a_unit;
  return {object};
}

}  // namespace

ImportFormat DoorGymFormat() { return {"doorgym", IsDoorGym, ReadDoorGym}; }

}  // namespace doorforge::internal
