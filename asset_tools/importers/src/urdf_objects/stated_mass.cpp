// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/stated_mass.h"

#include <cmath>
#include <sstream>

#include <Eigen/Eigenvalues>

namespace doorforge::internal {
namespace {

constexpr double kLightestKgM3 = 0.05;
constexpr double kHeaviestKgM3 = 20000;
constexpr double kFarthestOutsideM = 0.1;
constexpr double kMomentSlack = 0.01;  // moments are written with few digits
constexpr double kLeastGyration = 1e-3;
constexpr double kMostGyration = 2;

// Turns may include a reflection, which a tensor does not mind.
MassProperties Moved(const MassProperties& mass, const Eigen::Affine3d& to_from) {
  MassProperties moved = mass;
  moved.center_of_mass_m = to_from * mass.center_of_mass_m;
  moved.inertia_kg_m2 = to_from.linear() * mass.inertia_kg_m2 * to_from.linear().transpose();
  return moved;
}

std::string Text(double number, const char* unit) {
  std::ostringstream text;
  text << number << ' ' << unit;
  return text.str();
}

std::string ProblemOf(const MassProperties& mass, const Eigen::AlignedBox3d& bounds) {
  if (!(mass.mass_kg > 0) || !mass.center_of_mass_m.allFinite() || !mass.inertia_kg_m2.allFinite())
    return "its mass is " + Text(mass.mass_kg, "kg");
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mass.inertia_kg_m2).eigenvalues();
  if (!(moments[0] > 0)) return "a moment of inertia is " + Text(moments[0], "kg m2");
  if (moments[2] > (moments[0] + moments[1]) * (1 + kMomentSlack))
    return "no body has its moments of inertia";
  const double outside = bounds.exteriorDistance(mass.center_of_mass_m);
  if (outside > kFarthestOutsideM)
    return "its centre of mass lies " + Text(outside, "m outside of its shape");
  const double volume = bounds.sizes().prod();
  const double density = volume > 1e-12 ? mass.mass_kg / volume : 1000;
  if (density < kLightestKgM3 || density > kHeaviestKgM3)
    return "it would weigh " + Text(density, "kg/m3 of its box");
  const double gyration = std::sqrt(moments[2] / mass.mass_kg) / bounds.diagonal().norm();
  if (gyration < kLeastGyration || gyration > kMostGyration)
    return "its inertia is that of another size";
  return {};
}

}  // namespace

StatedMass StatedMassOf(const HingedObject& object, const std::vector<TreeLink>& tree,
                        const StatedLinks& links) {
  StatedMass stated;
  std::vector<MassProperties> masses;
  std::string silent;  // a link with a shape and no mass
  for (const std::size_t link : links.links) {
    const UrdfLink& model = object.model.links[link];
    if (!model.inertial) {
      if (links.has_shape[link]) silent = model.name;
      continue;
    }
    const Eigen::Affine3d base_from_link(tree[link].base_from_link.matrix());
    masses.push_back(Moved(*model.inertial, links.piece_from_base * base_from_link));
  }
  if (masses.empty() || links.bounds.isEmpty()) return stated;
  if (!silent.empty()) {
    stated.problem = "link \"" + silent + "\" states none";
    return stated;
  }
  const MassProperties mass = Combined(masses);
  stated.problem = ProblemOf(mass, links.bounds);
  if (stated.problem.empty()) stated.mass = mass;
  return stated;
}

}  // namespace doorforge::internal
