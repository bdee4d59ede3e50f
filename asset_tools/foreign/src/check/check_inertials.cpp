// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "doorforge/foreign/foreign_rules.h"

#include "check/checks.h"

namespace doorforge::foreign {
namespace {

constexpr double kHeaviestForeignKgM3 = 20000;  // osmium is 22590

// It is that of a whole body of links that fixed joints hold together.
std::vector<double> BodyMasses(const ArticulatedObject& object, const ObjectTree& tree) {
  std::vector<double> masses(object.links.size(), 0);
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    if (object.links[i].inertial) masses[tree.body_of[i]] += object.links[i].inertial->mass_kg;
  }
  return masses;
}

std::vector<bool> BodiesWithInertial(const ArticulatedObject& object, const ObjectTree& tree) {
  std::vector<bool> have(object.links.size(), false);
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    if (object.links[i].inertial) have[tree.body_of[i]] = true;
  }
  return have;
}

void CheckMoments(const ForeignInertial& inertial, FaultList& faults) {
  const bool none = inertial.mass_kg == 0 && inertial.inertia_kg_m2->isZero(0);
  if (none || !(inertial.mass_kg >= 0)) return;
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(*inertial.inertia_kg_m2).eigenvalues();
  if (!(moments[0] > 0))
    faults.Add("INR002", inertial.inertia_place, Measured(moments[0], "kg m2"));
  else if (moments[2] > (moments[0] + moments[1]) * (1 + AnyRule("INR003").limit))
    faults.Add("INR003", inertial.inertia_place,
               Digits(moments[2]) + " above " + Digits(moments[0]) + " + " + Digits(moments[1]) +
                   " kg m2");
}

void CheckSize(const ForeignInertial& inertial, const Eigen::AlignedBox3d& bounds,
               FaultList& faults) {
  if (bounds.isEmpty() || !(inertial.mass_kg > 0)) return;
  const double outside = bounds.exteriorDistance(inertial.center_m);
  if (outside > AnyRule("INR008").limit)
    faults.Add("INR008", inertial.place, Measured(outside, "m"));
  const double volume = bounds.sizes().prod();
  const double density = volume > 1e-12 ? inertial.mass_kg / volume : 1000;
  if (density < AnyRule("INR007").limit || density > kHeaviestForeignKgM3)
    return faults.Add("INR007", inertial.mass_place, Measured(density, "kg/m3"));
  if (!inertial.inertia_kg_m2) return;
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(*inertial.inertia_kg_m2).eigenvalues()[2];
  const double gyration = largest > 0 ? std::sqrt(largest / inertial.mass_kg) : 0;
  const double share = gyration / std::max(bounds.diagonal().norm(), 1e-9);
  constexpr double kLeastShare = 1e-3;
  if (largest > 0 && (share > AnyRule("INR009").limit || share < kLeastShare))
    faults.Add("INR009", inertial.inertia_place, Measured(share, "of the diagonal"));
}

}  // namespace

void CheckInertials(const ArticulatedObject& object, const ObjectTree& tree,
                    const std::vector<LinkBounds>& bounds, FaultList& faults) {
  const std::vector<double> masses = BodyMasses(object, tree);
  const std::vector<bool> have = BodiesWithInertial(object, tree);
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    const ForeignLink& link = object.links[i];
    const std::size_t body = tree.body_of[i];
    if (!link.inertial) {
      const bool lacks = object.traits.needs_masses && body == i && tree.moves[i] && !have[body];
      if (lacks) faults.Add("INR006", link.place, "\"" + link.name + "\" has none");
      continue;
    }
    const ForeignInertial& inertial = *link.inertial;
    const bool weightless = inertial.mass_kg == 0 && tree.moves[i] && masses[body] == 0;
    if (inertial.mass_kg < 0 || weightless)
      faults.Add("INR001", inertial.mass_place, Measured(inertial.mass_kg, "kg"));
    if (inertial.inertia_kg_m2 && !weightless) CheckMoments(inertial, faults);
    const bool sound = !faults.Has("INR001") && !faults.Has("INR002");
    if (sound) CheckSize(inertial, bounds[i].all, faults);
  }
}

}  // namespace doorforge::foreign
