// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/solid_shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "doorforge/core/closed_mesh.h"

namespace doorforge {
namespace {

constexpr double kSameAngle = 1e-3;  // rad: triangles of one plane, as files round it

// A side of a triangle, from its corner `corner` to the next.
struct Side {
  std::size_t triangle;
  int corner;
  bool ends_matter = false;  // where one goes around the edge by growing angles
  double angle = 0;
};

class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t Find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(std::size_t a, std::size_t b) {
    a = Find(a);
    b = Find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

std::array<int, 3> Corners(const Eigen::Vector3i& t) {
  std::array<int, 3> corners{t[0], t[1], t[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

bool HasRepeatedCorner(const Eigen::Vector3i& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

Eigen::Vector3i FromSmallest(const Eigen::Vector3i& t) {
  const int first = t[0] < t[1] && t[0] < t[2] ? 0 : (t[1] < t[2] ? 1 : 2);
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

class Separator {
 public:
  explicit Separator(const TriangleMesh& soup)
      : soup_(soup),
        distinct_(Distinct(soup)),
        triangles_(distinct_.size()),
        corners_(3 * distinct_.size()),
        open_(distinct_.size()) {}

  SolidShells Run(double thinnest_m) {
    PairSides();
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < distinct_.size(); ++i) members[triangles_.Find(i)].push_back(i);
    std::map<std::size_t, TriangleMesh> shells;
    for (const auto& [first, triangles] : members) {
      if (std::any_of(triangles.begin(), triangles.end(), [&](auto i) { return open_[i]; }))
        continue;
      TriangleMesh shell = ShellOf(triangles);
      const MeshTopology topology = MeasureTopology(shell);
      if (2 * topology.volume_m3 > thinnest_m * topology.area_m2 && ClosedMesh::From(shell))
        shells.emplace(first, std::move(shell));
    }
    DropThoseThatStandAlone(shells);
    return Apart(std::move(shells), members);
  }

 private:
  // Those with three corners, of repeats with the same winding the first.
  static std::vector<std::size_t> Distinct(const TriangleMesh& soup) {
    std::set<std::array<int, 3>> seen;
    std::vector<std::size_t> distinct;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
      const Eigen::Vector3i t = FromSmallest(soup.triangles[i]);
      if (!HasRepeatedCorner(t) && seen.insert({t[0], t[1], t[2]}).second) distinct.push_back(i);
    }
    return distinct;
  }

  const Eigen::Vector3i& Triangle(std::size_t i) const { return soup_.triangles[distinct_[i]]; }
  int Corner(std::size_t i, int corner) const { return Triangle(i)[corner % 3]; }
  const Eigen::Vector3d& Position(int index) const {
    return soup_.vertices[static_cast<std::size_t>(index)];
  }

  void PairSides() {
    std::map<std::pair<int, int>, std::vector<Side>> edges;
    for (std::size_t i = 0; i < distinct_.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int from = Corner(i, k);
        const int to = Corner(i, k + 1);
        edges[std::minmax(from, to)].push_back({i, k, from < to});
      }
    }
    for (auto& [edge, sides] : edges) {
      if (sides.size() > 2) Sort(sides, edge);
      Match(sides);
      if (sides.size() > 2) shared_.push_back(std::move(sides));
    }
  }

  // Those that have no edge in common with another.
  void DropThoseThatStandAlone(std::map<std::size_t, TriangleMesh>& shells) {
    std::set<std::size_t> have_neighbours;
    for (const std::vector<Side>& sides : shared_) {
      std::set<std::size_t> here;
      for (const Side& side : sides) {
        const std::size_t shell = triangles_.Find(side.triangle);
        if (shells.contains(shell)) here.insert(shell);
      }
      if (here.size() > 1) have_neighbours.insert(here.begin(), here.end());
    }
    std::erase_if(shells,
                  [&](const auto& shell) { return !have_neighbours.contains(shell.first); });
  }

  SolidShells Apart(std::map<std::size_t, TriangleMesh> shells,
                    const std::map<std::size_t, std::vector<std::size_t>>& members) const {
    SolidShells apart;
    std::set<std::array<int, 3>> in_shells;
    std::set<int> known;  // vertices of shells
    for (auto& [first, shell] : shells) {
      apart.split_vertices += static_cast<int>(shell.vertices.size());
      apart.shells.push_back(std::move(shell));
      for (const std::size_t i : members.at(first)) {
        in_shells.insert(Corners(Triangle(i)));
        for (const int corner : Triangle(i)) known.insert(corner);
      }
    }
    apart.split_vertices -= static_cast<int>(known.size());
    apart.rest.vertices = soup_.vertices;
    for (const Eigen::Vector3i& t : soup_.triangles) {
      if (!in_shells.contains(Corners(t))) apart.rest.triangles.push_back(t);
    }
    return apart;
  }

  // By angle around the edge; in one plane what ends matter comes before what begins it.
  void Sort(std::vector<Side>& sides, const std::pair<int, int>& edge) const {
    const Eigen::Vector3d& from = Position(edge.first);
    const Eigen::Vector3d axis = (Position(edge.second) - from).normalized();
    const Eigen::Vector3d x = axis.unitOrthogonal();
    const Eigen::Vector3d y = axis.cross(x);
    for (Side& side : sides) {
      const Eigen::Vector3d out = Position(Corner(side.triangle, side.corner + 2)) - from;
      side.angle = std::atan2(out.dot(y), out.dot(x));
    }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const Side& a, const Side& b) { return a.angle < b.angle; });
    StartAtTheWidestGap(sides);
    for (auto begin = sides.begin(); begin != sides.end();) {
      auto end = begin + 1;
      while (end != sides.end() && end->angle - (end - 1)->angle < kSameAngle) ++end;
      std::stable_partition(begin, end, [](const Side& side) { return side.ends_matter; });
      begin = end;
    }
  }

  static void StartAtTheWidestGap(std::vector<Side>& sides) {
    constexpr double kTurn = 2 * std::numbers::pi;
    std::size_t first = 0;
    double widest = sides.front().angle + kTurn - sides.back().angle;
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const double gap = sides[i].angle - sides[i - 1].angle;
      if (gap > widest) {
        widest = gap;
        first = i;
      }
    }
    for (std::size_t i = 0; i < first; ++i) sides[i].angle += kTurn;
    std::rotate(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(first), sides.end());
  }

  // What begins matter and what ends it, as brackets on a circle.
  void Match(const std::vector<Side>& sides) {
    std::vector<std::size_t> begun;
    std::vector<char> is_matched(sides.size(), 0);
    for (int turn = 0; turn < 2; ++turn) {
      for (std::size_t i = 0; i < sides.size(); ++i) {
        if (is_matched[i]) continue;
        if (!sides[i].ends_matter) {
          if (turn == 0) begun.push_back(i);
        } else if (!begun.empty()) {
          Join(sides[i], sides[begun.back()]);
          is_matched[i] = is_matched[begun.back()] = 1;
          begun.pop_back();
        }
      }
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (!is_matched[i]) open_[sides[i].triangle] = true;
    }
  }

  void Join(const Side& a, const Side& b) {
    const auto corner = [](const Side& side, int next) {
      return 3 * side.triangle + static_cast<std::size_t>((side.corner + next) % 3);
    };
    triangles_.Join(a.triangle, b.triangle);
    corners_.Join(corner(a, 0), corner(b, 1));
    corners_.Join(corner(a, 1), corner(b, 0));
  }

  // With a copy of a vertex for each fan of triangles around it.
  TriangleMesh ShellOf(const std::vector<std::size_t>& triangles) {
    TriangleMesh shell;
    std::map<std::size_t, int> index_of;
    for (const std::size_t i : triangles) {
      Eigen::Vector3i& t = shell.triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const std::size_t fan = corners_.Find(3 * i + static_cast<std::size_t>(k));
        const auto [entry, is_new] =
            index_of.try_emplace(fan, static_cast<int>(shell.vertices.size()));
        if (is_new) shell.vertices.push_back(Position(Corner(i, k)));
        t[k] = entry->second;
      }
    }
    return shell;
  }

  const TriangleMesh& soup_;
  std::vector<std::size_t> distinct_;
  Sets triangles_;
  Sets corners_;                           // of the same fan
  std::vector<bool> open_;                 // at a side at least
  std::vector<std::vector<Side>> shared_;  // of edges of more than two triangles
};

}  // namespace

SolidShells SolidShellsOf(const TriangleMesh& soup, double thinnest_m) {
  return Separator(soup).Run(thinnest_m);
}

}  // namespace doorforge
