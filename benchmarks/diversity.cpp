// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How different the parts of a collection are: for each part the Chamfer distance to its nearest
// neighbour of the same collection, category and role.
//
//   diversity LABEL=FOLDER...     folders of parts, as `doorforge catalog build` and `import` write
//
// Parts are centred on their bounding box and scaled to a diagonal of 1; the distance is the mean,
// over both directions, of the distance from 4,096 points spread evenly over one surface to the
// nearest of the other's. Parts made from the same source count once.

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>
#include <nanoflann.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/rng.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/part.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Points, 3>;

constexpr int kPoints = 4096;

struct Shape {
  std::string id;
  Points points;
  std::unique_ptr<Tree> tree;
};
// collection, category, role
using Shapes = std::map<std::tuple<std::string, std::string, std::string>, std::vector<Shape>>;

// Evenly over the area: the i-th point lies at (i + 0.5) / n of the running area, at a random place
// of its triangle.
Points SampledSurface(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles) {
  std::vector<double> running;
  double area = 0;
  for (const auto& [a, b, c] : triangles)
    running.push_back(area += 0.5 * (b - a).cross(c - a).norm());
  Points points(kPoints, 3);
  Rng rng(0, "diversity");
  for (int i = 0; i < kPoints; ++i) {
    const double at = (i + 0.5) / kPoints * area;
    const auto index = static_cast<std::size_t>(
        std::upper_bound(running.begin(), running.end() - 1, at) - running.begin());
    const auto& [a, b, c] = triangles[index];
    double u = rng.Uniform();
    double v = rng.Uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    points.row(i) = (a + u * (b - a) + v * (c - a)).transpose();
  }
  return points;
}

Shape ShapeOf(const Part& part) {
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  Eigen::AlignedBox3d box;
  for (const PartPiece& piece : part.pieces) {
    for (const Eigen::Vector3i& t : piece.mesh.triangles) {
      auto& corners = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const int vertex = t[static_cast<Eigen::Index>(k)];
        corners[k] = piece.mesh.vertices[static_cast<std::size_t>(vertex)];
        box.extend(corners[k]);
      }
    }
  }
  Shape shape{part.id, SampledSurface(triangles), nullptr};
  const Eigen::RowVector3d center = box.center().transpose();
  shape.points = (shape.points.rowwise() - center) / box.diagonal().norm();
  return shape;
}

double MeanDistance(const Points& from, const Tree& to) {
  double sum = 0;
  for (Eigen::Index i = 0; i < from.rows(); ++i) {
    const std::array<double, 3> point = {from(i, 0), from(i, 1), from(i, 2)};
    Eigen::Index index = 0;
    double squared = 0;
    to.index->knnSearch(point.data(), 1, &index, &squared);
    sum += std::sqrt(squared);
  }
  return sum / static_cast<double>(from.rows());
}

double Chamfer(const Shape& a, const Shape& b) {
  return 0.5 * (MeanDistance(a.points, *b.tree) + MeanDistance(b.points, *a.tree));
}

struct Neighbour {
  double distance = 1e300;
  std::size_t index = 0;
};

std::vector<Neighbour> NearestNeighbours(const std::vector<Shape>& shapes) {
  std::vector<std::vector<double>> rows(shapes.size());
  ParallelFor(shapes.size(), 0, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) rows[i].push_back(Chamfer(shapes[i], shapes[j]));
  });
  std::vector<Neighbour> nearest(shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (rows[i][j] < nearest[i].distance) nearest[i] = {rows[i][j], j};
      if (rows[i][j] < nearest[j].distance) nearest[j] = {rows[i][j], i};
    }
  }
  return nearest;
}

void ReadShapes(const std::string& label, const fs::path& folder, Shapes& shapes) {
  Require(fs::is_directory(folder), ErrorCode::kMissing, folder.string() + ": no such folder");
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == "part.json") parts.push_back(entry.path().parent_path());
  }
  std::sort(parts.begin(), parts.end());
  std::set<std::string> sources;
  for (const fs::path& path : parts) {
    const Part part = ReadPart(path);
    if (!sources.insert(part.source_sha256).second) continue;
    shapes[{label, std::string(NameOf(part.category)), std::string(NameOf(part.role))}].push_back(
        ShapeOf(part));
  }
}

double Quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

int Run(int argc, char** argv) {
  Shapes shapes;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    Require(equals != std::string::npos, ErrorCode::kInvalidArgument,
            "usage: diversity LABEL=FOLDER...");
    ReadShapes(argument.substr(0, equals), argument.substr(equals + 1), shapes);
  }
  Require(!shapes.empty(), ErrorCode::kInvalidArgument, "usage: diversity LABEL=FOLDER...");
  std::printf(
      "Chamfer distance to the nearest neighbour, 1/1000 of the diagonal\n%-12s %-17s %-7s "
      "%6s %7s %7s %7s %7s %7s  closest pair\n",
      "collection", "category", "role", "parts", "least", "25 %", "median", "75 %", "most");
  for (auto& [key, group] : shapes) {
    const auto& [label, category, role] = key;
    if (group.size() < 2) continue;
    for (Shape& shape : group) shape.tree = std::make_unique<Tree>(3, std::cref(shape.points));
    const std::vector<Neighbour> nearest = NearestNeighbours(group);
    std::vector<double> sorted;
    for (const Neighbour& neighbour : nearest) sorted.push_back(1000 * neighbour.distance);
    const auto closest =
        static_cast<std::size_t>(std::min_element(sorted.begin(), sorted.end()) - sorted.begin());
    std::sort(sorted.begin(), sorted.end());
    std::printf("%-12s %-17s %-7s %6zu %7.2f %7.2f %7.2f %7.2f %7.2f  %s %s\n", label.c_str(),
                category.c_str(), role.c_str(), group.size(), sorted.front(),
                Quantile(sorted, 0.25), Quantile(sorted, 0.5), Quantile(sorted, 0.75),
                sorted.back(), group[closest].id.c_str(), group[nearest[closest].index].id.c_str());
  }
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
