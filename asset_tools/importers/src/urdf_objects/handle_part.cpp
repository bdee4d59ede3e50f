// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/handle_part.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"

#include "import_format.h"
#include "urdf_objects/handle_place.h"

namespace doorforge::internal {
namespace {

constexpr double kNeckShare = 0.2;  // of the depth, from behind: what a lever's neck fills

const RawPiece* PieceNamed(const std::vector<RawPiece>& pieces, const std::string& name) {
  const auto piece =
      std::find_if(pieces.begin(), pieces.end(), [&](const RawPiece& p) { return p.name == name; });
  return piece == pieces.end() ? nullptr : &*piece;
}

Eigen::Vector3d MiddleOfNeck(const TriangleMesh& grip) {
  const Eigen::AlignedBox3d bounds = BoundsOf(grip);
  Eigen::AlignedBox3d neck;
  for (const Eigen::Vector3d& vertex : grip.vertices) {
    if (vertex.x() <= bounds.min().x() + kNeckShare * bounds.sizes().x()) neck.extend(vertex);
  }
  return neck.center();
}

Eigen::Vector3d AxisPoint(const HandleSource& source, const std::vector<RawPiece>& pieces) {
  if (source.axis_point_m) return *source.axis_point_m;
  if (const RawPiece* rose = PieceNamed(pieces, "rose")) return BoundsOf(rose->mesh).center();
  const TriangleMesh& grip = PieceNamed(pieces, "grip")->mesh;
  if (source.mechanism == Mechanism::kLever) return MiddleOfNeck(grip);
  Eigen::Vector3d point = BoundsOf(grip).center();
  // a flap swings about its end towards the hinge
  if (source.mechanism == Mechanism::kFlap) point.y() = BoundsOf(grip).min().y();
  return point;
}

HandlePlace PlaceOf(const HandleSource& source, const std::vector<RawPiece>& pieces) {
  HandleKnowledge known;
  known.category = source.category;
  known.mechanism = source.mechanism;
  known.grasp_m = source.grasp_m;
  known.leaf_plane_m = source.leaf_plane_m;
  const TriangleMesh& grip = PieceNamed(pieces, "grip")->mesh;
  if (const RawPiece* rose = PieceNamed(pieces, "rose"); rose != nullptr && !known.leaf_plane_m)
    known.leaf_plane_m = std::min(BoundsOf(rose->mesh).min().x(), BoundsOf(grip).min().x());
  PartJoint joint;
  joint.origin_m = AxisPoint(source, pieces);
  joint.axis =
      source.mechanism == Mechanism::kFlap ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  if (source.mechanism == Mechanism::kFlap)
    joint.origin_m.x() = known.leaf_plane_m.value_or(BoundsOf(grip).min().x());
  known.joint = joint;
  return PlaceHandle(grip, known);
}

double DeviationFrom(const Eigen::AlignedBox3d& stated, const std::vector<RawPiece>& pieces) {
  if (stated.isEmpty()) return 0;
  const Eigen::AlignedBox3d loaded = BoundsOf(PieceNamed(pieces, "grip")->mesh);
  return std::max((loaded.min() - stated.min()).cwiseAbs().maxCoeff(),
                  (loaded.max() - stated.max()).cwiseAbs().maxCoeff());
}

}  // namespace

ForeignObject ReadHandle(const HandleSource& source) {
  const std::vector<RawPiece> pieces = LoadPieces(source.meshes);
  Require(PieceNamed(pieces, "grip") != nullptr, ErrorCode::kInvalidArgument,
          source.name + ": a handle has a grip");
  const HandlePlace place = PlaceOf(source, pieces);
  Part part;
  part.id = PartIdFrom(source.id);
  part.role = PartRole::kHandle;
  part.category = source.category;
  part.mechanism = place.mechanism;
  part.joint = place.joint;
  part.part_from_grasp = place.part_from_grasp;
  part.license = source.license;
  part.source = source.source + ": " + FileNamesOf(source.meshes);
  std::vector<SourceMesh> meshes = source.meshes;
  for (SourceMesh& mesh : meshes)
    mesh.part_from_raw = Eigen::Translation3d(-place.mount_m) * mesh.part_from_raw;
  part.source_sha256 = SourceHashOf(meshes, part);

  ForeignObject object;
  object.name = source.name;
  object.category = NameOf(part.category);
  object.mechanism = NameOf(part.mechanism);
  const double deviation = DeviationFrom(source.stated_box, pieces);
  object.parts.push_back({part.id, part.role, part.source_sha256, [part, meshes, deviation] {
                            return LoadedPart{{part, LoadPieces(meshes)}, deviation};
                          }});
  return object;
}

}  // namespace doorforge::internal
