// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/grasp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "doorforge/mesh/work_budget.h"

#include "solid_columns.h"

namespace doorforge {
namespace {

using internal::SolidColumns;
using internal::SolidInterval;

constexpr double kCell = 0.002;          // [m]
constexpr double kTouchDepth = 0.0025;   // [m] how much a rubber pad gives
constexpr double kGapEachSide = 0.0015;  // [m] free between an open finger and the material
constexpr double kMinContact = 0.12;
constexpr double kMinTipClearance = 0.002;  // [m]

// Grip and handle in columns along the closing direction, seen from the proposal's frame turned
// about its approach. Offsets are coordinates in that frame.
struct Cut {
  RigidTransform part_from_cut;
  SolidColumns grip;
  SolidColumns handle;
};

Cut MakeCut(const TriangleMesh& grip, const TriangleMesh& handle,
            const RigidTransform& part_from_cut) {
  const RigidTransform cut_from_part = part_from_cut.inverse();
  return {part_from_cut, SolidColumns(grip, cut_from_part, kCell),
          SolidColumns(handle, cut_from_part, kCell)};
}

struct PadColumn {
  double low;
  double high;
};

// what the grip has between the open fingers in front of the pads; nothing if a finger is blocked
std::optional<std::vector<PadColumn>> BetweenPads(const Cut& cut, const Eigen::Vector3d& at,
                                                  const GripperShape& gripper) {
  const double open = gripper.opening_m / 2 - kGapEachSide;
  const Eigen::Vector2d center(at.x(), at.z());
  const Eigen::Vector2d half(gripper.pad_half_width_m, gripper.pad_half_depth_m);
  std::vector<PadColumn> pads;
  bool blocked = false;
  cut.grip.ForEachIn(
      center - half, center + half, [&](double, double, std::span<const SolidInterval> column) {
        PadColumn pad{std::numeric_limits<double>::infinity(),
                      -std::numeric_limits<double>::infinity()};
        for (const SolidInterval& solid : column) {
          if (solid.high < at.y() - open || solid.low > at.y() + open) continue;
          blocked = blocked || solid.low < at.y() - open || solid.high > at.y() + open;
          pad.low = std::min(pad.low, solid.low);
          pad.high = std::max(pad.high, solid.high);
        }
        if (pad.high >= pad.low) pads.push_back(pad);
      });
  if (blocked) return std::nullopt;
  return pads;
}

bool Meets(std::span<const SolidInterval> column, double low, double high) {
  return std::any_of(column.begin(), column.end(), [&](const SolidInterval& solid) {
    return solid.high > low && solid.low < high;
  });
}

// open fingers in place, and the way there: everything between a finger and the palm side
bool FingersFree(const Cut& cut, const Eigen::Vector3d& at, const GripperShape& gripper) {
  const double inner = gripper.opening_m / 2 - kGapEachSide;
  const double outer = gripper.opening_m / 2 + gripper.finger_thickness_m;
  bool free = true;
  cut.handle.ForEachIn({at.x() - gripper.finger_half_width_m, -1.0},
                       {at.x() + gripper.finger_half_width_m, at.z() + gripper.tip_m},
                       [&](double, double, std::span<const SolidInterval> column) {
                         free = free && !Meets(column, at.y() - outer, at.y() - inner) &&
                                !Meets(column, at.y() + inner, at.y() + outer);
                       });
  // the palm is wider than the fingers on both sides
  cut.handle.ForEachIn({at.x() - 0.03, -1.0}, {at.x() + 0.03, at.z() - gripper.finger_reach_m},
                       [&](double, double, std::span<const SolidInterval> column) {
                         free = free && !Meets(column, at.y() - 0.1, at.y() + 0.1);
                       });
  return free;
}

double ContactShare(const std::vector<PadColumn>& pads, double low, double high,
                    const GripperShape& gripper) {
  int at_low = 0;
  int at_high = 0;
  for (const PadColumn& pad : pads) {
    at_low += pad.low < low + kTouchDepth ? 1 : 0;
    at_high += pad.high > high - kTouchDepth ? 1 : 0;
  }
  const double area = 4 * gripper.pad_half_width_m * gripper.pad_half_depth_m;
  return std::min(1.0, std::min(at_low, at_high) * kCell * kCell / area);
}

GraspFit FitAt(const Cut& cut, const Eigen::Vector3d& at, const GripperShape& gripper) {
  CheckWork(2000);
  GraspFit fit;
  const Eigen::Vector3d tip = cut.part_from_cut * (at + Eigen::Vector3d(0, 0, gripper.tip_m));
  fit.tip_clearance_m = tip.x();
  const std::optional<std::vector<PadColumn>> pads = BetweenPads(cut, at, gripper);
  if (!pads || pads->empty()) return fit;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PadColumn& pad : *pads) {
    low = std::min(low, pad.low);
    high = std::max(high, pad.high);
  }
  fit.width_m = high - low;
  fit.off_center_m = (low + high) / 2 - at.y();
  fit.contact = ContactShare(*pads, low, high, gripper);
  fit.fingers_free = FingersFree(cut, at, gripper);
  return WithTipClearance(fit, fit.tip_clearance_m);
}

struct Candidate {
  Eigen::Vector3d at;
  GraspFit fit;
};

// moved along the closing direction until the material is in the middle
Candidate Centered(const Cut& cut, const Eigen::Vector3d& at, const GripperShape& gripper) {
  Candidate candidate{at, FitAt(cut, at, gripper)};
  for (int i = 0; i < 2 && candidate.fit.width_m > 0; ++i) {
    if (std::abs(candidate.fit.off_center_m) < 5e-4) break;
    candidate.at.y() += candidate.fit.off_center_m;
    candidate.fit = FitAt(cut, candidate.at, gripper);
  }
  return candidate;
}

struct SearchSpan {
  double across_m;
  double depth_m;
};

// contact is worth a few millimetres of displacement, no more
double Worth(const Candidate& candidate) {
  if (!candidate.fit.holds) return -std::numeric_limits<double>::infinity();
  return std::min(candidate.fit.contact, 0.6) - 8 * std::abs(candidate.at.x()) -
         4 * std::abs(candidate.at.y()) - 8 * std::abs(candidate.at.z());
}

Candidate BestIn(const Cut& cut, const SearchSpan& span, const GripperShape& gripper) {
  Candidate best = Centered(cut, Eigen::Vector3d::Zero(), gripper);
  const int across = static_cast<int>(std::lround(span.across_m / kCell / 2));
  const int depth = static_cast<int>(std::lround(span.depth_m / kCell));
  for (int i = -across; i <= across; ++i) {
    for (int k = -depth; k <= depth; ++k) {
      const Candidate candidate =
          Centered(cut, Eigen::Vector3d(2 * i * kCell, 0, k * kCell), gripper);
      if (Worth(candidate) > Worth(best)) best = candidate;
    }
  }
  return best;
}

// how far along +-axis the grasp still holds, the smaller of both ways
double HoldingReach(const Cut& cut, const Candidate& grasp, int axis, const GripperShape& gripper) {
  double reach = 0.04;
  for (const double way : {-1.0, 1.0}) {
    double held = 0;
    while (held < reach) {
      Eigen::Vector3d at = grasp.at;
      at[axis] += way * (held + kCell);
      if (!FitAt(cut, at, gripper).holds) break;
      held += kCell;
    }
    reach = std::min(reach, held);
  }
  return reach;
}

RefinedGrasp Finish(const Cut& cut, const Candidate& best, double turned_rad,
                    const GripperShape& gripper) {
  RefinedGrasp refined;
  refined.part_from_grasp = cut.part_from_cut * Translation(best.at);
  refined.fit = best.fit;
  refined.moved_m = best.at.norm();
  refined.turned_rad = turned_rad;
  for (int axis = 0; axis < 3; ++axis)
    refined.half_extent_m[axis] = HoldingReach(cut, best, axis, gripper);
  return refined;
}

}  // namespace

GraspFit MeasureGrasp(const TriangleMesh& grip, const TriangleMesh& handle,
                      const RigidTransform& part_from_grasp, const GripperShape& gripper) {
  return FitAt(MakeCut(grip, handle, part_from_grasp), Eigen::Vector3d::Zero(), gripper);
}

GraspFit WithTipClearance(GraspFit fit, double tip_clearance_m) {
  fit.tip_clearance_m = tip_clearance_m;
  fit.holds = fit.fingers_free && fit.contact >= kMinContact && tip_clearance_m >= kMinTipClearance;
  return fit;
}

RefinedGrasp RefineGrasp(const TriangleMesh& grip, const TriangleMesh& handle,
                         const RigidTransform& proposal, const GripperShape& gripper) {
  const Cut straight = MakeCut(grip, handle, proposal);
  const Candidate near = BestIn(straight, {0.008, 0.02}, gripper);
  if (near.fit.holds) return Finish(straight, near, 0, gripper);
  const Candidate far = BestIn(straight, {0.1, 0.04}, gripper);
  if (far.fit.holds) return Finish(straight, far, 0, gripper);

  std::optional<RefinedGrasp> best;
  double best_worth = -std::numeric_limits<double>::infinity();
  for (int step = 1; step <= 11; ++step) {
    const double turn = (step % 2 == 1 ? 1 : -1) * ((step + 1) / 2) * std::numbers::pi / 12;
    const Cut turned =
        MakeCut(grip, handle, proposal * RotationAbout(Eigen::Vector3d::UnitZ(), turn));
    const Candidate candidate = BestIn(turned, {0.1, 0.04}, gripper);
    const double worth = Worth(candidate) - 0.1 * std::abs(turn);
    if (worth <= best_worth) continue;
    best_worth = worth;
    best = Finish(turned, candidate, turn, gripper);
  }
  return best ? *best : Finish(straight, near, 0, gripper);
}

}  // namespace doorforge
