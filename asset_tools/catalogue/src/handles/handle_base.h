// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "doorforge/core/named_enum.h"

#include "family.h"

namespace doorforge::internal {

/// Outline of a rose, seen from the front. The last four are long plates, as high as `height_m`.
enum class RoseShape {
  kRound,
  kSquare,
  kOctagon,
  kOval,
  kPlate,
  kStadium,  ///< Its ends are half circles.
  kTablet,   ///< Its corners are cut.
  kLens,     ///< It is an ellipse.
  kNone,
};
inline constexpr NamedValue<RoseShape> kRoseShapeWords[] = {
    {RoseShape::kRound, "round"},     {RoseShape::kSquare, "square"},
    {RoseShape::kOctagon, "octagon"}, {RoseShape::kOval, "oval"},
    {RoseShape::kPlate, "plate"},     {RoseShape::kStadium, "stadium"},
    {RoseShape::kTablet, "tablet"},   {RoseShape::kLens, "lens"},
    {RoseShape::kNone, "none"}};
constexpr std::span<const NamedValue<RoseShape>> ValuesOf(RoseShape) { return kRoseShapeWords; }

/// How the front of a rose is shaped.
enum class RoseFace {
  kFlat,
  kDomed,
  kStepped,
};
inline constexpr NamedValue<RoseFace> kRoseFaceWords[] = {
    {RoseFace::kFlat, "flat"}, {RoseFace::kDomed, "domed"}, {RoseFace::kStepped, "stepped"}};
constexpr std::span<const NamedValue<RoseFace>> ValuesOf(RoseFace) { return kRoseFaceWords; }

/// The lock on a long plate, or on an escutcheon of its own.
enum class RoseLock {
  kNone,
  kCylinder,
  kThumbTurn,
};
inline constexpr NamedValue<RoseLock> kRoseLockWords[] = {{RoseLock::kNone, "none"},
                                                          {RoseLock::kCylinder, "cylinder"},
                                                          {RoseLock::kThumbTurn, "thumb_turn"}};
constexpr std::span<const NamedValue<RoseLock>> ValuesOf(RoseLock) { return kRoseLockWords; }

/// What is fixed to the leaf under a lever or a knob.
struct RoseParameters {
  RoseShape shape = RoseShape::kRound;
  double width_m = 0.052;  ///< Along y.
  double height_m = 0.22;  ///< Only a plate, stadium, tablet or lens has it; it is along z.
  double center = -0.14;   ///< Their middle is so far above the axis, as a share of the height.
  RoseFace face = RoseFace::kFlat;
  double thickness_m = 0.009;
  bool keyhole = false;  ///< A plate's cylinder boss below the handle.
  RoseLock lock = RoseLock::kNone;
  double lock_drop_m = 0.075;  ///< From the axis down to the lock; negative: above it.
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
    visit("width_m", self.width_m);
    visit("height_m", self.height_m);
    visit("center", self.center);
    visit("face", self.face);
    visit("thickness_m", self.thickness_m);
    visit("keyhole", self.keyhole);
    visit("lock", self.lock);
    visit("lock_drop_m", self.lock_drop_m);
    visit("finish", self.finish);
  }
};

/// Adds the piece "rose" and returns the x at which the grip may begin.
double AddRose(const RoseParameters& rose, const std::string& path, Part& part);

/// Grasp pose at a point: approach against x, fingers closing along z (levers, knobs) or along y
/// (vertical bars).
enum class Closing { kVertical, kHorizontal };
RigidTransform GraspAt(const Eigen::Vector3d& position_m, Closing closing);

/// Turns about x through the mount from 0 to 45 degrees (UniDoorManip's override), or not at all.
PartJoint HandleJoint(bool turns);

}  // namespace doorforge::internal
