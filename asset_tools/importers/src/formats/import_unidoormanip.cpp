// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/import_unidoormanip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/parts/mechanism.h"
#include "doorforge/parts/read_model.h"
#include "doorforge/schemas/urdf.h"

#include "formats/two_joint_chain.h"
#include "source_mesh.h"
#include "subtask.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxObjectMeshes = 64;

// raw DAE: z up, front at -y; link: y up, z out of the door
Eigen::Matrix3d LinkFromRaw() {
  return (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
}

// the actor stands at yaw 180 degrees in the released simulator
RigidTransform ObjectFromBase() {
  return RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi);
}

// cyclic permutation: raw (width, depth, up) -> ours (out, along the door, up)
Eigen::Vector3d ObjectFromRawAxes(const Eigen::Vector3d& raw) {
  return {-raw.y(), raw.x(), raw.z()};
}

double UniformScale(const UrdfMeshFile& mesh, const std::string& where) {
  const Eigen::Vector3d& scale = mesh.scale;
  if (!(scale.x() > 0) || std::abs(scale.y() - scale.x()) > 1e-6 * scale.x() ||
      std::abs(scale.z() - scale.x()) > 1e-6 * scale.x())
    throw Error(ErrorCode::kFormat,
                where + ": mesh \"" + mesh.filename + "\" has no uniform positive scale");
  return scale.x();
}

Eigen::AlignedBox3d BoxOf(const Eigen::Vector3d& raw_min, const Eigen::Vector3d& raw_max) {
  Eigen::AlignedBox3d box;
  box.extend(ObjectFromRawAxes(raw_min));
  box.extend(ObjectFromRawAxes(raw_max));
  return box;
}

Eigen::Vector3d VectorAt(const Json& json, const char* key, const std::string& path) {
  return Vector3FromJson(MemberOf(json, key, path), path + "." + key);
}

// collects what is missing instead of stopping at the first file
class MeshCollector {
 public:
  MeshCollector(const fs::path& folder, const UrdfModel& model, const std::string& where)
      : folder_(folder), model_(model), where_(where) {}

  std::vector<UniDoorManipObject::Mesh> Collect(const std::vector<PlacedLink>& links,
                                                const std::string& piece) {
    std::vector<UniDoorManipObject::Mesh> meshes;
    for (const PlacedLink& link : links) {
      for (const UrdfShape& visual : model_.links[link.index].visuals)
        AddMesh(visual, link.base_from_link, piece, meshes);
    }
    return meshes;
  }

  void RequireComplete(bool frame_may_miss) const {
    const bool only_frame = missing_.empty();
    if (only_frame && (missing_of_frame_.empty() || frame_may_miss)) return;
    std::string message = folder_.string() + ": incomplete, missing";
    for (const std::string& name : missing_of_frame_) message += ' ' + name;
    for (const std::string& name : missing_) message += ' ' + name;
    message += "; mobility.urdf names it. Add the file, or leave the object out";
    if (only_frame) message += ", or pass --allow-missing frame to import it without";
    throw Error(ErrorCode::kMissing, message);
  }

  const std::vector<std::string>& missing_of_frame() const { return missing_of_frame_; }

 private:
  void AddMesh(const UrdfShape& shape, const RigidTransform& base_from_link,
               const std::string& piece, std::vector<UniDoorManipObject::Mesh>& meshes) {
    const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry);
    if (mesh == nullptr)
      throw Error(ErrorCode::kFormat, where_ + ": a visual of the " + piece + " is no mesh");
    if (++count_ > kMaxObjectMeshes)
      throw Error(ErrorCode::kFormat, where_ + ": more than " + std::to_string(kMaxObjectMeshes) +
                                          " meshes, which no object of this format has");
    const double scale = UniformScale(*mesh, where_);
    UniDoorManipObject::Mesh found;
    found.piece = piece;
    found.object_from_raw = (ObjectFromBase() * base_from_link * shape.link_from_shape) *
                            Eigen::Affine3d(LinkFromRaw() * scale);
    try {
      found.file = FileInside(folder_, mesh->filename, where_);
      found.sha256 = internal::HashOfMeshFile(found.file);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMissing) throw;
      std::vector<std::string>& list = piece == "frame" ? missing_of_frame_ : missing_;
      if (std::find(list.begin(), list.end(), mesh->filename) == list.end())
        list.push_back(mesh->filename);
      return;
    }
    meshes.push_back(found);
  }

  const fs::path& folder_;
  const UrdfModel& model_;
  std::string where_;
  std::size_t count_ = 0;
  std::vector<std::string> missing_of_frame_;
  std::vector<std::string> missing_;  // of all else
};

PartJoint ObjectJoint(const UrdfJoint& joint, const RigidTransform& base_from_joint) {
  const RigidTransform object_from_joint = ObjectFromBase() * base_from_joint;
  PartJoint made;
  made.origin_m = object_from_joint.translation();
  made.axis = (object_from_joint.linear() * joint.axis).normalized();
  made.lower_rad = joint.lower;
  made.upper_rad = joint.upper;
  // some files describe the same motion with the axis the other way round
  if (made.upper_rad <= 0 && made.lower_rad < 0) {
    made.axis = -made.axis;
    made.lower_rad = -joint.upper;
    made.upper_rad = -joint.lower;
  }
  return made;
}

void Reverse(PartJoint& joint) { joint.axis = -joint.axis; }

Eigen::Vector3d HingeVelocityAt(const PartJoint& joint, const Eigen::Vector3d& point) {
  return joint.axis.cross(point - joint.origin_m);
}

// positive angles open towards +x and unlock; a lever unlocks when it goes down
void OrientJoints(UniDoorManipObject& object) {
  if (HingeVelocityAt(object.hinge, object.handle_joint.origin_m).x() < 0) Reverse(object.hinge);
  const Eigen::Vector3d grasp = object.object_from_grasp.translation();
  const Eigen::Vector3d velocity = HingeVelocityAt(object.handle_joint, grasp);
  const bool swings_up = object.mechanism == Mechanism::kLever && velocity.z() > 0.02 &&
                         velocity.z() > std::abs(velocity.y());
  const bool swings_in = object.mechanism == Mechanism::kFlap && velocity.x() < 0;
  if (swings_up || swings_in) Reverse(object.handle_joint);
}

// pose of the gripper about the handle's link, as the released scripts command it
RigidTransform LinkFromGrasp(Category category, const Eigen::Vector3d& goal_in_link) {
  RigidTransform link_from_grasp = Translation(goal_in_link);
  // approach along -z of the link; the fingers close along y, on a window's upright handle along x
  if (category == Category::kWindow)
    link_from_grasp.linear() << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  else
    link_from_grasp.linear() << -1, 0, 0, 0, 1, 0, 0, 0, -1;
  return link_from_grasp;
}

void ReadBoxes(const fs::path& folder, UniDoorManipObject& object,
               const RigidTransform& object_from_handle) {
  const fs::path body_file = folder / "bounding_box.json";
  if (fs::exists(body_file)) {
    const Json json = ReadJsonFile(body_file);
    object.body_box =
        BoxOf(VectorAt(json, "min", body_file.string()), VectorAt(json, "max", body_file.string()));
  }
  const fs::path handle_file = folder / "handle_bounding.json";
  const Json json = ReadJsonFile(handle_file);
  const std::string path = handle_file.string();
  object.handle_box = BoxOf(VectorAt(json, "handle_min", path), VectorAt(json, "handle_max", path));
  object.object_from_grasp =
      object_from_handle * LinkFromGrasp(object.category, VectorAt(json, "goal_pos", path));
}

// "99650069960003" -> "9965006" and "9960003"
void NameHalves(const std::string& name, UniDoorManipObject& object) {
  const bool digits = name.size() == 14 && std::all_of(name.begin(), name.end(),
                                                       [](char c) { return c >= '0' && c <= '9'; });
  object.body_name = digits ? name.substr(0, 7) : name;
  object.handle_name = digits ? name.substr(7) : name;
}

std::string HashOf(const std::vector<UniDoorManipObject::Mesh>& meshes, const PartJoint& joint,
                   const Eigen::Vector3d& origin, const Json& facts) {
  Json json = facts;
  // 1e-6: objects that share a part state it with different rounding
  const auto add = [&](const char* key, const Eigen::Vector3d& value) {
    for (const double number : value) json[key].push_back(std::lround(number * 1e6));
  };
  add("joint_origin", joint.origin_m - origin);
  add("joint_axis", joint.axis);
  json["upper"] = std::lround(joint.upper_rad * 1e6);
  for (const UniDoorManipObject::Mesh& mesh : meshes) {
    json["meshes"].push_back({mesh.piece, mesh.sha256});
    add("place", mesh.object_from_raw.translation() - origin);
    for (int axis = 0; axis < 3; ++axis) add("place", mesh.object_from_raw.linear().col(axis));
  }
  return Sha256Hex(JsonText(json));
}

std::vector<internal::SourceMesh> SourcesOf(const std::vector<UniDoorManipObject::Mesh>& meshes,
                                            const fs::path& folder) {
  std::vector<internal::SourceMesh> sources;
  for (const UniDoorManipObject::Mesh& mesh : meshes) {
    internal::SourceMesh source;
    source.piece = mesh.piece;
    source.file = mesh.file;
    source.object_folder = folder;
    source.sha256 = mesh.sha256;
    source.part_from_raw = mesh.object_from_raw;
    sources.push_back(std::move(source));
  }
  return sources;
}

PartDraft LoadHalf(const std::vector<UniDoorManipObject::Mesh>& meshes, const fs::path& folder) {
  PartDraft draft;
  draft.pieces = internal::LoadPieces(SourcesOf(meshes, folder));
  draft.facts.license = "NOASSERTION";
  return draft;
}

void MovePieces(PartDraft& draft, const Eigen::Vector3d& offset) {
  for (RawPiece& piece : draft.pieces) {
    piece.mesh = Transformed(std::move(piece.mesh), Translation(offset));
    for (Eigen::Vector3d& vertex : piece.visual.vertices) vertex += offset;
  }
}

std::string SourceOf(const UniDoorManipObject& object,
                     const std::vector<UniDoorManipObject::Mesh>& meshes) {
  std::string source = "UniDoorManip " + object.name + ":";
  for (const UniDoorManipObject::Mesh& mesh : meshes) source += ' ' + mesh.file.filename().string();
  return source;
}

}  // namespace

bool IsUniDoorManipObject(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "mobility.urdf", error);
}

UniDoorManipObject ReadUniDoorManip(const fs::path& folder, const std::string& category,
                                    bool frame_may_miss) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder");
  for (const char* file : {"mobility.urdf", "handle_bounding.json"}) {
    if (!fs::is_regular_file(folder / file, ignored))
      throw Error(ErrorCode::kMissing, folder.string() + ": incomplete, missing " + file);
  }
  const std::string where = (folder / "mobility.urdf").string();
  const UrdfModel model = ReadUrdfApart(folder / "mobility.urdf");
  const TwoJointChain chain = FindTwoJointChain(model, where);

  UniDoorManipObject object;
  object.folder = folder;
  const internal::Subtask subtask = internal::SubtaskOf(folder, model, category);
  object.name = subtask.name + "/" + internal::ObjectNameOf(folder);
  object.category = subtask.category;
  object.mechanism = subtask.mechanism;
  NameHalves(internal::ObjectNameOf(folder), object);
  MeshCollector collector(folder, model, where);
  object.body_meshes = collector.Collect(chain.frame, "frame");
  for (auto& mesh : collector.Collect(chain.leaf, "leaf")) object.body_meshes.push_back(mesh);
  object.handle_meshes = collector.Collect(chain.rose, "rose");
  for (auto& mesh : collector.Collect(chain.grip, "grip")) object.handle_meshes.push_back(mesh);
  collector.RequireComplete(frame_may_miss);
  object.left_out = collector.missing_of_frame();

  object.hinge = ObjectJoint(model.joints[chain.hinge], chain.base_from_hinge);
  object.handle_joint = ObjectJoint(model.joints[chain.handle], chain.base_from_handle);
  object.handle_joint.lower_rad = 0;
  object.handle_joint.upper_rad = HandleRange(object.category);
  ReadBoxes(folder, object, ObjectFromBase() * chain.base_from_handle);
  OrientJoints(object);
  return object;
}

std::string BodySourceHash(const UniDoorManipObject& object) {
  return HashOf(object.body_meshes, object.hinge, Eigen::Vector3d::Zero(),
                {{"role", "body"}, {"category", NameOf(object.category)}});
}

std::string HandleSourceHash(const UniDoorManipObject& object) {
  Json facts = {{"role", "handle"},
                {"category", NameOf(object.category)},
                {"mechanism", NameOf(object.mechanism)}};
  const Eigen::Vector3d grasp =
      object.object_from_grasp.translation() - object.handle_joint.origin_m;
  for (const double number : grasp) facts["grasp"].push_back(std::lround(number * 1e6));
  return HashOf(object.handle_meshes, object.handle_joint, object.handle_joint.origin_m, facts);
}

PartDraft LoadBody(const UniDoorManipObject& object) {
  PartDraft draft = LoadHalf(object.body_meshes, object.folder);
  double lowest = std::numeric_limits<double>::infinity();
  for (const RawPiece& piece : draft.pieces)
    lowest = std::min(lowest, BoundsOf(piece.mesh).min().z());
  const Eigen::Vector3d up(0, 0, -lowest);
  MovePieces(draft, up);
  Part& part = draft.facts;
  part.id = "udm-" + object.body_name;
  part.role = PartRole::kBody;
  part.category = object.category;
  part.joint = object.hinge;
  part.joint.origin_m += up;
  part.part_from_mount = Translation(object.handle_joint.origin_m + up);
  part.source = SourceOf(object, object.body_meshes);
  part.source_sha256 = BodySourceHash(object);
  return draft;
}

PartDraft LoadHandle(const UniDoorManipObject& object) {
  PartDraft draft = LoadHalf(object.handle_meshes, object.folder);
  const Eigen::Vector3d to_mount = -object.handle_joint.origin_m;
  MovePieces(draft, to_mount);
  Part& part = draft.facts;
  part.id = "udm-" + object.handle_name;
  part.role = PartRole::kHandle;
  part.category = object.category;
  part.mechanism = object.mechanism;
  part.joint = object.handle_joint;
  part.joint.origin_m.setZero();
  part.part_from_grasp = Translation(to_mount) * object.object_from_grasp;
  part.source = SourceOf(object, object.handle_meshes);
  part.source_sha256 = HandleSourceHash(object);
  return draft;
}

double BoxDeviation(const UniDoorManipObject& object, const PartDraft& half) {
  const bool is_body = half.facts.role == PartRole::kBody;
  const Eigen::AlignedBox3d& stated = is_body ? object.body_box : object.handle_box;
  // the body's box is that of its frame
  if (stated.isEmpty() || (is_body && !object.left_out.empty())) return 0;
  const bool has_frame = is_body && half.pieces.size() > 1;
  Eigen::AlignedBox3d loaded;
  for (const RawPiece& piece : half.pieces) {
    if (piece.name == "rose" || (has_frame && piece.name == "leaf")) continue;
    loaded.extend(BoundsOf(piece.mesh));
  }
  // a body was lifted onto the floor
  if (is_body) loaded.translate(object.hinge.origin_m - half.facts.joint.origin_m);
  return std::max((loaded.min() - stated.min()).cwiseAbs().maxCoeff(),
                  (loaded.max() - stated.max()).cwiseAbs().maxCoeff());
}

}  // namespace doorforge
