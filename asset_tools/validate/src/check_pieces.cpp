// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/work_budget.h"

#include "findings.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kMaxSamples = 20000;

// Coordinates are floats: the plane of a sliver, lower than this share of the piece's diagonal,
// says nothing about points far from it, and is implied by its neighbours.
constexpr double kSliver = 5e-4;

/// A convex piece as half spaces.
struct HalfSpaces {
  Eigen::AlignedBox3d bounds;
  Eigen::Matrix3Xd normals;  // unit, outwards
  Eigen::VectorXd offsets;

  explicit HalfSpaces(const TriangleMesh& hull)
      : bounds(BoundsOf(hull)),
        normals(3, static_cast<Eigen::Index>(hull.triangles.size())),
        offsets(static_cast<Eigen::Index>(hull.triangles.size())) {
    Eigen::Index count = 0;
    for (const Eigen::Vector3i& t : hull.triangles) {
      const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
      const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
      const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
      if (!(normal.norm() > kSliver * bounds.diagonal().norm() * longest)) continue;
      normals.col(count) = normal.normalized();
      offsets[count] = normals.col(count).dot(a);
      ++count;
    }
    normals.conservativeResize(3, count);
    offsets.conservativeResize(count);
  }

  // How far the point lies outside, by the farthest face plane; negative inside.
  double Outside(const Eigen::Vector3d& point) const {
    return (normals.transpose() * point - offsets).maxCoeff();
  }
};

// Vertices and triangle centres, evenly thinned.
std::vector<Eigen::Vector3d> SurfacePoints(const TriangleMesh& mesh) {
  const std::size_t count = mesh.vertices.size() + mesh.triangles.size();
  const std::size_t stride = count / kMaxSamples + 1;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += stride) points.push_back(mesh.vertices[i]);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int index : mesh.triangles[i]) sum += mesh.vertices[static_cast<std::size_t>(index)];
    points.emplace_back(sum / 3);
  }
  return points;
}

double Uncovered(const TriangleMesh& mesh, const std::vector<HalfSpaces>& hulls) {
  double worst = 0;
  for (const Eigen::Vector3d& point : SurfacePoints(mesh)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const HalfSpaces& hull : hulls) {
      if (hull.bounds.exteriorDistance(point) >= nearest) continue;
      CheckWork(static_cast<unsigned>(hull.offsets.size()));
      nearest = std::min(nearest, hull.Outside(point));
      if (nearest <= 0) break;
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

// Largest distance of a hull's vertex outside one of its own faces; infinite if it is not closed.
double Bulge(const TriangleMesh& hull) {
  if (!ClosedMesh::From(hull)) return std::numeric_limits<double>::infinity();
  const HalfSpaces faces(hull);
  if (faces.offsets.size() == 0) return std::numeric_limits<double>::infinity();
  double bulge = 0;
  for (const Eigen::Vector3d& vertex : hull.vertices) {
    CheckWork(static_cast<unsigned>(faces.offsets.size()));
    bulge = std::max(bulge, faces.Outside(vertex));
  }
  return bulge;
}

Findings CheckMesh(const CheckedPiece& piece) {
  Findings findings;
  const MeshTopology topology = MeasureTopology(piece.mesh);
  const int open =
      topology.boundary_edges + topology.non_manifold_edges + topology.inconsistent_edges;
  if (open > 0 || piece.mesh.triangles.empty()) {
    findings.push_back(Found("MSH005", "",
                             std::to_string(topology.boundary_edges) + " boundary, " +
                                 std::to_string(topology.non_manifold_edges) + " non-manifold, " +
                                 std::to_string(topology.inconsistent_edges) +
                                 " inconsistent edges of " +
                                 std::to_string(piece.mesh.triangles.size()) + " triangles"));
  } else if (topology.volume_m3 <= 0) {
    findings.push_back(Found("MSH006", "", Number(topology.volume_m3) + " m3"));
  }
  if (topology.degenerate_triangles > 0)
    findings.push_back(Found(
        "MSH007", "", std::to_string(topology.degenerate_triangles) + " degenerate triangles"));
  return findings;
}

Findings CheckHulls(const CheckedPiece& piece) {
  Findings findings;
  if (piece.hulls.empty()) return {Found("COL001", "", "none")};
  std::vector<HalfSpaces> convex;
  std::size_t most_vertices = 0;
  for (std::size_t i = 0; i < piece.hulls.size(); ++i) {
    const TriangleMesh& hull = *piece.hulls[i];
    most_vertices = std::max(most_vertices, hull.vertices.size());
    const double bulge = Bulge(hull);
    if (bulge > LimitOf("COL002"))
      findings.push_back(Found("COL002", ", collision shape " + std::to_string(i),
                               std::isinf(bulge) ? "not closed" : Number(bulge) + " m"));
    else
      convex.emplace_back(hull);
  }
  const char* cover = piece.is_handle ? "COL003" : "COL004";
  if (convex.size() == piece.hulls.size() && !piece.mesh.triangles.empty()) {
    const double uncovered = Uncovered(piece.mesh, convex);
    if (uncovered > LimitOf(cover)) findings.push_back(Found(cover, "", Number(uncovered) + " m"));
  }
  if (static_cast<double>(piece.hulls.size()) > LimitOf("COL005"))
    findings.push_back(Found("COL005", "", std::to_string(piece.hulls.size())));
  if (static_cast<double>(most_vertices) > LimitOf("COL006"))
    findings.push_back(Found("COL006", "", std::to_string(most_vertices)));
  return findings;
}

}  // namespace

Findings CheckPiece(const CheckedPiece& piece) {
  Findings findings = CheckMesh(piece);
  Findings hulls = CheckHulls(piece);
  findings.insert(findings.end(), hulls.begin(), hulls.end());
  return findings;
}

Findings CheckMass(const CheckedMass& checked) {
  const MassProperties& mass = checked.mass;
  Findings findings;
  if (!(mass.mass_kg > 0))
    findings.push_back(Found("INR001", checked.where, Number(mass.mass_kg) + " kg"));
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mass.inertia_kg_m2).eigenvalues();
  if (!(moments[0] > 0))
    findings.push_back(Found("INR002", checked.where, Number(moments[0]) + " kg m2"));
  else if (moments[2] > (moments[0] + moments[1]) * (1 + LimitOf("INR003")))
    findings.push_back(Found("INR003", checked.where,
                             Number(moments[2]) + " above " + Number(moments[0]) + " + " +
                                 Number(moments[1]) + " kg m2"));
  if (checked.bounds.isEmpty()) return findings;
  const double outside = checked.bounds.exteriorDistance(mass.center_of_mass_m);
  if (outside > LimitOf("INR004"))
    findings.push_back(Found("INR004", checked.where, Number(outside) + " m"));
  constexpr double kHeaviestKgM3 = 20000;  // osmium is 22590
  const double volume = checked.volume_m3;
  const double density = volume > 0 ? mass.mass_kg / volume : 0;
  if (volume > 0 && mass.mass_kg > 0 && (density < LimitOf("INR005") || density > kHeaviestKgM3))
    findings.push_back(Found("INR005", checked.where, Number(density) + " kg/m3"));
  return findings;
}

Findings CheckLicense(const std::string& license, const std::string& where) {
  if (license.empty()) return {Found("LIC001", where, "empty")};
  if (license.find("NOASSERTION") != std::string::npos) return {Found("LIC002", where, license)};
  return {};
}

}  // namespace doorforge::internal
