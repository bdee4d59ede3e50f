// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/core/inside_folder.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/parts/read_model.h"

#include "import_format.h"
#include "source_mesh.h"
#include "subtask.h"
#include "urdf_objects/file_axes.h"
#include "urdf_objects/hinged_object.h"
#include "urdf_objects/joint_tree.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUrdfName = "motion_unity.urdf";
constexpr std::string_view kScheme = "package://";

bool IsAkb48(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path / kUrdfName, error);
}

std::string WithoutScheme(const std::string& name) {
  return name.starts_with(kScheme) ? name.substr(kScheme.size()) : name;
}

// Unity's axes, in which the joints are stated -> those of the meshes
Eigen::Vector3d MeshAxes(const Eigen::Vector3d& unity, double second_sign) {
  return {unity.y(), second_sign * unity.z(), unity.x()};
}

// Joints and meshes in the object's own frame: all meshes lie in it as they are, so every link's
// shapes are moved back by where the link is.
UrdfModel InObjectFrame(UrdfModel model, double second_sign, const std::string& where) {
  for (UrdfJoint& joint : model.joints) {
    joint.axis = MeshAxes(joint.axis, 1);
    joint.parent_from_joint =
        Translation(MeshAxes(joint.parent_from_joint.translation(), second_sign));
  }
  const std::vector<TreeLink> tree = JointTreeOf(model, where);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    for (UrdfShape& shape : model.links[i].visuals)
      shape.link_from_shape = tree[i].base_from_link.inverse();
    model.links[i].collisions.clear();
  }
  return model;
}

// A hinge lies at an edge of its leaf: from the nearer face of the longest side across the axis,
// and from the bounds in the other direction.
double DistanceFromEdge(const Eigen::AlignedBox3d& bounds, const Eigen::Vector3d& point,
                        const Eigen::Vector3d& axis) {
  int along = 0;
  axis.cwiseAbs().maxCoeff(&along);
  int wide = (along + 1) % 3;
  int deep = (along + 2) % 3;
  if (bounds.sizes()[deep] > bounds.sizes()[wide]) std::swap(wide, deep);
  const double to_edge = std::min(std::abs(point[wide] - bounds.min()[wide]),
                                  std::abs(point[wide] - bounds.max()[wide]));
  const double off =
      std::max({0.0, bounds.min()[deep] - point[deep], point[deep] - bounds.max()[deep]});
  return to_edge + off;
}

// how far the joints that turn lie off the edges of what they turn
double DistanceOfJoints(const HingedObject& object) {
  double distance = 0;
  const std::vector<TreeLink> tree = JointTreeOf(object.model, object.where);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (!tree[i].joint || !Turns(object.model.joints[*tree[i].joint])) continue;
    Eigen::AlignedBox3d bounds;
    for (const UrdfShape& shape : object.model.links[i].visuals) {
      const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry);
      if (mesh == nullptr) continue;
      SourceMesh source;
      source.file = object.find_mesh(mesh->filename);
      source.part_from_raw = Eigen::Affine3d(Eigen::Scaling(mesh->scale));
      bounds.extend(BoundsOf(LoadMesh(source)));
    }
    if (!bounds.isEmpty())
      distance += DistanceFromEdge(bounds, tree[i].base_from_link.translation(),
                                   object.model.joints[*tree[i].joint].axis);
  }
  return distance;
}

// where a mesh is missing, the reader of the object names them all
double DistanceIfComplete(const HingedObject& object) {
  try {
    return DistanceOfJoints(object);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kMissing) throw;
    return 0;
  }
}

std::vector<ForeignObject> ReadAkb48(const fs::path& folder, const ReadConfig& config) {
  if (config.category.empty())
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() + ": AKB-48 does not say what kind of door it is; pass --category");
  const std::string name = ObjectNameOf(folder);
  HingedObject object;
  object.name = "akb48/" + name;
  object.id = "akb-" + name;
  object.where = (folder / kUrdfName).string();
  object.source = "AKB-48 " + name;
  object.license = "NOASSERTION";
  object.upright_from_base = UprightFrom(config.mesh.up.empty() ? "x" : config.mesh.up);
  object.category = CategoryOr(config, Category::kStorageFurniture);
  object.folder = folder;
  object.find_mesh = [folder, where = object.where](const std::string& file) {
    return FileInside(folder, WithoutScheme(file), where);
  };
  object.frame_may_miss = config.allow_missing == "frame";
  const UrdfModel raw = ReadUrdfApart(folder / kUrdfName);
  // readers of the data set disagree on one sign; the meshes decide
  HingedObject negated = object;
  object.model = InObjectFrame(raw, 1, object.where);
  negated.model = InObjectFrame(raw, -1, object.where);
  const bool plain = DistanceIfComplete(object) <= DistanceIfComplete(negated);
  return ReadHingedObject(plain ? object : negated);
}

}  // namespace

ImportFormat Akb48Format() { return {"akb48", IsAkb48, ReadAkb48}; }

}  // namespace doorforge::internal
