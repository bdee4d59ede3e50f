// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

constexpr float kFar = 1e20F;  // squared cells; finite, so that differences stay numbers

// Lower envelope of parabolas along one line: Felzenszwalb and Huttenlocher, "Distance Transforms
// of Sampled Functions" (2012).
class LineTransform {
 public:
  explicit LineTransform(int longest)
      : value_(static_cast<std::size_t>(longest)),
        apex_(static_cast<std::size_t>(longest)),
        border_(static_cast<std::size_t>(longest) + 1) {}

  void Apply(float* first, std::size_t stride, int count) {
    for (int i = 0; i < count; ++i)
      value_[static_cast<std::size_t>(i)] = first[stride * static_cast<std::size_t>(i)];
    int last = 0;
    apex_[0] = 0;
    border_[0] = -std::numeric_limits<double>::infinity();
    border_[1] = std::numeric_limits<double>::infinity();
    for (int q = 1; q < count; ++q) {
      double meeting = Meeting(q, apex_[static_cast<std::size_t>(last)]);
      while (meeting <= border_[static_cast<std::size_t>(last)])
        meeting = Meeting(q, apex_[static_cast<std::size_t>(--last)]);
      ++last;
      apex_[static_cast<std::size_t>(last)] = q;
      border_[static_cast<std::size_t>(last)] = meeting;
      border_[static_cast<std::size_t>(last) + 1] = std::numeric_limits<double>::infinity();
    }
    int at = 0;
    for (int q = 0; q < count; ++q) {
      while (border_[static_cast<std::size_t>(at) + 1] < q) ++at;
      const int apex = apex_[static_cast<std::size_t>(at)];
      const auto offset = static_cast<float>(q - apex);
      first[stride * static_cast<std::size_t>(q)] =
          std::min(kFar, offset * offset + value_[static_cast<std::size_t>(apex)]);
    }
  }

 private:
  double Meeting(int q, int p) const {
    const double fq = value_[static_cast<std::size_t>(q)];
    const double fp = value_[static_cast<std::size_t>(p)];
    return ((fq + static_cast<double>(q) * q) - (fp + static_cast<double>(p) * p)) /
           (2.0 * (q - p));
  }

  std::vector<float> value_;
  std::vector<int> apex_;
  std::vector<double> border_;
};

}  // namespace

DistanceGrid::DistanceGrid(const ClosedMesh& mesh, double cell_m)
    : grid_(GridOver(mesh.mesh(), cell_m, 0)), distance_m_(grid_.count(), kFar) {
  MarkInside(mesh.mesh());
  MarkSurface(mesh.mesh());
  SpreadDistances();
}

void DistanceGrid::MarkInside(const TriangleMesh& mesh) {
  const auto rows = RowCrossings(mesh, grid_);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int j = static_cast<int>(r) % grid_.size.y();
    const int k = static_cast<int>(r) / grid_.size.y();
    int winding = 0;
    std::size_t next = 0;
    for (int i = 0; i < grid_.size.x(); ++i) {
      const double x = grid_.CenterOf(i, j, k).x();
      for (; next < rows[r].size() && rows[r][next].x_m <= x; ++next)
        winding += rows[r][next].winding;
      if (winding > 0) distance_m_[grid_.IndexOf(i, j, k)] = 0;
    }
  }
}

// Cells that the surface passes through count as well, or a sheet thinner than a cell would vanish.
void DistanceGrid::MarkSurface(const TriangleMesh& mesh) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a;
    const Eigen::Vector3d ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int steps = 1 + static_cast<int>(longest / (0.5 * grid_.cell_m));
    for (int u = 0; u <= steps; ++u) {
      CheckWork(static_cast<unsigned>(steps - u + 1));
      for (int v = 0; u + v <= steps; ++v) {
        const Eigen::Vector3i index = grid_.CellAt(a + ab * u / steps + ac * v / steps);
        distance_m_[grid_.IndexOf(index.x(), index.y(), index.z())] = 0;
      }
    }
  }
}

void DistanceGrid::SpreadDistances() {
  LineTransform line(grid_.size.maxCoeff());
  const auto nx = static_cast<std::size_t>(grid_.size.x());
  const auto ny = static_cast<std::size_t>(grid_.size.y());
  float* first = distance_m_.data();
  for (int k = 0; k < grid_.size.z(); ++k) {
    CheckWork(static_cast<unsigned>(nx * ny));
    for (int j = 0; j < grid_.size.y(); ++j)
      line.Apply(first + grid_.IndexOf(0, j, k), 1, grid_.size.x());
    for (int i = 0; i < grid_.size.x(); ++i)
      line.Apply(first + grid_.IndexOf(i, 0, k), nx, grid_.size.y());
  }
  for (int j = 0; j < grid_.size.y(); ++j) {
    for (int i = 0; i < grid_.size.x(); ++i)
      line.Apply(first + grid_.IndexOf(i, j, 0), nx * ny, grid_.size.z());
  }
  const auto cell = static_cast<float>(grid_.cell_m);
  for (float& distance : distance_m_) distance = cell * std::sqrt(distance);
  for (auto row = distance_m_.begin(); row != distance_m_.end(); row += grid_.size.x())
    row_largest_m_.push_back(*std::max_element(row, row + grid_.size.x()));
}

}  // namespace doorforge
