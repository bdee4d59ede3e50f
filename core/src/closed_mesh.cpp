// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// Disjoint sets with path halving; the smaller root wins, so that results follow from the input
// order alone.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t Root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void Join(std::size_t a, std::size_t b) {
    a = Root(a);
    b = Root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

// One side of a triangle, named by its undirected edge.
struct Side {
  std::array<int, 2> edge;  // ascending
  int triangle;
  int corner;  // the side runs from this corner to the next
  bool ascending;
};

bool RepeatsIndex(const Eigen::Vector3i& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

void CheckIndices(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite())
      throw Error(ErrorCode::kInvalidArgument,
                  "vertex " + std::to_string(i) + " of the mesh is not finite");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    if (t.minCoeff() < 0 || t.maxCoeff() >= count)
      throw Error(ErrorCode::kInvalidArgument,
                  "triangle " + std::to_string(i) + " of the mesh names vertex " +
                      std::to_string(t.minCoeff() < 0 ? t.minCoeff() : t.maxCoeff()) +
                      ", allowed 0.." + std::to_string(count - 1));
  }
}

std::vector<Side> SortedSides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(mesh.triangles.size() * 3);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    if (RepeatsIndex(t)) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(i), k, a < b});
    }
  }
  const auto edge_of = [](const Side& side) {
    return static_cast<std::uint64_t>(side.edge[0]) << 32 |
           static_cast<std::uint32_t>(side.edge[1]);
  };
  std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) {
    const std::uint64_t edge_a = edge_of(a);
    const std::uint64_t edge_b = edge_of(b);
    return edge_a != edge_b ? edge_a < edge_b : a.triangle < b.triangle;
  });
  return sides;
}

// Calls visit(sides of one edge) for each edge.
template <class Visit>
void ForEachEdge(const std::vector<Side>& sides, const Visit& visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    visit(std::span(sides).subspan(begin, end - begin));
    begin = end;
  }
}

void CountEdges(const std::vector<Side>& sides, MeshTopology& topology) {
  ForEachEdge(sides, [&](std::span<const Side> around) {
    if (around.size() == 1) ++topology.boundary_edges;
    if (around.size() > 2) ++topology.non_manifold_edges;
    if (around.size() == 2 && around[0].ascending == around[1].ascending)
      ++topology.inconsistent_edges;
  });
}

int CountComponents(const TriangleMesh& mesh, const std::vector<Side>& sides) {
  DisjointSets sets(mesh.triangles.size());
  ForEachEdge(sides, [&](std::span<const Side> around) {
    for (const Side& side : around)
      sets.Join(static_cast<std::size_t>(around[0].triangle),
                static_cast<std::size_t>(side.triangle));
  });
  int components = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    components += sets.Root(i) == i && !RepeatsIndex(mesh.triangles[i]);
  return components;
}

// Corner of `side`'s triangle at `vertex`, as an index into all corners.
std::size_t CornerAt(const Side& side, int vertex) {
  const int at_start = side.ascending ? side.edge[0] : side.edge[1];
  const int corner = vertex == at_start ? side.corner : (side.corner + 1) % 3;
  return static_cast<std::size_t>(side.triangle) * 3 + static_cast<std::size_t>(corner);
}

int CountPinchedVertices(const TriangleMesh& mesh, const std::vector<Side>& sides) {
  DisjointSets fans(mesh.triangles.size() * 3);
  ForEachEdge(sides, [&](std::span<const Side> around) {
    for (const Side& side : around) {
      for (const int vertex : side.edge)
        fans.Join(CornerAt(around[0], vertex), CornerAt(side, vertex));
    }
  });
  std::vector<int> fans_at(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size() * 3; ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i / 3];
    if (fans.Root(i) == i && !RepeatsIndex(t)) ++fans_at[static_cast<std::size_t>(t[i % 3])];
  }
  return static_cast<int>(
      std::count_if(fans_at.begin(), fans_at.end(), [](int fans_here) { return fans_here > 1; }));
}

void MeasureTriangles(const TriangleMesh& mesh, MeshTopology& topology) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int index : t)
      topology.bounds.extend(mesh.vertices[static_cast<std::size_t>(index)]);
  }
  if (mesh.triangles.empty()) return;
  // tetrahedra against the centre of the bounds: a mesh far from the origin keeps its digits
  const Eigen::Vector3d center = topology.bounds.center();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(t[0])] - center;
    const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(t[1])] - center;
    const Eigen::Vector3d c = mesh.vertices[static_cast<std::size_t>(t[2])] - center;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    topology.degenerate_triangles += RepeatsIndex(t) || area == 0;
    topology.area_m2 += area;
    topology.volume_m3 += a.dot(b.cross(c)) / 6;
  }
}

}  // namespace

MeshTopology MeasureTopology(const TriangleMesh& mesh) {
  CheckIndices(mesh);
  const std::vector<Side> sides = SortedSides(mesh);
  MeshTopology topology;
  CountEdges(sides, topology);
  topology.components = CountComponents(mesh, sides);
  topology.non_manifold_vertices = CountPinchedVertices(mesh, sides);
  MeasureTriangles(mesh, topology);
  return topology;
}

std::optional<ClosedMesh> ClosedMesh::From(TriangleMesh mesh) {
  const MeshTopology topology = MeasureTopology(mesh);
  const bool closed = topology.boundary_edges == 0 && topology.non_manifold_edges == 0 &&
                      topology.inconsistent_edges == 0 && topology.volume_m3 > 0 &&
                      std::none_of(mesh.triangles.begin(), mesh.triangles.end(), RepeatsIndex);
  if (!closed) return std::nullopt;
  return ClosedMesh(std::move(mesh));
}

}  // namespace doorforge
