// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Triangulation_cell_base_3.h>

#include "repair/surface_mesh.h"

// A hole is filled with the best triangles of a Delaunay triangulation of its border, of equally
// good ones with those that are met first. CGAL goes around an edge from the cell that comes first,
// by the cells' addresses. So holes have a kernel of their own, whose cells are numbered as they
// are made: what fills a hole does not depend on where memory lies.

namespace doorforge {

struct HoleKernel : Kernel {};

}  // namespace doorforge

namespace CGAL {

/// Cells with numbers, by which CGAL's containers compare them where there are any.
template <class Base>
class Delaunay_triangulation_cell_base_3<doorforge::HoleKernel, Base> : public Base {
 public:
  using Has_timestamp = Tag_true;
  using Geom_traits = doorforge::HoleKernel;
  using Point = Geom_traits::Point_3;
  template <class Triangulation>
  struct Rebind_TDS {
    using Other = Delaunay_triangulation_cell_base_3<
        Geom_traits, typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  using Base::Base;

  std::size_t time_stamp() const { return number_; }
  void set_time_stamp(std::size_t number) { number_ = number; }

 private:
  std::size_t number_ = static_cast<std::size_t>(-1);  // none yet
};

/// Points are located as quickly as with the kernel itself.
template <>
struct Triangulation_structural_filtering_traits<doorforge::HoleKernel>
    : Triangulation_structural_filtering_traits<doorforge::Kernel> {};

}  // namespace CGAL
