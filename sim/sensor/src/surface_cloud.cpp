// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/surface_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace doorforge {
namespace {

struct Facet {
  std::array<Eigen::Vector3d, 3> corners;
  const VisibleMesh* mesh;
  double area_to_here;  // [m^2] of this and those before
};

std::vector<Facet> FacetsOf(std::span<const VisibleMesh> meshes) {
  std::vector<Facet> facets;
  double area = 0;
  for (const VisibleMesh& mesh : meshes) {
    for (const Eigen::Vector3i& triangle : mesh.mesh.triangles) {
      Facet facet{{}, &mesh, 0};
      for (std::size_t i = 0; i < 3; ++i)
        facet.corners.at(i) =
            mesh.mesh.vertices[static_cast<std::size_t>(triangle[static_cast<Eigen::Index>(i)])];
      const auto& [a, b, c] = facet.corners;
      area += (b - a).cross(c - a).norm() / 2;
      facet.area_to_here = area;
      facets.push_back(facet);
    }
  }
  return facets;
}

}  // namespace

SurfaceCloud::SurfaceCloud(std::span<const VisibleMesh> meshes, int count, Rng rng) {
  const std::vector<Facet> facets = FacetsOf(meshes);
  if (facets.empty() || !(facets.back().area_to_here > 0)) return;
  for (int i = 0; i < count; ++i) {
    const double at = rng.Uniform(0, facets.back().area_to_here);
    const auto found = std::ranges::upper_bound(facets, at, {}, &Facet::area_to_here);
    const Facet& facet = found == facets.end() ? facets.back() : *found;
    // Osada et al., Shape Distributions, 2002, section 3.2
    const double root = std::sqrt(rng.Uniform());
    const double along = rng.Uniform();
    const Eigen::Vector3d point = (1 - root) * facet.corners[0] +
                                  root * (1 - along) * facet.corners[1] +
                                  root * along * facet.corners[2];
    points_.push_back({point, facet.mesh->link, facet.mesh->label});
  }
}

LabelledCloud SurfaceCloud::At(std::span<const RigidTransform> world_from_link,
                               double min_height_m) const {
  LabelledCloud cloud;
  for (const Point& point : points_) {
    const Eigen::Vector3d place =
        world_from_link[static_cast<std::size_t>(point.link)] * point.in_link_m;
    if (!(place.z() > min_height_m)) continue;
    for (const double number : place) cloud.xyz.push_back(static_cast<float>(number));
    cloud.label.push_back(static_cast<std::uint8_t>(point.label));
  }
  return cloud;
}

}  // namespace doorforge
