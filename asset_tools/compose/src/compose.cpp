// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/compose/compose.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/parts/joint_limits.h"
#include "doorforge/parts/mapped_part.h"
#include "doorforge/parts/mechanism.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "compose_settings.h"
#include "prepared_part.h"

namespace doorforge {
namespace {

using Shape = PreparedPart::State::Shape;

constexpr double kOutlineOverhang = 0.01;  // [m] as rule HND003 of validate
constexpr double kOutOfLeaf = 0.9;         // |axis.x| above this: the axis runs out of the leaf
constexpr double kLongestSlide = 0.1;      // [m] what is further off is not what the handle sits on
// A base without a frame never moves, but programs drop links without mass.
const MassProperties kFixedBase{1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.01};

/// A door before its meshes: geometry has names, colours and labels only.
struct Composed {
  /// Where the meshes of one geometry come from.
  struct Source {
    const Shape* shape;
    RigidTransform link_from_shape;
  };
  DoorAsset door;
  std::array<std::vector<Source>, 3> sources;  ///< They follow door.links and the geometry of each.
};

/// One call's arguments.
struct Pair {
  const PreparedPart::State& body;
  const PreparedPart::State& handle;
  const ComposeConfig& config;
  const std::optional<RigidTransform>& authored;  ///< It holds for the parts as they were made.
};

void CheckPair(const Part& body, const Part& handle) {
  if (body.role != PartRole::kBody)
    internal::RefusePair("CMP001", '"' + body.id + "\" is not a body but a handle");
  if (handle.role != PartRole::kHandle)
    internal::RefusePair("CMP001", '"' + handle.id + "\" is not a handle but a body");
  if (body.category != handle.category)
    internal::RefusePair("CMP002", "body \"" + body.id + "\" is of category " +
                                       std::string(NameOf(body.category)) + ", handle \"" +
                                       handle.id + "\" of " + std::string(NameOf(handle.category)));
}

void CheckSense(const Part& handle, HandleSense sense) {
  if (sense == HandleSense::kAsMade) return;
  if (handle.mechanism == Mechanism::kNone || handle.mechanism == Mechanism::kFlap)
    internal::RefusePair("CMP012", "handle \"" + handle.id + "\" is of mechanism " +
                                       std::string(NameOf(handle.mechanism)) +
                                       "; use handle_sense: as_made");
}

Eigen::Vector3d WantedMount(const Pair& pair) {
  const ComposeConfig& config = pair.config;
  const Eigen::AlignedBox3d& leaf = pair.body.leaf->bounds;
  Eigen::Vector3d mount = pair.body.part.part_from_mount.translation();
  mount.z() *= internal::DrawnFactor(
      config, pair.body.part.id + "__" + pair.handle.part.id + "/handle_height");
  if (config.handle_height_m > 0) mount.z() = config.handle_height_m;
  if (config.backset_m > 0)
    mount.y() = config.hinge_side == HingeSide::kRight ? leaf.min().y() + config.backset_m
                                                       : leaf.max().y() - config.backset_m;
  const bool set = config.handle_height_m > 0 || config.backset_m > 0;
  const Eigen::AlignedBox2d outline(leaf.min().tail<2>().eval(), leaf.max().tail<2>().eval());
  if (set && !outline.contains(mount.tail<2>().eval()))
    internal::RefusePair(
        "CMP008", "handle_height_m or backset_m puts \"" + pair.handle.part.id +
                      "\" beside the leaf of \"" + pair.body.part.id +
                      "\", which reaches from z = " + std::to_string(leaf.min().z()) + " to " +
                      std::to_string(leaf.max().z()) + " m and is " +
                      std::to_string(leaf.sizes().y()) + " m wide");
  return mount;
}

void CheckOutline(const Pair& pair, const RigidTransform& body_from_handle) {
  if (!pair.config.handle_mirrored && pair.config.handle_turn_deg == 0) return;
  const TriangleMesh handle = Transformed(
      internal::WholeMesh(pair.handle.part, Eigen::Matrix3d::Identity()), body_from_handle);
  const Eigen::AlignedBox3d box = BoundsOf(handle);
  const Eigen::AlignedBox3d& leaf = pair.body.leaf->bounds;
  const double beyond = std::max((leaf.min() - box.min()).tail<2>().maxCoeff(),
                                 (box.max() - leaf.max()).tail<2>().maxCoeff());
  if (beyond > kOutlineOverhang)
    internal::RefusePair("CMP010", "\"" + pair.handle.part.id + "\" reaches " +
                                       std::to_string(beyond) + " m beyond the leaf of \"" +
                                       pair.body.part.id + "\"; set a larger backset_m");
}

RigidTransform SeatedMount(const Pair& pair) {
  RigidTransform body_from_handle = pair.body.part.part_from_mount;
  body_from_handle.translation().setZero();
  const bool turned = body_from_handle.linear() != Eigen::Matrix3d::Identity();
  const internal::BackOutline back = turned ? internal::BackOutlineOf(internal::WholeMesh(
                                                  pair.handle.part, body_from_handle.linear()))
                                            : *pair.handle.back;
  const std::string names =
      "leaf of \"" + pair.body.part.id + "\", handle \"" + pair.handle.part.id + "\"";
  if (!internal::FitsOn(*pair.body.leaf, back)) internal::RefusePair("CMP004", names);
  const std::optional<Eigen::Vector3d> seat =
      internal::SeatOn(*pair.body.leaf, back, WantedMount(pair));
  if (!seat) internal::RefusePair("CMP005", names + "; set handle_height_m or backset_m");
  body_from_handle.translation() = *seat;
  if (pair.config.place == HandlePlace::kPlane) body_from_handle.translation().x() += back.rear_m;
  CheckOutline(pair, body_from_handle);
  return body_from_handle;
}

// Along its axis onto the leaf; a handle whose axis lies in the leaf stays where it was, and so
// does one that has nothing near behind it.
void SlideOntoLeaf(const Pair& pair, RigidTransform& body_from_handle) {
  const Eigen::Vector3d axis = body_from_handle.linear() * pair.handle.part.joint.axis.normalized();
  const bool turned = body_from_handle.linear() != Eigen::Matrix3d::Identity();
  if (turned || std::abs(axis.x()) < kOutOfLeaf) return;
  const std::optional<double> surface = internal::SurfaceBehind(
      *pair.body.leaf, *pair.handle.back, body_from_handle.translation().tail<2>());
  if (!surface) return;
  const double slide = *surface - pair.handle.back->rear_m - body_from_handle.translation().x();
  if (std::abs(slide) <= kLongestSlide) body_from_handle.translation() += axis * (slide / axis.x());
}

// The author's place as the parts are mapped: of a body that is pushed, front and back change
// places, while the handle still points out of the front.
RigidTransform MappedPlace(const Pair& pair) {
  RigidTransform body_from_handle = *pair.authored;
  const auto mirror = [&](const Eigen::Matrix3d& by) {
    body_from_handle.linear() = by * body_from_handle.linear() * by;
    body_from_handle.translation() = by * body_from_handle.translation();
  };
  if (pair.config.hinge_side == HingeSide::kRight) mirror(internal::MirrorY());
  if (pair.config.opening == Opening::kPush) mirror(internal::MirrorX());
  return body_from_handle;
}

// The place that parts had on a door that is pulled is on the back of one that is pushed.
bool ComesToLieBehind(const Pair& pair) {
  return pair.config.opening == Opening::kPush &&
         MappedPlace(pair).translation().x() < pair.body.leaf->bounds.center().x();
}

bool KeepsTheAuthorsPlace(const Pair& pair) {
  const HandlePlace place = pair.config.place;
  if (place == HandlePlace::kSeat || place == HandlePlace::kPlane) return false;
  const bool kept = pair.authored.has_value() && !ComesToLieBehind(pair);
  if (place == HandlePlace::kAuto) return kept && internal::MovesTheHandle(pair.config).empty();
  if (!kept)
    internal::RefusePair("CMP011", "body \"" + pair.body.part.id + "\" and handle \"" +
                                       pair.handle.part.id +
                                       (pair.authored ? "\" come from a door that is pulled"
                                                      : "\" were not imported together") +
                                       "; use place: seat");
  return true;
}

RigidTransform AuthoredMount(const Pair& pair) {
  RigidTransform body_from_handle = MappedPlace(pair);
  if (pair.config.place != HandlePlace::kAuthor) SlideOntoLeaf(pair, body_from_handle);
  return body_from_handle;
}

const PartPiece& PieceOf(const PreparedPart::State& part, const Shape& shape) {
  return part.part.pieces[static_cast<std::size_t>(&shape - part.shapes.data())];
}

const Shape* FindShape(const PreparedPart::State& part, std::string_view name) {
  for (std::size_t i = 0; i < part.shapes.size(); ++i) {
    if (part.part.pieces[i].name == name) return &part.shapes[i];
  }
  return nullptr;
}

/// A piece on its way to a link.
struct Placing {
  const PreparedPart::State& part;
  std::string_view piece;
  RigidTransform link_from_shape;
  DoorLinkIndex link;
  PointLabel label;
};

void AddPiece(const Placing& placing, Composed& composed) {
  const Shape* shape = FindShape(placing.part, placing.piece);
  if (shape == nullptr) return;
  const PartPiece& piece = PieceOf(placing.part, *shape);
  DoorLink& link = composed.door.links[static_cast<std::size_t>(placing.link)];
  link.geometry.push_back({.name = piece.name,
                           .mesh = {},
                           .hulls = {},
                           .color_rgba = piece.color_rgba,
                           .label = placing.label});
  composed.sources[static_cast<std::size_t>(placing.link)].push_back(
      {shape, placing.link_from_shape});
  const std::array<MassProperties, 2> masses = {
      link.mass, Transformed(piece.mass, placing.link_from_shape * shape->shape_from_part)};
  link.mass = Combined(masses);
}

void RaiseInertia(MassProperties& mass) {
  // the smallest eigenvalue bounds the inertia about any axis
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mass.inertia_kg_m2).eigenvalues()[0];
  if (smallest < kMinimumHandleInertia)
    mass.inertia_kg_m2 += (kMinimumHandleInertia - smallest) * Eigen::Matrix3d::Identity();
}

DoorJoint MakeJoint(const std::string& name, const PartJoint& joint,
                    const Eigen::Vector3d& origin) {
  DoorJoint made;
  made.name = name;
  made.parent_from_child_at_zero = Translation(origin);
  made.axis = joint.axis.normalized();
  made.lower_rad = joint.lower_rad;
  made.upper_rad = joint.upper_rad;
  return made;
}

void AddJoints(const Pair& pair, const RigidTransform& body_from_handle, DoorAsset& door) {
  const PartJoint& hinge = pair.body.part.joint;
  const PartJoint& handle = pair.handle.part.joint;
  const internal::JointNumbers numbers =
      internal::JointNumbersOf(pair.config, pair.body.part.id + "__" + pair.handle.part.id);
  door.hinge = MakeJoint("hinge", hinge, hinge.origin_m);
  door.hinge.effort_limit_nm = internal::kHingeLimits.effort_nm;
  door.hinge.velocity_limit_rad_s = internal::kHingeLimits.velocity_rad_s;
  door.hinge.damping_nm_s = numbers.hinge_damping_nm_s;
  door.handle_joint =
      MakeJoint("handle_joint", handle, body_from_handle * handle.origin_m - hinge.origin_m);
  door.handle_joint.axis = body_from_handle.linear() * door.handle_joint.axis;
  if (pair.config.handle_sense == HandleSense::kReversed) door.handle_joint.axis *= -1;
  door.handle_joint.effort_limit_nm = internal::kHandleLimits.effort_nm;
  door.handle_joint.velocity_limit_rad_s = internal::kHandleLimits.velocity_rad_s;
  door.handle_joint.damping_nm_s = numbers.handle_damping_nm_s;
}

// Leaf and grip are shared with their origin on the axis, which is the link's; the rose's place on
// the leaf differs from door to door.
void AddLinks(const Pair& pair, const RigidTransform& body_from_handle, Composed& composed) {
  DoorAsset& door = composed.door;
  door.links[kBaseLink].name = "base";
  door.links[kLeafLink].name = "leaf";
  door.links[kHandleLink].name = "handle";
  const RigidTransform as_it_is = RigidTransform::Identity();
  const RigidTransform leaf_from_body = door.hinge.parent_from_child_at_zero.inverse();
  RigidTransform handle_turn = body_from_handle;
  handle_turn.translation().setZero();
  AddPiece({pair.body, "frame", as_it_is, kBaseLink, PointLabel::kFrame}, composed);
  if (door.links[kBaseLink].geometry.empty()) door.links[kBaseLink].mass = kFixedBase;
  AddPiece({pair.body, "leaf", as_it_is, kLeafLink, PointLabel::kBody}, composed);
  AddPiece({pair.handle, "rose", leaf_from_body * body_from_handle, kLeafLink, PointLabel::kHandle},
           composed);
  AddPiece({pair.handle, "grip", handle_turn, kHandleLink, PointLabel::kHandle}, composed);
  RaiseInertia(door.links[kHandleLink].mass);
  door.handle_from_grasp = handle_turn * Translation(-pair.handle.part.joint.origin_m) *
                           pair.handle.part.part_from_grasp;
}

void SetAngles(const ComposeConfig& config, double upper_rad, Latch& latch) {
  if (config.unlock_angle_rad > 0) latch.unlock_angle_rad = config.unlock_angle_rad;
  if (config.handle_done_angle_rad > 0) latch.handle_done_angle_rad = config.handle_done_angle_rad;
  if (config.unlock_angle_rad > 0 && config.handle_done_angle_rad == 0)
    latch.handle_done_angle_rad = std::max(latch.handle_done_angle_rad, latch.unlock_angle_rad);
  if (latch.unlock_angle_rad <= latch.handle_done_angle_rad &&
      latch.handle_done_angle_rad <= upper_rad)
    return;
  throw Error(ErrorCode::kInvalidConfig,
              "config.unlock_angle_rad: " + std::to_string(latch.unlock_angle_rad) +
                  ", config.handle_done_angle_rad: " + std::to_string(latch.handle_done_angle_rad) +
                  "; allowed are unlock <= done <= the handle's range of " +
                  std::to_string(upper_rad));
}

Latch MakeLatch(const Pair& pair, const DoorAsset& door) {
  const ComposeConfig& config = pair.config;
  const internal::JointNumbers numbers =
      internal::JointNumbersOf(config, pair.body.part.id + "__" + pair.handle.part.id);
  const bool turns = door.handle_joint.upper_rad > door.handle_joint.lower_rad;
  const bool asked = config.latch == LatchChoice::kEffort || config.latch == LatchChoice::kBolt;
  if (asked && !turns)
    internal::RefusePair("CMP007", "handle \"" + door.handle.id + "\" does not turn; latch: " +
                                       std::string(NameOf(config.latch)));
  const bool locks =
      turns &&
      (asked || (config.latch == LatchChoice::kAuto && door.mechanism != Mechanism::kNone));
  const Mechanism mechanism =
      door.mechanism == Mechanism::kNone ? Mechanism::kLever : door.mechanism;
  Latch latch =
      LatchOf(door.category, locks ? mechanism : Mechanism::kNone, door.handle_joint.upper_rad);
  latch.hinge_spring_nm_per_rad = numbers.hinge_spring_nm_per_rad;
  if (turns) latch.handle_spring_nm_per_rad = numbers.handle_spring_nm_per_rad;
  if (!locks) return latch;
  latch.lock_effort_nm = config.lock_effort_nm;
  latch.relatch = config.relatch;
  latch.unlocks_ajar = config.unlocks_ajar;
  if (config.latch == LatchChoice::kBolt) {
    latch.type = LatchType::kBolt;
    latch.bolt_throw_m = config.bolt_throw_m;
  }
  SetAngles(config, door.handle_joint.upper_rad, latch);
  return latch;
}

std::string JoinedLicense(const std::string& a, const std::string& b) {
  return a == b ? a : a + " AND " + b;
}

Composed Compose(const Pair& pair) {
  const Part& body = pair.body.part;
  const Part& handle = pair.handle.part;
  CheckPair(body, handle);
  CheckSense(handle, pair.config.handle_sense);
  Composed composed;
  DoorAsset& door = composed.door;
  door.id = internal::DoorIdOf(body.id, handle.id, pair.config);
  door.category = body.category;
  door.mechanism = handle.mechanism;
  door.hinge_side = pair.config.hinge_side;
  door.opening = pair.config.opening;
  door.body = pair.body.identity;
  door.handle = pair.handle.identity;
  door.license = JoinedLicense(body.license, handle.license);
  door.physics_source = internal::PhysicsSourceOf(pair.config);
  const RigidTransform body_from_handle =
      KeepsTheAuthorsPlace(pair) ? AuthoredMount(pair) : SeatedMount(pair);
  AddJoints(pair, body_from_handle, door);
  AddLinks(pair, body_from_handle, composed);
  door.latch = MakeLatch(pair, door);
  door.grasp_half_extent_m = handle.grasp_half_extent_m;
  return composed;
}

// as it comes back from a record, so that a door that shares meshes reads back as this one
RigidTransform AsRecorded(const RigidTransform& transform) {
  return TransformFromJson(TransformToJson(transform), "transform");
}

void AddMeshes(Composed& composed) {
  for (std::size_t link = 0; link < composed.sources.size(); ++link) {
    for (std::size_t i = 0; i < composed.sources[link].size(); ++i) {
      const Composed::Source& source = composed.sources[link][i];
      const RigidTransform place = AsRecorded(source.link_from_shape);
      DoorGeometry& geometry = composed.door.links[link].geometry[i];
      geometry.mesh = PlacedAsFiled(source.shape->mesh, place);
      for (const TriangleMesh& hull : source.shape->hulls)
        geometry.hulls.push_back(PlacedAsFiled(hull, place));
      geometry.visual = PlacedAsFiled(source.shape->visual, place);
    }
  }
}

DoorFiles SharedFilesOf(const Composed& composed) {
  DoorFiles files;
  for (std::size_t link = 0; link < files.size(); ++link) {
    for (const Composed::Source& source : composed.sources[link]) {
      GeometryFiles shared{PooledMeshPath(source.shape->mesh_sha256), {}, source.link_from_shape};
      for (const std::string& hull : source.shape->hull_sha256)
        shared.hulls.push_back(PooledMeshPath(hull));
      shared.visual = source.shape->visual_files;
      files[link].push_back(std::move(shared));
    }
  }
  return files;
}

std::array<std::vector<std::string>, 3> ShapeNamesOf(const Composed& composed) {
  std::array<std::vector<std::string>, 3> names;
  for (std::size_t link = 0; link < names.size(); ++link) {
    for (const Composed::Source& source : composed.sources[link])
      names[link].push_back(source.shape->sha256);
  }
  return names;
}

}  // namespace

DoorAsset ComposeDoor(const Part& body, const Part& handle, const ComposeConfig& config,
                      const std::optional<RigidTransform>& body_from_handle) {
  internal::CheckComposeConfig(config);
  CheckPair(body, handle);
  const PreparedPart prepared_body(body, config);
  const PreparedPart prepared_handle(handle, config);
  Composed composed =
      Compose({prepared_body.state(), prepared_handle.state(), config, body_from_handle});
  AddMeshes(composed);
  return std::move(composed.door);
}

SharedDoor ComposeSharedDoor(const PreparedPart& body, const PreparedPart& handle,
                             const ComposeConfig& config,
                             const std::optional<RigidTransform>& body_from_handle) {
  const Composed composed = Compose({body.state(), handle.state(), config, body_from_handle});
  const DoorFiles files = SharedFilesOf(composed);
  return {composed.door.id, PooledDoorText(composed.door, files, ShapeNamesOf(composed)),
          ToCompactUrdf(ToUrdfModel(composed.door, files))};
}

}  // namespace doorforge
