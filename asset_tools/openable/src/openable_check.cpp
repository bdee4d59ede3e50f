// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/openable/openable_check.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/solid_overlap.h"
#include "doorforge/physics/leaf_sweep.h"
#include "doorforge/physics/opening_trial.h"
#include "doorforge/rollout/grasp_plan.h"

namespace doorforge {
namespace {

std::string Number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string PlaceOf(const SweepOverlap& overlap) {
  return "door.json: \"" + overlap.moving + "\" in \"" + overlap.fixed + "\"";
}

std::string Measured(double depth_m, const SweepOverlap& overlap) {
  return Number(depth_m) + " m at hinge " + Number(overlap.hinge_rad) + " rad, handle " +
         Number(overlap.handle_rad) + " rad";
}

void AddOverlap(const char* code, const SweepOverlap& overlap, std::vector<Finding>& findings) {
  if (overlap.depth_m <= RuleLimit(code)) return;
  findings.push_back(FindingOf(code, PlaceOf(overlap), Measured(overlap.depth_m, overlap)));
}

// How far the meshes of a pair of pieces are in each other where these are.
struct DrawnOverlap {
  double depth_m = 0;
  double from_hinge_m = 0;  // of the nearest point to the axis
};

/// Tells overlaps that are drawn from those that collision shapes have made up.
class DrawnOverlaps {
 public:
  explicit DrawnOverlaps(const DoorAsset& door) : door_(door) {}

  DrawnOverlap Of(const SweepOverlap& pair) {
    constexpr double kStep = 0.012;
    const auto [link, moving] = Find(pair.moving);
    const RigidTransform pose =
        DoorFromLinks(door_, pair.hinge_rad, pair.handle_rad)[static_cast<std::size_t>(link)];
    std::unique_ptr<SolidOverlap>& solids = solids_[{pair.moving, pair.fixed}];
    if (!solids)
      solids = std::make_unique<SolidOverlap>(moving->mesh, Find(pair.fixed).second->mesh);
    const std::array<TriangleMesh, 2> regions = {Transformed(*pair.moving_hull, pose),
                                                 *pair.fixed_hull};
    const std::vector<Eigen::Vector3d> surface = solids->CommonSurface(pose, regions, kStep);
    // both are lower bounds; the former alone takes a small piece deep in a large one for shallow
    const double depth_m = std::max(LeastExtent(surface, {&pair.direction, 1}),
                                    solids->DepthAlong(pose, regions, pair.direction, surface));
    DrawnOverlap drawn{depth_m, 1e300};
    for (const Eigen::Vector3d& point : surface)
      drawn.from_hinge_m = std::min(drawn.from_hinge_m, FromHinge(point));
    return drawn;
  }

 private:
  std::pair<int, const DoorGeometry*> Find(const std::string& name) const {
    for (int link = 0; link < static_cast<int>(door_.links.size()); ++link) {
      for (const DoorGeometry& geometry : door_.links[static_cast<std::size_t>(link)].geometry) {
        if (geometry.name == name) return {link, &geometry};
      }
    }
    return {0, nullptr};
  }

  double FromHinge(const Eigen::Vector3d& point) const {
    const RigidTransform& hinge = door_.hinge.parent_from_child_at_zero;
    return (hinge.linear() * door_.hinge.axis).cross(point - hinge.translation()).norm();
  }

  const DoorAsset& door_;
  std::map<std::pair<std::string, std::string>, std::unique_ptr<SolidOverlap>> solids_;
};

// Meshes that meet at the hinge are a fact of the asset; what meets elsewhere, or what only the
// collision shapes do, is a fault.
void AddOpening(const DoorAsset& door, const LeafSweep& sweep, std::vector<Finding>& findings) {
  constexpr double kAtHinge = 0.1;  // [m]
  DrawnOverlaps drawn_overlaps(door);
  double fault_m = RuleLimit("SWP001");
  double drawn_m = RuleLimit("SWP003");
  const SweepOverlap* fault = nullptr;
  const SweepOverlap* drawn = nullptr;
  for (const SweepOverlap& pair : sweep.opening_pairs) {
    if (pair.depth_m <= std::min(fault_m, drawn_m)) break;
    const DrawnOverlap found = drawn_overlaps.Of(pair);
    const bool at_hinge = found.from_hinge_m <= kAtHinge;
    const double unexplained_m =
        at_hinge ? std::min(pair.depth_m, pair.total_m - found.depth_m) : pair.depth_m;
    if (unexplained_m > fault_m) {
      fault_m = unexplained_m;
      fault = &pair;
    }
    const double explained_m = std::min(pair.depth_m, found.depth_m);
    if (at_hinge && explained_m > drawn_m) {
      drawn_m = explained_m;
      drawn = &pair;
    }
  }
  if (fault != nullptr)
    findings.push_back(FindingOf("SWP001", PlaceOf(*fault), Measured(fault_m, *fault)));
  if (drawn != nullptr)
    findings.push_back(FindingOf("SWP003", PlaceOf(*drawn), Measured(drawn_m, *drawn)));
}

void AddTrial(const OpeningTrial& trial, std::vector<Finding>& findings) {
  const auto add = [&](const char* code, const char* where, const std::string& measured) {
    findings.push_back(FindingOf(code, std::string("door.json: ") + where, measured));
  };
  if (!trial.finite) return add("OPN006", "joints", "diverged");
  if (!trial.held) add("OPN001", "latch", Number(trial.given_rad) + " rad");
  if (!trial.unlocked)
    return add("OPN002", "latch", "handle at " + Number(trial.turned_rad) + " rad, locked");
  if (trial.latched && trial.returned_rad > RuleLimit("OPN003"))
    add("OPN003", "handle_joint", Number(trial.returned_rad) + " rad");
  if (trial.opened_rad <= RuleLimit("OPN004"))
    add("OPN004", "hinge",
        Number(trial.opened_rad) + " rad after " + Number(trial.opened_s) + " s");
}

}  // namespace

OpenableCheck::OpenableCheck() : robot_(std::make_shared<const RobotModel>(LoadMobileFranka())) {}

std::vector<Finding> OpenableCheck::operator()(const DoorAsset& door) const {
  std::vector<Finding> findings;
  AddTrial(TryOpening(door), findings);
  const LeafSweep sweep = SweepLeaf(door);
  AddOpening(door, sweep, findings);
  AddOverlap("SWP002", sweep.closed, findings);
  const double cost = GraspCost(door, *robot_);
  if (cost > RuleLimit("OPN005"))
    findings.push_back(FindingOf("OPN005", "door.json: handle_from_grasp", Number(cost)));
  return findings;
}

}  // namespace doorforge
