// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How different the parts of a collection are: for each part the Chamfer distance to its nearest
// neighbour of the same collection, category and role.
//
//   diversity LABEL=FOLDER...     folders of parts, as `doorforge catalog build` and `import` write
//
// Parts are centred on their bounding box and scaled to a diagonal of 1; the distance is the mean,
// over both directions, of the distance from 4,096 points spread evenly over one surface to the
// nearest of the other's. Parts made from the same source count once, and so do parts whose
// normalised surfaces lie within 1e-3 of each other: the same thing at another size. A body whose
// frame or shell is missing is not compared with whole ones; of cars, whose released objects mostly
// lack the shell, the leaves are compared too.
//
// The nearest neighbour is the nearer the more parts there are. The second table therefore draws
// 500 random subsets of the larger collection, as many parts as the smaller has, and gives the
// median over them of their medians.

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/rng.h"

#include "part_shapes.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr double kSameSurface = 1e-3;
constexpr double kMayBeSame = 0.02;  // two samples of one surface are never farther apart
constexpr int kSubsets = 500;

using Matrix = std::vector<std::vector<double>>;  // symmetric

struct Group {
  std::vector<PartShape> shapes;
  Matrix distances;
  std::size_t copies = 0;  ///< Left out.
};
// "category role" -> collection
using Groups = std::map<std::string, std::map<std::string, Group>>;

Matrix Distances(const std::vector<PartShape>& shapes) {
  Matrix rows(shapes.size(), std::vector<double>(shapes.size(), 1e300));
  ParallelFor(shapes.size(), 0, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) rows[i][j] = 1000 * Chamfer(shapes[i], shapes[j]);
  });
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) rows[j][i] = rows[i][j];
  }
  return rows;
}

// Without the parts that repeat an earlier one at another size.
void DropCopies(Group& group) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < group.shapes.size(); ++i) {
    const bool copy = std::any_of(kept.begin(), kept.end(), [&](std::size_t j) {
      return group.distances[i][j] <= 1000 * kMayBeSame &&
             SameSurface(group.shapes[i], group.shapes[j], kSameSurface);
    });
    if (!copy) kept.push_back(i);
  }
  group.copies += group.shapes.size() - kept.size();
  Group unique;
  for (const std::size_t i : kept) {
    unique.shapes.push_back(std::move(group.shapes[i]));
    std::vector<double>& row = unique.distances.emplace_back();
    for (const std::size_t j : kept) row.push_back(group.distances[i][j]);
  }
  unique.copies = group.copies;
  group = std::move(unique);
}

void ReadShapes(const std::string& label, const fs::path& folder, Groups& groups) {
  std::set<std::string> sources;
  for (const fs::path& path : PartFolders(folder)) {
    const Part part = ReadPart(path);
    const std::string category(NameOf(part.category));
    const bool body = part.role == PartRole::kBody;
    Group& group = groups[category + (body ? " body" : " handle")][label];
    if (!sources.insert(part.source_sha256).second) {
      ++group.copies;
      continue;
    }
    if (!body || FindPiece(part, "frame") != nullptr) group.shapes.push_back(ShapeOf(part, ""));
    if (body && part.category == Category::kCar)
      groups[category + " leaf"][label].shapes.push_back(ShapeOf(part, "leaf"));
  }
}

double Quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

std::vector<double> NearestOf(const Matrix& distances, const std::vector<std::size_t>& chosen) {
  std::vector<double> nearest;
  for (const std::size_t i : chosen) {
    double least = 1e300;
    for (const std::size_t j : chosen) {
      if (i != j) least = std::min(least, distances[i][j]);
    }
    nearest.push_back(least);
  }
  std::sort(nearest.begin(), nearest.end());
  return nearest;
}

std::vector<std::size_t> AllOf(const Group& group) {
  std::vector<std::size_t> all(group.shapes.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

double MedianAtNumber(const Group& group, std::size_t number) {
  Rng rng(0, "diversity subsets");
  std::vector<double> medians;
  for (int k = 0; k < kSubsets; ++k) {
    std::vector<std::size_t> order = AllOf(group);
    for (std::size_t i = 0; i < number; ++i) {
      const auto rest = static_cast<double>(order.size() - i);
      std::swap(order[i], order[i + static_cast<std::size_t>(rng.Uniform() * rest)]);
    }
    order.resize(number);
    medians.push_back(Quantile(NearestOf(group.distances, order), 0.5));
  }
  std::sort(medians.begin(), medians.end());
  return Quantile(medians, 0.5);
}

void PrintAll(const Groups& groups) {
  std::printf(
      "Chamfer distance to the nearest neighbour, 1/1000 of the diagonal\n%-24s %-10s %5s %6s %7s "
      "%7s %7s %7s %7s  closest pair\n",
      "category, role", "collection", "parts", "copies", "least", "25 %", "median", "75 %", "most");
  for (const auto& [kind, collections] : groups) {
    for (const auto& [label, group] : collections) {
      std::printf("%-24s %-10s %5zu %6zu", kind.c_str(), label.c_str(), group.shapes.size(),
                  group.copies);
      if (group.shapes.size() > 1) {
        const std::vector<double> nearest = NearestOf(group.distances, AllOf(group));
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
          std::printf(" %7.2f", Quantile(nearest, share));
        for (std::size_t i = 0; i < group.shapes.size(); ++i) {
          const auto& row = group.distances[i];
          const auto least = std::min_element(row.begin(), row.end());
          if (*least > nearest.front()) continue;
          std::printf("  %s %s", group.shapes[i].id.c_str(),
                      group.shapes[static_cast<std::size_t>(least - row.begin())].id.c_str());
          break;
        }
      }
      std::printf("\n");
    }
  }
}

void PrintAtEqualNumber(const Groups& groups) {
  std::printf("\nthe medians of both at the number of parts of the smaller collection\n");
  for (const auto& [kind, collections] : groups) {
    for (const auto& [small, few] : collections) {
      for (const auto& [large, many] : collections) {
        const std::size_t number = few.shapes.size();
        const bool order =
            many.shapes.size() > number || (many.shapes.size() == number && large < small);
        if (large == small || number < 2 || !order) continue;
        std::printf("%-24s %4zu parts: %s %.2f, %s %.2f\n", kind.c_str(), number, large.c_str(),
                    MedianAtNumber(many, number), small.c_str(),
                    Quantile(NearestOf(few.distances, AllOf(few)), 0.5));
      }
    }
  }
}

int Run(int argc, char** argv) {
  const char* usage = "usage: diversity LABEL=FOLDER...";
  Groups groups;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    Require(equals != std::string::npos, ErrorCode::kInvalidArgument, usage);
    ReadShapes(argument.substr(0, equals), argument.substr(equals + 1), groups);
  }
  Require(!groups.empty(), ErrorCode::kInvalidArgument, usage);
  for (auto& [kind, collections] : groups) {
    for (auto& [label, group] : collections) {
      for (PartShape& shape : group.shapes) BuildTree(shape);
      group.distances = Distances(group.shapes);
      DropCopies(group);
    }
  }
  PrintAll(groups);
  PrintAtEqualNumber(groups);
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
