// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"

#include "import_format.h"
#include "subtask.h"
#include "torch_archive/torch_numbers.h"
#include "urdf_objects/handle_part.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kPartOpening =
    86.4 * std::numbers::pi / 180;  // [rad] as in all objects of the release

// How the release's scripts scale a mesh: to a length along an axis of the raw file, by a factor.
struct Sizing {
  int axis = -1;     // of the raw file; -1: `value` is a factor
  double value = 1;  // [m] in the middle of the range that the scripts draw from
};

// ids with a factor of their own
struct IdFactor {
  const char* id;
  double factor;
};

// One of the seven tasks: its folders and how its parts are scaled and mounted.
struct Task {
  const char* id_suffix;  // of handles that another task has, too
  const char* body_folder;
  const char* handle_folder;
  Category category;
  Mechanism mechanism;
  const char* leaf;   // mesh of the body
  const char* frame;  // mesh of the body; a car's may be absent
  Sizing body;
  Sizing handle;
};

constexpr std::array<Task, 7> kTasks = {{
    {"",
     "3dware_door",
     "lever_door_handle",
     Category::kInterior,
     Mechanism::kLever,
     "board.dae",
     "frame.dae",
     {2, 1.8},
     {0, 0.15}},
    {"",
     "3dware_door",
     "round_door_handle",
     Category::kInterior,
     Mechanism::kRound,
     "board.dae",
     "frame.dae",
     {2, 1.8},
     {0, 0.064}},
    {"",
     "3dware_window",
     "window_handle",
     Category::kWindow,
     Mechanism::kLever,
     "untitled1.dae",
     "untitled.dae",
     {-1, 1},
     {2, 0.15}},
    {"",
     "3dware_car",
     "car_handle",
     Category::kCar,
     Mechanism::kFlap,
     "car-door.dae",
     "car-board.dae",
     {0, 4},
     {0, 0.2}},
    {"",
     "3dware_safe",
     "safe_handle",
     Category::kSafe,
     Mechanism::kValve,
     "board.dae",
     "frame.dae",
     {-1, 0.6},
     {-1, 1}},
    {"-cabinet",
     "3dware_cabinet",
     "round_door_handle",
     Category::kStorageFurniture,
     Mechanism::kRound,
     "board.dae",
     "frame.dae",
     {-1, 0.8},
     {0, 0.066}},
    {"",
     "3dware_fridge",
     "fridge_handle",
     Category::kRefrigerator,
     Mechanism::kLever,
     "board.dae",
     "frame.dae",
     {-1, 1},
     {-1, 1}},
}};

constexpr std::array<IdFactor, 24> kBodyFactors = {{
    {"9969004", 0.5}, {"9969008", 0.5},  {"9969012", 0.5}, {"9969013", 0.5}, {"9969017", 0.8},
    {"9961111", 0.2}, {"9961112", 0.2},  {"9961132", 1.4}, {"9961141", 1.0}, {"9961128", 1.0},
    {"9961180", 1.0}, {"9961127", 0.25}, {"9961307", 0.7}, {"9961320", 0.7}, {"9961340", 1.2},
    {"9961401", 0.7}, {"9961402", 0.7},  {"9961404", 0.7}, {"9961405", 0.7}, {"9961406", 0.7},
    {"9961408", 0.7}, {"9961409", 0.7},  {"9961410", 0.7}, {"9961407", 0.5},
}};
constexpr std::array<IdFactor, 18> kHandleFactors = {{
    {"9961204", 0.5},
    {"9961206", 0.5},
    {"9961210", 0.5},
    {"9961222", 0.5},
    {"9961214", 0.7},
    {"9961207", 0.7},
    {"9961213", 0.6},
    {"9961238", 0.25},
    {"9961218", 0.3},
    {"9961228", 0.3},
    {"9961224", 0.27},
    {"9961217", 0.1},
    {"9961229", 0.1},
    {"9961230", 0.9},
    {"9961234", 0.008},
    {"9960005", 1.4},
    {"9961501", 0.7},
    {"9961503", 0.7},
}};

// raw file (width, depth, up) -> ours (out, along the door, up)
Eigen::Affine3d PartFromRaw(double scale) {
  const Eigen::Matrix3d turn = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
  return Eigen::Affine3d(turn * scale);
}

// link frame (along the door, up, out) -> ours
Eigen::Vector3d FromLink(const Eigen::Vector3d& link) { return {link.z(), link.x(), link.y()}; }

std::string ParentName(const fs::path& folder) {
  return (fs::absolute(folder).lexically_normal() / "x").parent_path().parent_path().filename();
}

bool IsPart(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path / "texture_dae", error)) return false;
  const std::string parent = ParentName(path);
  return std::any_of(kTasks.begin(), kTasks.end(), [&](const Task& task) {
    return parent == task.body_folder || parent == task.handle_folder;
  });
}

template <std::size_t N>
double ScaleOf(const Sizing& sizing, const Eigen::AlignedBox3d& raw_box, const std::string& id,
               const std::array<IdFactor, N>& factors) {
  if (sizing.axis >= 0) return sizing.value / raw_box.sizes()[sizing.axis];
  for (const IdFactor& own : factors) {
    if (id == own.id) return own.factor;
  }
  return sizing.value;
}

Eigen::AlignedBox3d BoxFrom(const Json& low, const Json& high, const std::string& path) {
  Eigen::AlignedBox3d box;
  box.extend(Vector3FromJson(low, path));
  box.extend(Vector3FromJson(high, path));
  if (!(box.sizes().minCoeff() > 0))
    throw Error(ErrorCode::kFormat, path + ": a box without extent");
  return box;
}

// the release has .dae; the same parts turned into another format are as good
std::optional<fs::path> FindMesh(const fs::path& folder, const std::string& stem) {
  for (const char* ending : {".dae", ".obj", ".glb", ".stl"}) {
    const fs::path file = folder / "texture_dae" / (stem + ending);
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

SourceMesh MeshFrom(const fs::path& file, const std::string& piece, double scale) {
  SourceMesh mesh;
  mesh.piece = piece;
  mesh.file = file;
  mesh.sha256 = HashOfMeshFile(file);
  mesh.part_from_raw = PartFromRaw(scale);
  return mesh;
}

[[noreturn]] void ThrowMissing(const fs::path& folder, const std::string& what) {
  throw Error(ErrorCode::kMissing, folder.string() + ": incomplete, missing " + what);
}

// where the release's scripts put the handle, from the scaled leaf; its surface is at -by0
Eigen::Vector3d MountOn(const Eigen::AlignedBox3d& leaf, const Task& task, bool has_shell) {
  const double front = leaf.max().x();
  switch (task.category) {
    case Category::kInterior:
      return {front, leaf.max().y() - 0.08, leaf.min().z() + 0.8};
    case Category::kWindow:
      return {front, leaf.max().y() - 0.03, 0};
    case Category::kCar:
      return {has_shell ? 0.005 : 0.007, -0.01, 0};
    case Category::kSafe:
      return {front + 0.008, 0, 0};
    case Category::kStorageFurniture:
    case Category::kRefrigerator:
      break;
  }
  return {front, 0, 0};
}

class BodyReader {
 public:
  BodyReader(const fs::path& folder, const Task& task, const ReadConfig& config)
      : folder_(folder), task_(task), config_(config), id_(ObjectNameOf(folder)) {}

  ForeignObject Read() {
    FindMeshes();
    const std::string path = (folder_ / "bounding_box.json").string();
    const Json json = ReadJsonFile(path);
    const Eigen::AlignedBox3d box =
        BoxFrom(MemberOf(json, "min", path), MemberOf(json, "max", path), path);
    Task sized = task_;
    // a car's door alone is in metres
    if (task_.category == Category::kCar && !frame_) sized.body = {-1, 1};
    object_.scale = ScaleOf(sized.body, box, id_, kBodyFactors);
    if (frame_) meshes_.push_back(MeshFrom(*frame_, "frame", object_.scale));
    meshes_.push_back(MeshFrom(*leaf_, "leaf", object_.scale));
    AddPart();
    object_.name = "unidoormanip-parts/" + std::string(task_.body_folder) + "/" + id_;
    object_.category = NameOf(task_.category);
    object_.mechanism = NameOf(Mechanism::kNone);
    return object_;
  }

 private:
  void FindMeshes() {
    leaf_ = FindMesh(folder_, fs::path(task_.leaf).stem());
    frame_ = FindMesh(folder_, fs::path(task_.frame).stem());
    if (!leaf_) ThrowMissing(folder_, std::string("texture_dae/") + task_.leaf);
    if (frame_ || task_.category == Category::kCar) return;
    if (config_.allow_missing != "frame")
      ThrowMissing(folder_, std::string("texture_dae/") + task_.frame +
                                "; --allow-missing frame imports it without");
    object_.notes.push_back(std::string("without ") + task_.frame + ", which is missing");
  }

  void AddPart() {
    const Eigen::AlignedBox3d leaf = BoundsOf(LoadMesh(meshes_.back()));
    double lowest = leaf.min().z();
    if (frame_) lowest = std::min(lowest, BoundsOf(LoadMesh(meshes_.front())).min().z());
    const Eigen::Translation3d up(0, 0, -lowest);
    Part part;
    part.id = PartIdFrom("udm-" + id_);
    part.category = task_.category;
    part.joint.origin_m = up * Eigen::Vector3d(0, leaf.min().y(), leaf.max().z());
    part.joint.axis = -Eigen::Vector3d::UnitZ();
    part.joint.upper_rad = kPartOpening;
    part.part_from_mount = Translation(up * MountOn(leaf, task_, frame_.has_value()));
    part.license = "NOASSERTION";
    part.source =
        "UniDoorManip " + std::string(task_.body_folder) + "/" + id_ + ": " + FileNamesOf(meshes_);
    for (SourceMesh& mesh : meshes_) mesh.part_from_raw = up * mesh.part_from_raw;
    part.source_sha256 = SourceHashOf(meshes_, part);
    object_.parts.push_back({part.id, part.role, part.source_sha256, [part, meshes = meshes_] {
                               return LoadedPart{{part, LoadPieces(meshes)}, 0};
                             }});
  }

  fs::path folder_;
  const Task& task_;
  const ReadConfig& config_;
  std::string id_;
  std::optional<fs::path> leaf_;
  std::optional<fs::path> frame_;
  std::vector<SourceMesh> meshes_;
  ForeignObject object_;
};

// the meshes of a handle: one, or the part that turns and the part around it
std::vector<SourceMesh> HandleMeshes(const fs::path& folder, const std::string& id, double scale) {
  for (const char* side : {"", "-right"}) {
    const auto grip = FindMesh(folder, id + "-handle" + side);
    const auto rose = FindMesh(folder, id + "-lock" + side);
    if (grip && rose) return {MeshFrom(*rose, "rose", scale), MeshFrom(*grip, "grip", scale)};
    if (grip || rose)
      ThrowMissing(folder, "texture_dae/" + id + (grip ? "-lock" : "-handle") + side + ".dae");
  }
  const auto grip = FindMesh(folder, id);
  if (!grip) ThrowMissing(folder, "texture_dae/" + id + ".dae");
  return {MeshFrom(*grip, "grip", scale)};
}

ForeignObject ReadHandlePart(const fs::path& folder, const Task& task) {
  const std::string id = ObjectNameOf(folder);
  const std::string path = (folder / "bounding_box.json").string();
  const Json json = ReadJsonFile(path);
  const Json& corners = MemberOf(json, "handle", path);
  if (!corners.is_array() || corners.size() != 2)
    throw Error(ErrorCode::kFormat, path + ": handle: expected two corners");
  const Eigen::AlignedBox3d box = BoxFrom(corners[0], corners[1], path + ": handle");
  const double scale = ScaleOf(task.handle, box, id, kHandleFactors);

  HandleSource handle;
  handle.name = "unidoormanip-parts/" + std::string(task.handle_folder) + "/" + id;
  handle.id = "udm-" + id + task.id_suffix;
  handle.source = "UniDoorManip " + std::string(task.handle_folder) + "/" + id;
  handle.license = "NOASSERTION";
  handle.category = task.category;
  handle.mechanism = task.mechanism;
  handle.axis_point_m = Eigen::Vector3d::Zero();  // the mount is the files' own origin
  handle.leaf_plane_m = 0;
  handle.meshes = HandleMeshes(folder, id, scale);
  for (const Eigen::Vector3d& corner : {box.min(), box.max()})
    handle.stated_box.extend(Eigen::Vector3d(PartFromRaw(scale) * corner));
  const fs::path goal = folder / "goal_pos.npy";
  const std::vector<double> numbers = ReadTorchNumbers(goal, 3);
  if (numbers.size() != 3)
    throw Error(ErrorCode::kFormat,
                goal.string() + ": holds " + std::to_string(numbers.size()) + " numbers, not 3");
  handle.grasp_m = scale * FromLink({numbers[0], numbers[1], numbers[2]});
  ForeignObject object = ReadHandle(handle);
  object.scale = scale;
  return object;
}

std::vector<ForeignObject> ReadUniDoorManipParts(const fs::path& folder, const ReadConfig& config) {
  const std::string parent = ParentName(folder);
  const bool any = config.category.empty();
  std::vector<ForeignObject> objects;
  for (const Task& task : kTasks) {
    // lever and round doors share bodies, round doors and cabinets share handles
    if (parent == task.body_folder) return {BodyReader(folder, task, config).Read()};
    if (parent == task.handle_folder && (any || NameOf(task.category) == config.category))
      objects.push_back(ReadHandlePart(folder, task));
  }
  if (objects.empty())
    throw Error(ErrorCode::kInvalidArgument, folder.string() + ": no " + config.category +
                                                 " takes handles of " + parent +
                                                 "; leave --category out");
  return objects;
}

}  // namespace

ImportFormat UniDoorManipPartsFormat() {
  return {"unidoormanip-parts", IsPart, ReadUniDoorManipParts};
}

}  // namespace doorforge::internal
