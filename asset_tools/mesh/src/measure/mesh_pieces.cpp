// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/mesh_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace doorforge {
namespace {

using Cell = std::array<std::int64_t, 3>;

// Earlier vertices by cell of the welding distance, so that only 27 cells are searched.
class VertexGrid {
 public:
  explicit VertexGrid(double distance_m) : distance_m_(distance_m) {}

  /// The first vertex near `point`, or -1.
  int Near(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& vertices) const {
    const Cell center = CellOf(point);
    int nearest = -1;
    for (int n = 0; n < 27; ++n) {
      const auto entry = vertices_in_.find(
          {center[0] + n % 3 - 1, center[1] + n / 3 % 3 - 1, center[2] + n / 9 - 1});
      if (entry == vertices_in_.end()) continue;
      for (const int index : entry->second) {
        if ((vertices[static_cast<std::size_t>(index)] - point).norm() > distance_m_) continue;
        if (nearest < 0 || index < nearest) nearest = index;
      }
    }
    return nearest;
  }

  void Add(const Eigen::Vector3d& point, int index) {
    vertices_in_[CellOf(point)].push_back(index);
  }

 private:
  Cell CellOf(const Eigen::Vector3d& point) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor(point[axis] / distance_m_));
    return cell;
  }

  double distance_m_;
  std::map<Cell, std::vector<int>> vertices_in_;
};

std::vector<int> TriangleRoots(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) {
      int& up = parent[static_cast<std::size_t>(i)];
      i = up = parent[static_cast<std::size_t>(up)];
    }
    return i;
  };
  std::map<std::pair<int, int>, int> triangle_at;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
      const int other = triangle_at.try_emplace(edge, static_cast<int>(i)).first->second;
      const int a = root(static_cast<int>(i));
      const int b = root(other);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

// Moves the used vertices to the front of a new mesh, in order of use.
class VertexCopier {
 public:
  explicit VertexCopier(const TriangleMesh& from)
      : from_(&from), index_(from.vertices.size(), -1) {}

  void Copy(const Eigen::Vector3i& triangle, TriangleMesh& to) {
    Eigen::Vector3i copy;
    for (int k = 0; k < 3; ++k) {
      int& at = index_[static_cast<std::size_t>(triangle[k])];
      if (at < 0) {
        at = static_cast<int>(to.vertices.size());
        to.vertices.push_back(from_->vertices[static_cast<std::size_t>(triangle[k])]);
        touched_.push_back(triangle[k]);
      }
      copy[k] = at;
    }
    to.triangles.push_back(copy);
  }

  void BeginMesh() {
    for (const int index : touched_) index_[static_cast<std::size_t>(index)] = -1;
    touched_.clear();
  }

 private:
  const TriangleMesh* from_;
  std::vector<int> index_;
  std::vector<int> touched_;
};

}  // namespace

TriangleMesh Welded(const TriangleMesh& mesh, double distance_m) {
  TriangleMesh welded;
  std::vector<int> index(mesh.vertices.size(), -1);
  VertexGrid grid(distance_m);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      int& at = index[static_cast<std::size_t>(t[k])];
      const Eigen::Vector3d& vertex = mesh.vertices[static_cast<std::size_t>(t[k])];
      if (at < 0) at = grid.Near(vertex, welded.vertices);
      if (at < 0) {
        at = static_cast<int>(welded.vertices.size());
        welded.vertices.push_back(vertex);
        grid.Add(vertex, at);
      }
      triangle[k] = at;
    }
    welded.triangles.push_back(triangle);
  }
  return welded;
}

std::vector<TriangleMesh> PiecesOf(const TriangleMesh& mesh) {
  const std::vector<int> roots = TriangleRoots(mesh);
  std::map<int, std::vector<std::size_t>> triangles_of;  // by first triangle, so in its order
  for (std::size_t i = 0; i < roots.size(); ++i) triangles_of[roots[i]].push_back(i);
  std::vector<TriangleMesh> pieces;
  VertexCopier copier(mesh);
  for (const auto& [root, triangles] : triangles_of) {
    TriangleMesh& piece = pieces.emplace_back();
    copier.BeginMesh();
    for (const std::size_t i : triangles) copier.Copy(mesh.triangles[i], piece);
  }
  return pieces;
}

TriangleMesh InVertexOrder(const TriangleMesh& mesh) {
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int i) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(i)];
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::lexicographical_compare(at(a).begin(), at(a).end(), at(b).begin(), at(b).end());
  });
  TriangleMesh renumbered;
  std::vector<int> new_index(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_index[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    renumbered.vertices.push_back(at(order[i]));
  }
  for (const Eigen::Vector3i& t : mesh.triangles)
    renumbered.triangles.emplace_back(
        t.unaryExpr([&](int i) { return new_index[static_cast<std::size_t>(i)]; }));
  return renumbered;
}

TriangleMesh InCanonicalOrder(const TriangleMesh& mesh) {
  TriangleMesh ordered = InVertexOrder(mesh);
  for (Eigen::Vector3i& t : ordered.triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(ordered.triangles.begin(), ordered.triangles.end(),
            [](const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
              return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
            });
  return ordered;
}

TriangleMesh TurnedInsideOut(TriangleMesh mesh) {
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace doorforge
