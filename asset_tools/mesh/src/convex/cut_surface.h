// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace doorforge {

/// A plane across one axis.
struct AxisCut {
  int axis = 0;
  double position_m = 0;
};

/// A side of a cut: below it for sign -1, above for +1.
struct CutSide {
  AxisCut cut;
  int sign = -1;

  double ReachInto(const Eigen::Vector3d& point) const {
    return sign * (point[cut.axis] - cut.position_m);
  }
};

/// A piece of a solid's surface as polygons, and points of the solid that were noted for it, which
/// can be cut by planes across the axes.
class CutSurface {
 public:
  /// What lies on one side, as far as it decides between cuts.
  struct SideContent {
    std::vector<Eigen::Vector3d> points;  ///< Their hull is that of the side.
    double area_m2 = 0;
  };
  /// Whether a noted point that lies on the cut belongs to the side.
  using IsNotedFor = std::function<bool(const Eigen::Vector3d&)>;

  /// `wall_m` says how far the solid reaches behind the polygon.
  void AddPolygon(std::span<const Eigen::Vector3d> corners, double wall_m);
  void AddNotedPoint(const Eigen::Vector3d& point);
  void Append(const CutSurface& other);
  /// Points that are equal become one. Call it once a surface is complete.
  void Weld();

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  bool HasPolygons() const { return !polygons_.empty(); }

  /// What only ends the other side is left out: polygons that reach no more than `skin_m` into this
  /// side, less than the wall behind them reaches into the other, and that are no face of a solid
  /// on this side. Kept here, the ends of opposite walls would span the air between them; a thin
  /// wall that is cut along its middle must keep both its faces.
  CutSurface Side(const CutSide& side, double skin_m, const IsNotedFor& is_noted_for) const;
  /// It finds what Side() makes, without making it; `content` is emptied first.
  void FindSide(const CutSide& side, double skin_m, const IsNotedFor& is_noted_for,
                SideContent& content) const;

  /// Without the polygons of which `is_held` says so of all corners; the same number of polygons
  /// where there are none.
  CutSurface Without(const std::function<bool(std::span<const Eigen::Vector3d>)>& is_held) const;
  std::size_t PolygonCount() const { return polygons_.size(); }

  /// A plane across the axis in which much of the surface lies.
  struct Face {
    double position_m = 0;
    double area_m2 = 0;
  };
  /// The largest, at most `most`, by falling area. Faces within `bin_m` of each other that look the
  /// same way count as one, since a wrap's faces are only nearly flat.
  std::vector<Face> FacesAcross(int axis, double bin_m, std::size_t most) const;

 private:
  struct Polygon {
    std::size_t first = 0;  // of its corners
    std::size_t count = 0;
    double wall_m = 0;
    Eigen::Vector3d doubled_area = Eigen::Vector3d::Zero();  // along the normal
    double area_m2 = 0;
    Eigen::AlignedBox3d box;
  };

  const Eigen::Vector3d& Corner(const Polygon& polygon, std::size_t i) const {
    return points_[static_cast<std::size_t>(corners_[polygon.first + i])];
  }
  bool IsSkinOfOtherSide(const Polygon& polygon, const CutSide& side, double skin_m) const;
  /// Sutherland and Hodgman (1974).
  void Clip(const Polygon& polygon, const CutSide& side,
            std::vector<Eigen::Vector3d>& clipped) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<int> corners_;  // of all polygons; they index points_
  std::vector<Polygon> polygons_;
  std::vector<int> noted_;  // the same
};

}  // namespace doorforge
