// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nanoflann.hpp>

#include "doorforge/schemas/part.h"

namespace doorforge {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using PointTree = nanoflann::KDTreeEigenMatrixAdaptor<Points, 3>;

inline constexpr int kShapePoints = 4096;

/// A part's surface, centred on its bounding box and scaled to a diagonal of 1.
struct PartShape {
  std::string id;
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  Points points;  ///< kShapePoints of them, spread evenly over the area.
  /// Over `points` of this object; built by BuildTree() when the shape lies where it stays.
  std::unique_ptr<PointTree> tree;
};

/// Measures the pieces of this name, or all if it is empty. Deterministic.
PartShape ShapeOf(const Part& part, const std::string& piece_name);

/// The folders that hold a part.json, sorted.
std::vector<std::filesystem::path> PartFolders(const std::filesystem::path& root);

void BuildTree(PartShape& shape);

/// Mean distance from every `stride`-th point to the nearest point of the other, averaged over both
/// directions. Two independent samples of one shape are about half the mean spacing apart, not 0.
double Chamfer(const PartShape& a, const PartShape& b, int stride = 1);

/// Whether the surfaces, not their samples, coincide: the mean distance from 256 points of each to
/// the other's triangles is at most `tolerance` of the diagonal.
bool SameSurface(const PartShape& a, const PartShape& b, double tolerance);

}  // namespace doorforge
