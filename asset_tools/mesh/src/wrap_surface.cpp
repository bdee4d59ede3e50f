// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <CGAL/alpha_wrap_3.h>

#include "surface_mesh.h"
#include "surface_operations.h"

namespace doorforge {

TriangleMesh AlphaWrap(const TriangleMesh& soup, double alpha_m, double offset_m) {
  SurfaceMesh wrap;
  CGAL::alpha_wrap_3(PointsOf(soup), PolygonsOf(soup), alpha_m, offset_m, wrap);
  wrap.collect_garbage();
  return TrianglesOf(wrap);
}

}  // namespace doorforge
