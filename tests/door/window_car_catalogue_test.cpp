// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/compose/compose.h"
#include "doorforge/parts/grasp.h"

#include "catalogue_parts.h"

namespace doorforge {
namespace {

std::vector<CatalogueEntry> EntriesOf(Category category, PartRole role) {
  std::vector<CatalogueEntry> entries = ListCatalogue(DataOfSource());
  std::erase_if(entries, [&](const CatalogueEntry& entry) {
    return entry.category != category || entry.role != role;
  });
  return entries;
}

const std::vector<Part>& PartsOf(Category category, PartRole role) {
  static std::map<std::pair<Category, PartRole>, std::vector<Part>> built;
  std::vector<Part>& parts = built[{category, role}];
  if (parts.empty()) {
    for (const CatalogueEntry& entry : EntriesOf(category, role))
      parts.push_back(PartNamed(entry.id));
  }
  return parts;
}

std::size_t FamiliesOf(Category category, PartRole role) {
  std::set<std::string> families;
  for (const CatalogueEntry& entry : EntriesOf(category, role)) families.insert(entry.family);
  return families.size();
}

Eigen::AlignedBox3d BoundsOf(const Part& part) {
  Eigen::AlignedBox3d bounds;
  for (const PartPiece& piece : part.pieces) {
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) bounds.extend(vertex);
  }
  return bounds;
}

// Whether the line along x through (y, z) passes a mesh, with a margin around it.
bool MeetsNothing(const TriangleMesh& mesh, const Eigen::Vector2d& at, double margin_m) {
  const auto crosses = [&](double y, double z) {
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
      double area[3];
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[k])];
        const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
        area[k] = (a.y() - y) * (b.z() - z) - (a.z() - z) * (b.y() - y);
      }
      return (area[0] > 0 && area[1] > 0 && area[2] > 0) ||
             (area[0] < 0 && area[1] < 0 && area[2] < 0);
    });
  };
  const double m = margin_m;
  return !crosses(at.x(), at.y()) && !crosses(at.x() + m, at.y()) && !crosses(at.x() - m, at.y()) &&
         !crosses(at.x(), at.y() + m) && !crosses(at.x(), at.y() - m);
}

/// A hull as planes, with its bounds.
struct Convex {
  explicit Convex(const TriangleMesh& hull) {
    for (const Eigen::Vector3d& vertex : hull.vertices) bounds.extend(vertex);
    for (const Eigen::Vector3i& t : hull.triangles) {
      const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
      const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
      const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
      const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      planes.emplace_back(normal.x(), normal.y(), normal.z(), -normal.dot(a));
    }
  }

  bool HoldsDeeper(const Eigen::Vector3d& point, double depth_m) const {
    return bounds.contains(point) &&
           std::all_of(planes.begin(), planes.end(), [&](const Eigen::Vector4d& plane) {
             return plane.dot(point.homogeneous()) < -depth_m;
           });
  }

  Eigen::AlignedBox3d bounds;
  std::vector<Eigen::Vector4d> planes;
};

std::vector<Convex> ConvexOf(const PartPiece& piece) {
  std::vector<Convex> convex;
  for (const TriangleMesh& hull : piece.hulls) convex.emplace_back(hull);
  return convex;
}

// The released ones are scaled to 0.15 m; those of the catalogue may be a little larger.
TEST(WindowsAndCars, HandlesAreAsTallAsTheMeasuredOnes) {
  for (const Part& handle : PartsOf(Category::kWindow, PartRole::kHandle)) {
    const double height = BoundsOf(handle).sizes().z();
    EXPECT_GE(height, 0.1475) << handle.id;
    EXPECT_LE(height, 0.18) << handle.id;
  }
}

TEST(WindowsAndCars, AreOfManyFamilies) {
  EXPECT_GE(FamiliesOf(Category::kWindow, PartRole::kBody), 4u);
  EXPECT_GE(FamiliesOf(Category::kWindow, PartRole::kHandle), 5u);
  EXPECT_GE(FamiliesOf(Category::kCar, PartRole::kBody), 4u);
  EXPECT_GE(FamiliesOf(Category::kCar, PartRole::kHandle), 4u);
}

TEST(WindowsAndCars, HaveTheSizesMeasuredOnReleasedObjects) {
  for (const Part& body : PartsOf(Category::kWindow, PartRole::kBody)) {
    const Eigen::Vector3d size = BoundsOf(body).sizes();
    EXPECT_GE(size.y(), 0.63) << body.id;
    EXPECT_LE(size.y(), 1.365) << body.id;
    EXPECT_GE(size.z(), 0.625) << body.id;
    EXPECT_LE(size.z(), 1.65) << body.id;
    EXPECT_LE(size.x(), 0.175) << body.id;
    const double to_mount = body.part_from_mount.translation().y();
    EXPECT_GE(to_mount, 0.444) << body.id;
    EXPECT_LE(to_mount, 0.895) << body.id;
  }
  for (const Part& body : PartsOf(Category::kCar, PartRole::kBody)) {
    const double to_mount = body.part_from_mount.translation().y();
    EXPECT_GE(to_mount, 0.73) << body.id;
    EXPECT_LE(to_mount, 1.1) << body.id;
    if (FindPiece(body, "frame") == nullptr) continue;
    const Eigen::Vector3d size = BoundsOf(body).sizes();
    EXPECT_NEAR(size.y(), 4.0, 1e-6) << body.id;
    EXPECT_GE(size.x(), 1.57) << body.id;
    EXPECT_LE(size.x(), 1.99) << body.id;
    EXPECT_LE(size.z(), 1.96) << body.id;
  }
  for (const Part& handle : PartsOf(Category::kCar, PartRole::kHandle))
    EXPECT_NEAR(BoundsOf(handle).sizes().y(), 0.2, 0.015) << handle.id;
}

TEST(WindowsAndCars, HandlesTurnAsInTheReleaseAndAnOpenGripperHoldsThem) {
  for (const Category category : {Category::kWindow, Category::kCar}) {
    for (const Part& handle : PartsOf(category, PartRole::kHandle)) {
      const bool car = category == Category::kCar;
      EXPECT_EQ(handle.mechanism, car ? Mechanism::kFlap : Mechanism::kLever) << handle.id;
      const Eigen::Vector3d axis =
          car ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
      EXPECT_TRUE(handle.joint.axis.isApprox(axis)) << handle.id;
      EXPECT_NEAR(handle.joint.upper_rad, (car ? 10 : 45) * std::numbers::pi / 180, 1e-12);
      TriangleMesh all;
      for (const PartPiece& piece : handle.pieces) {
        const int offset = static_cast<int>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), piece.mesh.vertices.begin(),
                            piece.mesh.vertices.end());
        for (const Eigen::Vector3i& t : piece.mesh.triangles)
          all.triangles.emplace_back(t.array() + offset);
      }
      const GraspFit fit =
          MeasureGrasp(FindPiece(handle, "grip")->mesh, all, handle.part_from_grasp);
      EXPECT_TRUE(fit.holds) << handle.id << " contact " << fit.contact;
      EXPECT_GE(fit.tip_clearance_m, 0.002) << handle.id;
    }
  }
}

TEST(WindowsAndCars, OpeningsAreFreeOfCollisionShapes) {
  int with_openings = 0;
  for (const Category category : {Category::kWindow, Category::kCar}) {
    for (const Part& body : PartsOf(category, PartRole::kBody)) {
      const PartPiece& leaf = *FindPiece(body, "leaf");
      Eigen::AlignedBox3d bounds;
      for (const Eigen::Vector3d& vertex : leaf.mesh.vertices) bounds.extend(vertex);
      const std::vector<Convex> shapes = ConvexOf(leaf);
      int free_lines = 0;
      constexpr int kLines = 12;
      for (int i = 1; i < kLines; ++i) {
        for (int j = 1; j < kLines; ++j) {
          const Eigen::Vector3d at =
              bounds.min() + Eigen::Vector3d(0, i, j).cwiseProduct(bounds.sizes()) / kLines;
          if (!MeetsNothing(leaf.mesh, {at.y(), at.z()}, 0.012)) continue;
          ++free_lines;
          for (int k = 0; k <= 20; ++k) {
            const Eigen::Vector3d point(bounds.min().x() + bounds.sizes().x() * k / 20, at.y(),
                                        at.z());
            for (const Convex& shape : shapes)
              EXPECT_FALSE(shape.HoldsDeeper(point, 0.001)) << body.id << " at " << point;
          }
        }
      }
      with_openings += free_lines > 8;
    }
  }
  EXPECT_GE(with_openings, 30);
}

}  // namespace
}  // namespace doorforge
