// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "prepared_part.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/parts/grasp.h"
#include "doorforge/parts/mapped_part.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "compose_settings.h"

namespace doorforge {
namespace {

using internal::PartMap;

void CheckPart(const Part& part, const ComposeConfig& config) {
  const bool body = part.role == PartRole::kBody;
  if (FindPiece(part, body ? "leaf" : "grip") == nullptr)
    internal::RefusePair("CMP003", (body ? "body \"" : "handle \"") + part.id +
                                       "\" has no piece \"" + (body ? "leaf" : "grip") + '"');
  const bool pushed = body && config.opening == Opening::kPush;
  if (pushed && part.category != Category::kInterior && part.category != Category::kWindow)
    internal::RefusePair("CMP006", "body \"" + part.id + "\" is of category " +
                                       std::string(NameOf(part.category)) + "; use opening: pull");
  const auto& allowed = config.license_allow;
  if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), part.license) == allowed.end())
    internal::RefusePair("CMP009", "part \"" + part.id + "\" has the licence " + part.license);
}

// How far to stretch along y or z; a door of other proportions is another door.
double StretchTo(const char* name, double wanted, double made) {
  const double factor = wanted / made;
  if (factor < 0.5 || factor > 2)
    throw Error(ErrorCode::kInvalidConfig,
                std::string("config.") + name + ": found " + std::to_string(wanted) +
                    ", allowed half to twice the part's " + std::to_string(made));
  return factor;
}

PartMap BodyMap(const Part& part, const ComposeConfig& config) {
  const Eigen::Vector3d size = BoundsOf(FindPiece(part, "leaf")->mesh).sizes();
  PartMap map;
  map.scale.y() = config.leaf_width_m > 0 ? StretchTo("leaf_width_m", config.leaf_width_m, size.y())
                                          : internal::DrawnFactor(config, part.id + "/leaf_width");
  map.scale.z() = config.leaf_height_m > 0
                      ? StretchTo("leaf_height_m", config.leaf_height_m, size.z())
                      : internal::DrawnFactor(config, part.id + "/leaf_height");
  if (config.opening == Opening::kPush) map.turn = internal::MirrorX() * map.turn;
  if (config.hinge_side == HingeSide::kRight) map.turn = internal::MirrorY() * map.turn;
  return map;
}

PartMap HandleMap(const ComposeConfig& config) {
  PartMap map;
  map.scale.setConstant(config.handle_scale);
  if (config.handle_mirrored) map.turn = internal::MirrorY();
  map.turn = internal::QuarterTurnsAboutX(config.handle_turn_deg / 90) * map.turn;
  if (config.hinge_side == HingeSide::kRight) map.turn = internal::MirrorY() * map.turn;
  return map;
}

// A larger handle is grasped elsewhere, or not at all any more.
void RefineScaledGrasp(Part& part) {
  const TriangleMesh whole = internal::WholeMesh(part, Eigen::Matrix3d::Identity());
  const RefinedGrasp refined =
      RefineGrasp(FindPiece(part, "grip")->mesh, whole, part.part_from_grasp);
  if (!refined.fit.holds) return;
  part.part_from_grasp = refined.part_from_grasp;
  part.grasp_half_extent_m = refined.half_extent_m;
}

// The distance from the mount to the free edge is hardware and does not stretch with the leaf.
void KeepBackset(const Part& made, bool hinged_right, Part& changed) {
  const auto bounds = [](const Part& part) { return BoundsOf(FindPiece(part, "leaf")->mesh); };
  const double backset = bounds(made).max().y() - made.part_from_mount.translation().y();
  changed.part_from_mount.translation().y() =
      hinged_right ? bounds(changed).min().y() + backset : bounds(changed).max().y() - backset;
}

Part ChangedPart(const Part& part, const ComposeConfig& config) {
  const bool body = part.role == PartRole::kBody;
  const PartMap map = body ? BodyMap(part, config) : HandleMap(config);
  Part changed = internal::MappedPart(part, map);
  if (body && map.scale.y() != 1)
    KeepBackset(part, config.hinge_side == HingeSide::kRight, changed);
  if (!body && config.handle_scale != 1) RefineScaledGrasp(changed);
  for (PartPiece& piece : changed.pieces)
    piece.mass = internal::PresetMass(piece, part.role, config.masses);
  return changed;
}

bool TurnsWithItsLink(const PartPiece& piece) {
  return piece.name == "leaf" || piece.name == "grip";
}

PreparedPart::State::Shape ShapeOf(const PartPiece& piece, const PartJoint& joint) {
  PreparedPart::State::Shape shape;
  if (TurnsWithItsLink(piece)) shape.shape_from_part = Translation(-joint.origin_m);
  shape.mesh = PlacedAsFiled(piece.mesh, shape.shape_from_part);
  shape.mesh_sha256 = Sha256Hex(ToObj(shape.mesh));
  for (const TriangleMesh& hull : piece.hulls) {
    shape.hulls.push_back(PlacedAsFiled(hull, shape.shape_from_part));
    shape.hull_sha256.push_back(Sha256Hex(ToObj(shape.hulls.back())));
  }
  if (!piece.visual.empty()) {
    shape.visual = PlacedAsFiled(piece.visual, shape.shape_from_part);
    shape.texts = ToTexts(shape.visual);
    shape.visual_files = PooledVisualFiles(shape.visual);
  }
  shape.sha256 = Sha256Hex(ShapeText({shape.mesh_sha256, shape.hull_sha256, shape.visual_files}));
  return shape;
}

}  // namespace

namespace internal {

TriangleMesh WholeMesh(const Part& part, const Eigen::Matrix3d& turn) {
  std::vector<TriangleMesh> pieces;
  for (const PartPiece& piece : part.pieces) pieces.push_back(piece.mesh);
  RigidTransform turned = RigidTransform::Identity();
  turned.linear() = turn;
  return Transformed(Merged(pieces), turned);
}

}  // namespace internal

PreparedPart::PreparedPart(const Part& part, const ComposeConfig& config) {
  internal::CheckComposeConfig(config);
  CheckPart(part, config);
  auto state = std::make_shared<State>();
  state->identity = IdentityOf(part);
  state->part = ChangedPart(part, config);
  for (const PartPiece& piece : state->part.pieces)
    state->shapes.push_back(ShapeOf(piece, state->part.joint));
  if (part.role == PartRole::kBody)
    state->leaf.emplace(FindPiece(state->part, "leaf")->mesh);
  else
    state->back =
        internal::BackOutlineOf(internal::WholeMesh(state->part, Eigen::Matrix3d::Identity()));
  state_ = std::move(state);
}

const std::string& PreparedPart::id() const { return state_->part.id; }
const std::string& PreparedPart::source_sha256() const { return state_->part.source_sha256; }
PartRole PreparedPart::role() const { return state_->part.role; }
Category PreparedPart::category() const { return state_->part.category; }

}  // namespace doorforge
