// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <CGAL/alpha_wrap_3.h>

#include "doorforge/mesh/work_budget.h"

#include "surface_mesh.h"
#include "surface_operations.h"

namespace doorforge {
namespace {

namespace wraps = CGAL::Alpha_wraps_3::internal;

// What a wrap asks of its input, as CGAL's own function asks it; between two questions a wrap that
// takes too long can be given up. CGAL 5.5 offers no other place for that.
class SoupWithinBudget : public wraps::Triangle_soup_oracle<Kernel> {
 public:
  using Base = wraps::Triangle_soup_oracle<Kernel>;
  using Point_3 = Geom_traits::Point_3;
  using Base::Base;

  template <class Shape>
  bool do_intersect(const Shape& shape) const {
    CheckWork(kSteps);
    return Base::do_intersect(shape);
  }
  Point_3 closest_point(const Point_3& point) const {
    CheckWork(kSteps);
    return Base::closest_point(point);
  }
  bool first_intersection(const Point_3& from, const Point_3& to, Point_3& at,
                          const Geom_traits::FT offset) const {
    CheckWork(kSteps);
    return Base::first_intersection(from, to, at, offset);
  }

 private:
  static constexpr unsigned kSteps = 1000;
};

}  // namespace

TriangleMesh AlphaWrap(const TriangleMesh& soup, double alpha_m, double offset_m) {
  SurfaceMesh wrap;
  SoupWithinBudget oracle(alpha_m, Kernel());
  oracle.add_triangle_soup(PointsOf(soup), PolygonsOf(soup));
  wraps::Alpha_wrap_3<SoupWithinBudget> builder(oracle);
  builder(alpha_m, offset_m, wrap);
  wrap.collect_garbage();
  return TrianglesOf(wrap);
}

}  // namespace doorforge
