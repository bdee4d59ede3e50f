// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/shape_descriptor.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

#include "volume_moments.h"

namespace doorforge {
namespace {

constexpr std::size_t kNumbers = 13;
constexpr double kResolution = 1e-6;
constexpr double kSameWithin = 0.0015;

Eigen::AlignedBox3d BoundsOf(std::span<const TriangleMesh> meshes) {
  Eigen::AlignedBox3d bounds;
  for (const TriangleMesh& mesh : meshes) {
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      for (const int corner : triangle)
        bounds.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
  }
  return bounds;
}

}  // namespace

ShapeDescriptor DescribeShape(std::span<const TriangleMesh> meshes) {
  const Eigen::AlignedBox3d bounds = BoundsOf(meshes);
  if (bounds.isEmpty()) return {};
  const Eigen::Vector3d extents = bounds.sizes();
  // a flat mesh has no extent to divide by, and no volume either
  const Eigen::Vector3d scale = extents.cwiseMax(1e-9 * extents.norm() + 1e-300).cwiseInverse();
  internal::VolumeMoments moments;
  for (const TriangleMesh& mesh : meshes)
    internal::AddMoments(mesh, bounds.center(), scale, moments);
  const Eigen::Vector3d proportions = extents / (extents.norm() + 1e-300);
  ShapeDescriptor numbers(proportions.begin(), proportions.end());
  numbers.push_back(moments.volume);
  numbers.insert(numbers.end(), moments.first.begin(), moments.first.end());
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) numbers.push_back(moments.second(row, column));
  }
  for (double& number : numbers) number = std::round(std::abs(number) / kResolution) * kResolution;
  return numbers;
}

bool SameShape(const ShapeDescriptor& a, const ShapeDescriptor& b) {
  if (a.empty() || a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > kSameWithin) return false;
  }
  return true;
}

ShapeDescriptor ShapeOfRecord(const nlohmann::ordered_json& json, const std::string& path) {
  if (!json.contains("shape")) return {};
  const nlohmann::ordered_json& numbers = json["shape"];
  const bool of_numbers =
      numbers.is_array() && std::all_of(numbers.begin(), numbers.end(),
                                        [](const auto& number) { return number.is_number(); });
  if (!of_numbers || (numbers.size() != kNumbers && !numbers.empty()))
    throw Error(ErrorCode::kFormat,
                path + ".shape: expected " + std::to_string(kNumbers) + " numbers");
  return numbers.get<ShapeDescriptor>();
}

}  // namespace doorforge
