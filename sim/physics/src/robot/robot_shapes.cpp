// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/robot_shapes.h"

#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"

#include "collision/convex_hull.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCorners = 96;
constexpr int kSides = 24;  // of a cylinder; a sphere has half as many rings

TriangleMesh HullMesh(const std::vector<Eigen::Vector3d>& points) {
  return ConvexHullOf(points, points.size());
}

TriangleMesh BoxMesh(const Eigen::Vector3d& size) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners.emplace_back(0.5 * size.cwiseProduct(sign));
  }
  return HullMesh(corners);
}

void AddRing(double radius, double z, std::vector<Eigen::Vector3d>& points) {
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

TriangleMesh CylinderMesh(const UrdfCylinder& cylinder) {
  std::vector<Eigen::Vector3d> points;
  for (const double way : {-0.5, 0.5}) AddRing(cylinder.radius_m, way * cylinder.length_m, points);
  return HullMesh(points);
}

TriangleMesh SphereMesh(const UrdfSphere& sphere) {
  constexpr int kRings = 7;
  std::vector<Eigen::Vector3d> points{{0, 0, sphere.radius_m}, {0, 0, -sphere.radius_m}};
  for (int i = 1; i <= kRings; ++i) {
    const double angle = std::numbers::pi * i / (kRings + 1);
    AddRing(sphere.radius_m * std::sin(angle), sphere.radius_m * std::cos(angle), points);
  }
  return HullMesh(points);
}

std::string WithoutScheme(const std::string& filename, const std::string& scheme) {
  return filename.starts_with(scheme) ? filename.substr(scheme.size()) : filename;
}

RobotPiece Placed(RobotPiece piece, const UrdfShape& shape, const RobotFrame& frame) {
  const RigidTransform body_from_shape = frame.body_from_frame * shape.link_from_shape;
  piece.name = shape.name;
  piece.joint = frame.joint;
  for (Eigen::Vector3d& vertex : piece.mesh.vertices) vertex = body_from_shape * vertex.eval();
  if (shape.color_rgba) piece.color_rgba = *shape.color_rgba;
  return piece;
}

}  // namespace

// package://NAME/rest lies below a folder NAME somewhere above the URDF, or in a folder that is
// the package; writers that name no package are met halfway.
fs::path RobotShapes::PathOf(const std::string& filename) const {
  constexpr int kFoldersUp = 8;
  if (!filename.starts_with("package://")) return folder_ / WithoutScheme(filename, "file://");
  const fs::path inside = WithoutScheme(filename, "package://");
  const fs::path rest = inside.lexically_relative(*inside.begin());
  std::vector<fs::path> roots;
  for (const std::string& root : options_.package_folders) roots.push_back(folder_ / root);
  fs::path up = fs::absolute(folder_ / ".").lexically_normal().parent_path();
  for (int i = 0; i < kFoldersUp && up.has_relative_path(); ++i, up = up.parent_path())
    roots.push_back(up);
  for (const fs::path& root : roots) {
    for (const fs::path& candidate : {root / inside, root / rest}) {
      if (fs::is_regular_file(candidate)) return candidate;
    }
  }
  return {};
}

TriangleMesh RobotShapes::Read(const std::string& where, const UrdfMeshFile& file) {
  const fs::path path = PathOf(file.filename);
  if (path.empty() || !fs::is_regular_file(path)) {
    faults_.Add(where + ": no file \"" + file.filename + '"' +
                (path.empty() ? " in the folders above the URDF; add its package's folder to "
                                "`package_folders` in NAME.robot.yaml"
                              : ""));
    return {};
  }
  const auto [entry, fresh] = read_.try_emplace(path);
  if (!fresh) return entry->second;
  try {
    entry->second = read_mesh_(path);
  } catch (const Error& error) {
    faults_.Add(where + ": " + error.what());
  }
  return entry->second;
}

TriangleMesh RobotShapes::MeshOf(const std::string& where, const UrdfGeometry& geometry) {
  if (const auto* box = std::get_if<UrdfBox>(&geometry)) return BoxMesh(box->size_m);
  if (const auto* cylinder = std::get_if<UrdfCylinder>(&geometry)) return CylinderMesh(*cylinder);
  if (const auto* sphere = std::get_if<UrdfSphere>(&geometry)) return SphereMesh(*sphere);
  if (const auto* triangles = std::get_if<UrdfTriangles>(&geometry)) return triangles->mesh;
  const auto& file = std::get<UrdfMeshFile>(geometry);
  TriangleMesh mesh = Read(where, file);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(file.scale).eval();
  if (file.scale.prod() < 0) {
    for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

RobotPiece RobotShapes::Visual(const std::string& link, const UrdfShape& shape,
                               const RobotFrame& frame) {
  RobotPiece piece;
  piece.mesh = MeshOf("link \"" + link + "\", visual", shape.geometry);
  return Placed(std::move(piece), shape, frame);
}

RobotPiece RobotShapes::Hull(const std::string& link, const UrdfShape& shape,
                             const RobotFrame& frame) {
  const std::string where = "link \"" + link + "\", collision";
  RobotPiece piece;
  piece.mesh = MeshOf(where, shape.geometry);
  const bool read = !piece.mesh.vertices.empty();
  if (piece.mesh.vertices.size() > kMostCorners || !IsConvex(piece.mesh))
    piece.mesh = ConvexHullOf(piece.mesh.vertices, kMostCorners);
  if (read && piece.mesh.vertices.empty()) faults_.Add(where + ": the shape has no volume");
  return Placed(std::move(piece), shape, frame);
}

}  // namespace doorforge::internal
