// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/hinged_shapes.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/mesh_file.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kMaxShapes = 2000;

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class ShapeCollector {
 public:
  ShapeCollector(const HingedObject& object, const std::vector<TreeLink>& tree)
      : object_(object), tree_(tree) {}

  HingedShapes Run() {
    for (std::size_t i = 0; i < object_.model.links.size(); ++i) {
      const UrdfLink& link = object_.model.links[i];
      for (const UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals)
        AddShape(i, shape);
    }
    RequireComplete();
    // after all are known to be there
    for (HingedShape& shape : found_.shapes) shape.mesh = LoadMesh(shape.source);
    if (object_.height_m > 0) ScaleToHeight();
    return std::move(found_);
  }

 private:
  void AddShape(std::size_t link, const UrdfShape& shape) {
    if (found_.shapes.size() >= kMaxShapes)
      throw Error(ErrorCode::kFormat, object_.where + ": more than " + std::to_string(kMaxShapes) +
                                          " meshes; split the object");
    HingedShape added{link, IsHandleWord(LowerCase(shape.name)), {}, {}};
    const RigidTransform base_from_shape = tree_[link].base_from_link * shape.link_from_shape;
    added.source.part_from_raw =
        Eigen::Affine3d(object_.upright_from_base) * Eigen::Affine3d(base_from_shape.matrix());
    added.source.color_rgba = shape.color_rgba;
    if (const auto* mesh = std::get_if<UrdfMeshFile>(&shape.geometry)) {
      if (!FindFile(*mesh, link, added.source)) return;
    } else {
      added.source.solid = SolidOf(shape.geometry);
      added.source.sha256 = Sha256Hex(ToObj(added.source.solid));
    }
    found_.shapes.push_back(std::move(added));
  }

  static TriangleMesh SolidOf(const UrdfGeometry& geometry) {
    if (const auto* box = std::get_if<UrdfBox>(&geometry)) return MeshOf(*box);
    if (const auto* cylinder = std::get_if<UrdfCylinder>(&geometry)) return MeshOf(*cylinder);
    if (const auto* triangles = std::get_if<UrdfTriangles>(&geometry)) return triangles->mesh;
    return MeshOf(std::get<UrdfSphere>(geometry));
  }

  bool FindFile(const UrdfMeshFile& mesh, std::size_t link, SourceMesh& source) {
    if (!(mesh.scale.cwiseAbs().minCoeff() > 0))
      throw Error(ErrorCode::kFormat,
                  object_.where + ": mesh \"" + mesh.filename + "\" has a scale of zero");
    source.part_from_raw = source.part_from_raw * Eigen::Scaling(mesh.scale);
    try {
      source.file = object_.find_mesh(mesh.filename);
      source.object_folder = object_.folder;
      source.sha256 = HashOfMeshFile(source.file);
      return true;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMissing) throw;
    }
    const bool may_miss = object_.frame_may_miss && tree_[link].movable.empty();
    std::vector<std::string>& list = may_miss ? found_.left_out : missing_;
    if (std::find(list.begin(), list.end(), mesh.filename) == list.end())
      list.push_back(mesh.filename);
    return false;
  }

  void RequireComplete() const {
    if (missing_.empty()) return;
    std::string names;
    for (const std::string& name : missing_) names += ' ' + name;
    throw Error(ErrorCode::kMissing, object_.where + ": incomplete, missing" + names +
                                         "; the URDF names it. Add the file, or leave the "
                                         "object out");
  }

  void ScaleToHeight() {
    Eigen::AlignedBox3d bounds;
    for (const HingedShape& shape : found_.shapes) bounds.extend(BoundsOf(shape.mesh));
    if (bounds.isEmpty() || !(bounds.sizes().z() > 0))
      throw Error(ErrorCode::kFormat, object_.where + ": has no height to scale");
    found_.scale = object_.height_m / bounds.sizes().z();
    for (HingedShape& shape : found_.shapes) {
      shape.source.part_from_raw = Eigen::Scaling(found_.scale) * shape.source.part_from_raw;
      for (Eigen::Vector3d& vertex : shape.mesh.vertices) vertex *= found_.scale;
    }
  }

  const HingedObject& object_;
  const std::vector<TreeLink>& tree_;
  HingedShapes found_;
  std::vector<std::string> missing_;
};

}  // namespace

std::string WordFor(const HingedObject& object, std::size_t link) {
  const std::string& name = object.model.links[link].name;
  const auto word = object.words.find(name);
  return LowerCase(word == object.words.end() ? name : word->second);
}

bool IsHandleWord(const std::string& word) {
  static constexpr std::array<const char*, 6> kWords = {"handle", "knob", "lever",
                                                        "grip",   "pull", "latch"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](const char* w) { return word.find(w) != std::string::npos; });
}

HingedShapes LoadShapes(const HingedObject& object, const std::vector<TreeLink>& tree) {
  HingedShapes shapes = ShapeCollector(object, tree).Run();
  shapes.authored_from_base =
      Eigen::Scaling(shapes.scale) * Eigen::Affine3d(object.upright_from_base);
  return shapes;
}

}  // namespace doorforge::internal
