// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "car/car_shell.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "doorforge/solids/prism.h"

#include "family.h"

namespace doorforge::internal {
namespace {

constexpr double kCarShellGapM = 0.008;            // around the leaf
constexpr double kRearGapM = 0.016;                // its inner corner swings beyond its length
constexpr double kCarShellHullToleranceM = 0.014;  // in the arches of the wheels
constexpr double kArchGapM = 0.05;                 // between wheel and arch
constexpr double kBesideArchM = 0.04;              // body between an arch and what ends there
constexpr double kRoofM = 0.045;                   // thickness of the roof
constexpr double kPillarM = 0.06;

using HeightAlong = std::function<double(double y)>;

class Shell {
 public:
  Shell(CarStyle style, const CarShellShape& shape, const CarLeafShape& leaf)
      : style_(style),
        shape_(shape),
        leaf_(leaf),
        front_(-shape.nose_m),
        tail_(kCarLengthM - shape.nose_m),
        rear_(leaf.length_m + kRearGapM) {}

  Solid Build() {
    AddFront();
    AddRear();
    AddWheels();
    const double floor = leaf_.sill_m - kCarShellGapM;
    AddBox({FarX(0.03), -kCarShellGapM, shape_.clearance_m}, {-0.03, rear_, floor});
    // the far side below its windows
    AddBox({FarX(0.012), -kCarShellGapM, floor + 0.0005},
           {FarX(0.012) + 0.06, rear_, leaf_.belt_m});
    if (style_ == CarStyle::kRoadster)
      AddWindscreen();
    else
      AddRoof();
    return Joined(solids_);
  }

 private:
  // x on the far side at the same depth below the widest line
  double FarX(double depth) const { return -shape_.width_m + depth; }

  void AddBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    solids_.push_back(ChamferedBox(low, high, 0.006));
  }

  double FrontAxle() const {
    const double arch = shape_.wheel_m + kArchGapM + kBesideArchM;
    return std::clamp(front_ + 0.58 * shape_.nose_m, front_ + arch, -kCarShellGapM - arch);
  }
  double RearAxle() const {
    return std::max(rear_ + shape_.wheel_m + kArchGapM + 0.05, tail_ - 0.72);
  }

  // Height of the lower edge, with the arch of a wheel.
  double Underside(double y, double axle) const {
    const double radius = shape_.wheel_m + kArchGapM;
    const double from = std::abs(y - axle);
    if (from >= radius) return shape_.clearance_m;
    return std::max(shape_.clearance_m, shape_.wheel_m + std::sqrt(radius * radius - from * from));
  }

  // The sides draw in towards the car's ends.
  double TaperAt(double y) const {
    const double to_end = std::min(y - front_, tail_ - y);
    const double t = std::clamp(1 - to_end / 0.7, 0.0, 1.0);
    return shape_.nose_taper_m * t * t;
  }

  std::vector<double> LinesWithArch(double low, double high, double axle) const {
    const double radius = shape_.wheel_m + kArchGapM;
    std::vector<double> lines = EqualLines(low, high, 6);
    std::erase_if(lines, [&](double y) { return std::abs(y - axle) < radius + 0.02; });
    for (int i = 0; i <= 6; ++i)
      lines.push_back(axle - radius * std::cos(std::numbers::pi * i / 6));
    std::sort(lines.begin(), lines.end());
    return lines;
  }

  // A solid across the whole car between two heights.
  void AddBlock(std::vector<double> lines, double axle, const HeightAlong& top) {
    PanelGrid grid;
    grid.edge_radius_m = 0.035;
    grid.u_m = EdgeLines(lines, {lines.front(), lines.back()}, grid.edge_radius_m);
    grid.v_m = {0, 0.06, 0.2, 0.4, 0.6, 0.8, 0.94, 1};
    const auto at = [this, axle, top](double y, double v, bool near) {
      const double low = Underside(y, axle);
      const double z = low + v * (std::max(top(y), low + 0.1) - low);
      const double x = SkinX(leaf_, z) - TaperAt(y);
      return Eigen::Vector3d(near ? x : -shape_.width_m - x, y, z);
    };
    grid.front = [at](double y, double v) { return Eigen::Vector3d(at(y, v, true)); };
    grid.back = [at](double y, double v) { return Eigen::Vector3d(at(y, v, false)); };
    solids_.push_back(PanelSolid(grid, kCarShellHullToleranceM));
  }

  void AddFront() {
    const double axle = FrontAxle();
    const double cowl = leaf_.belt_m;
    AddBlock(LinesWithArch(front_, -kCarShellGapM, axle), axle, [this, cowl](double y) {
      const double t = std::clamp((y - front_) / (-kCarShellGapM - front_), 0.0, 1.0);
      return shape_.nose_top_m + (cowl - shape_.nose_top_m) * std::sqrt(t * (2 - t));
    });
  }

  // Where the cabin ends behind, at the belt line.
  double CabinEnd() const {
    switch (style_) {
      case CarStyle::kSedan:
        return rear_ + 0.62 * (tail_ - rear_);
      case CarStyle::kCoupe:
        return rear_ + 0.85 * (tail_ - rear_);
      case CarStyle::kHatch:
        return tail_ - 0.06;
      case CarStyle::kRoadster:
      case CarStyle::kVan:
      case CarStyle::kPickup:
      case CarStyle::kBox:
        break;
    }
    return rear_ + 0.14;
  }

  double DeckHeight(double y) const {
    const double deck = std::min(shape_.tail_top_m, leaf_.belt_m);
    const double end = CabinEnd();
    if (style_ == CarStyle::kHatch || y < end) return leaf_.belt_m;
    const double t = std::clamp((y - end) / (tail_ - end), 0.0, 1.0);
    return leaf_.belt_m + (deck - leaf_.belt_m) * t;
  }

  void AddRear() {
    const double axle = RearAxle();
    const std::vector<double> lines = LinesWithArch(rear_, tail_, axle);
    if (style_ == CarStyle::kPickup) return AddBed(lines, axle);
    if (style_ == CarStyle::kVan) return AddVanRear(lines, axle);
    if (style_ == CarStyle::kBox) return AddCargoBox(lines, axle);
    AddBlock(lines, axle, [this](double y) { return DeckHeight(y); });
  }

  double BedFloor() const { return 2 * shape_.wheel_m + kArchGapM + 0.05; }

  void AddBed(const std::vector<double>& lines, double axle) {
    const double floor = BedFloor();
    AddBlock(lines, axle, [floor](double) { return floor; });
    const double wall = 0.06;
    const double low = floor - 0.0;
    const double high = shape_.tail_top_m;
    const double inset = shape_.nose_taper_m + 0.02;
    const double begin = rear_ + 0.16;
    AddBox({-inset - wall, begin, low + 0.0005}, {-inset, tail_ - wall - 0.002, high});
    AddBox({FarX(inset), begin, low + 0.0005}, {FarX(inset + wall), tail_ - wall - 0.002, high});
    AddBox({FarX(inset), tail_ - wall, low + 0.0005}, {-inset, tail_ - 0.01, high});
    AddCabBack(low);
  }

  // The wall behind the cab, with a window.
  void AddCabBack(double from_z) {
    const double lean = -SkinX(leaf_, leaf_.roof_m);
    AddBox({FarX(0.03), rear_ + 0.03, from_z + 0.0005}, {-0.03, rear_ + 0.1, leaf_.belt_m});
    for (const double x : {-lean - 0.16, FarX(lean + 0.05)})
      AddBox({x, rear_ + 0.03, leaf_.belt_m + 0.0005}, {x + 0.11, rear_ + 0.1, RoofZ() - 0.0005});
  }

  void AddVanRear(const std::vector<double>& lines, double axle) {
    AddBlock(lines, axle, [this](double y) {
      const double t = std::clamp((y - tail_ + 0.25) / 0.25, 0.0, 1.0);
      return RoofZ() + kRoofM - 0.1 * t * t;
    });
  }

  void AddCargoBox(const std::vector<double>& lines, double axle) {
    const double floor = BedFloor();
    AddBlock(lines, axle, [floor](double) { return floor; });
    solids_.push_back(ChamferedBox({FarX(-0.0), rear_ + 0.2, floor + 0.0005},
                                   {0, tail_, shape_.tail_top_m}, 0.02));
    AddCabBack(floor);
  }

  void AddWheels() {
    for (const double axle : {FrontAxle(), RearAxle()}) {
      const double depth = TaperAt(axle) - std::min(0.0, SkinX(leaf_, shape_.wheel_m)) + 0.01;
      for (const double x : {-depth - 0.19, FarX(depth)}) {
        const Polygon tyre = CirclePolygon({axle, shape_.wheel_m}, shape_.wheel_m, 28);
        const Polygon rim = CirclePolygon({axle, shape_.wheel_m}, 0.62 * shape_.wheel_m, 16);
        Solid wheel = ConvexPrism(tyre, PrismAxis::kX, {x, x + 0.19}, 0.0125);
        const bool near = x > -shape_.width_m / 2;
        const double face = near ? x + 0.1902 : x - 0.0082;
        Solid hub = ConvexPrism(rim, PrismAxis::kX, {face, face + 0.008}, 0.003);
        // one shape for both
        wheel.hulls = ConvexPrism(tyre, PrismAxis::kX,
                                  {x - (near ? 0 : 0.0085), x + (near ? 0.1985 : 0.19)}, 0)
                          .hulls;
        hub.hulls.clear();
        solids_.push_back(wheel);
        solids_.push_back(hub);
      }
    }
  }

  double RoofZ() const { return leaf_.roof_m + kCarShellGapM; }
  double RoofBegin() const { return leaf_.front_slope_m - 0.02; }

  double RoofEnd() const {
    const double end = CabinEnd();
    switch (style_) {
      case CarStyle::kSedan:
        return end - 0.38;
      case CarStyle::kCoupe:
        return std::max(rear_ - leaf_.rear_slope_m + 0.1, end - 0.95);
      case CarStyle::kHatch:
        return end - 0.16;
      case CarStyle::kVan:
        return rear_ - 0.001;
      case CarStyle::kPickup:
      case CarStyle::kBox:
      case CarStyle::kRoadster:
        break;
    }
    return rear_ + 0.12;
  }

  double RoofDepth() const { return -SkinX(leaf_, leaf_.roof_m) + leaf_.bow_m; }

  void AddRoof() {
    PanelGrid grid;
    const double near = -RoofDepth();
    const double far = FarX(RoofDepth());
    grid.edge_radius_m = 0.018;
    grid.u_m = EdgeLines(EqualLines(far, near, 6), {far, near}, grid.edge_radius_m);
    grid.v_m = EdgeLines(EqualLines(RoofBegin(), RoofEnd(), 4), {RoofBegin(), RoofEnd()},
                         grid.edge_radius_m);
    const double middle = (near + far) / 2;
    const auto at = [this, middle](double x, double y, double z) {
      const double across = (x - middle) / (shape_.width_m / 2);
      return Eigen::Vector3d(x, y, z + 0.03 * (1 - across * across));
    };
    // the crown must not sink below the leaf's upper edge at the sides
    grid.front = [at, this](double x, double y) {
      return Eigen::Vector3d(at(x, y, RoofZ() + kRoofM));
    };
    grid.back = [at, this](double x, double y) { return Eigen::Vector3d(at(x, y, RoofZ())); };
    solids_.push_back(PanelSolid(grid, kCarShellHullToleranceM));
    AddPillars();
  }

  // A pillar of both sides between a point at the belt line and one under the roof; each point is
  // (depth below the widest line, y, z).
  void AddPillar(const Eigen::Vector3d& foot, const Eigen::Vector3d& head, double width) {
    for (const bool near : {true, false}) {
      const auto ring = [&](const Eigen::Vector3d& p) {
        const double x = near ? -p.x() - kPillarM : FarX(p.x());
        const double c = 0.012;
        Ring points;
        for (const Eigen::Vector2d& q :
             std::initializer_list<Eigen::Vector2d>{{c, 0},
                                                    {kPillarM - c, 0},
                                                    {kPillarM, c},
                                                    {kPillarM, width - c},
                                                    {kPillarM - c, width},
                                                    {c, width},
                                                    {0, width - c},
                                                    {0, c}})
          points.emplace_back(x + q.x(), p.y() + q.y(), p.z());
        return points;
      };
      solids_.push_back(LoftSolid({ring(foot), ring(head)}, 0.001));
    }
  }

  void AddPillars() {
    const double belt = leaf_.belt_m + 0.0005;
    const double roof = RoofZ() - 0.0005;
    const double sunk = -SkinX(leaf_, leaf_.belt_m) + leaf_.bow_m;
    const double head = RoofDepth() + 0.012;
    AddPillar({sunk, -kCarShellGapM - 0.075, belt},
              {head, leaf_.front_slope_m - kCarShellGapM - 0.075, roof}, 0.075);
    if (style_ == CarStyle::kVan) return;
    if (style_ == CarStyle::kPickup || style_ == CarStyle::kBox) return;
    // behind the leaf, so that it may swing
    const double behind = leaf_.thickness_m + leaf_.tuck_m + leaf_.bow_m + 0.02;
    AddPillar({behind, leaf_.length_m - 0.05, leaf_.sill_m},
              {head + 0.06, leaf_.length_m - leaf_.rear_slope_m - 0.05, roof + 0.012}, 0.065);
    AddPillar({sunk + TaperAt(CabinEnd() - 0.1), CabinEnd() - 0.1, belt},
              {head, RoofEnd() - 0.12, roof}, 0.1);
  }

  void AddWindscreen() {
    const double belt = leaf_.belt_m + 0.0005;
    const double height = 0.3;
    const double sunk = -SkinX(leaf_, leaf_.belt_m) + leaf_.bow_m + 0.02;
    AddPillar({sunk, -kCarShellGapM - 0.085, belt}, {sunk + 0.07, 0.2, belt + height}, 0.07);
    AddBox({FarX(sunk + 0.07), 0.2, belt + height + 0.0005},
           {-sunk - 0.07, 0.27, belt + height + 0.035});
    // two head fairings and seats' backs
    for (const double side : {0.25, 0.62}) {
      const double x = -side * shape_.width_m;
      AddBox({x - 0.22, rear_ - 0.28, leaf_.sill_m}, {x, rear_ - 0.12, belt + 0.18});
    }
  }

  CarStyle style_;
  const CarShellShape& shape_;
  const CarLeafShape& leaf_;
  double front_;
  double tail_;
  double rear_;  // where the body goes on behind the leaf
  std::vector<Solid> solids_;
};

}  // namespace

void CheckCarShell(const CarShellShape& shell, const CarLeafShape& leaf, const std::string& path) {
  RequireRange(path, "width_m", shell.width_m, 1.55, 1.98);
  const double least_nose = 2 * (shell.wheel_m + kArchGapM + kBesideArchM) + kCarShellGapM;
  RequireRange(path, "nose_m", shell.nose_m, least_nose, 1.5);
  RequireRange(path, "wheel_m", shell.wheel_m, 0.26, 0.37);
  RequireRange(path, "clearance_m", shell.clearance_m, 0.14, leaf.sill_m - 0.05);
  RequireRange(path, "nose_taper_m", shell.nose_taper_m, 0, 0.15);
  const double arch = 2 * shell.wheel_m + kArchGapM;
  RequireRange(path, "nose_top_m", shell.nose_top_m, std::max(arch - 0.08, 0.55), leaf.belt_m);
  RequireRange(path, "tail_top_m", shell.tail_top_m, arch + 0.05, 1.95);
}

Solid CarShellSolid(CarStyle style, const CarShellShape& shell, const CarLeafShape& leaf) {
  return Shell(style, shell, leaf).Build();
}

}  // namespace doorforge::internal
