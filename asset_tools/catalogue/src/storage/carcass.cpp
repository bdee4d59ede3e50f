// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "storage/carcass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/solids/sweep.h"

#include "family.h"

namespace doorforge::internal {
namespace {

constexpr double kMarginM = 0.003;         // the carcass reaches this far beyond the leaf
constexpr double kLeafToCarcassM = 0.003;  // behind the leaf
constexpr double kLeafToBayM = 0.006;      // between the leaf and what is beside it
constexpr double kBetweenFrontsM = 0.004;
constexpr double kCarcassHullToleranceM = 0.006;
constexpr double kCarcassJointM =
    0.0001;  // boards keep this far from a common face, so none is shared
constexpr double kBoardEdgeM = 0.001;
constexpr double kBackM = 0.008;

void RequireBox(const Carcass& carcass, const std::string& path, const std::string& why) {
  if (carcass.form == CarcassForm::kBox) return;
  throw Error(ErrorCode::kInvalidConfig, path + ".form (" + why + "): found \"" +
                                             std::string(NameOf(carcass.form)) + "\", allowed box");
}

// What lies on a straight back, or is as wide as the cabinet there.
bool NeedsBox(CarcassTop top) {
  constexpr CarcassTop kOnBoxes[] = {CarcassTop::kGallery, CarcassTop::kSlope, CarcassTop::kHutch,
                                     CarcassTop::kMirror,  CarcassTop::kRail,  CarcassTop::kBarrel};
  return std::ranges::find(kOnBoxes, top) != std::end(kOnBoxes);
}

bool Has(const Bay& bay) { return bay.kind != BayKind::kNone; }

void CheckBay(const Bay& bay, const std::string& path, double least_m, double most_m) {
  if (!Has(bay)) return;
  RequireRange(path, "size_m", bay.size_m, least_m, most_m);
  RequireRange(path, "count", bay.count, 1, 5);
}

struct Interval {
  double low;
  double high;
  double size() const { return high - low; }
};

/// Heights and widths of the zones, front and back.
class Frame {
 public:
  Frame(const Carcass& carcass, const CarcassLeaf& leaf);

  Solid Build();
  Rectangle leaf_outline() const { return {{0, leaf_z_.low}, {leaf_width_, leaf_z_.high}}; }

 private:
  Polygon Plan() const;
  void Add(Solid solid) { solids_.push_back(std::move(solid)); }
  void AddWalls();
  void AddOpenSide(double y0);
  void AddLevel(double z, const Interval& y) { AddLevel(z, y, 1); }
  void AddLevel(double z, const Interval& y, double depth);
  void AddUpright(double y, const Interval& z);
  void AddFront(const Interval& y, const Interval& z);
  void AddSideBay(const Bay& bay, const Interval& y);
  void AddWideBay(const Bay& bay, const Interval& z);
  void AddLevels();
  double ShelfHeight(int i) const;
  void AddBase();
  void AddLeg(const Eigen::Vector2d& at);
  void AddSled();
  void AddEnds();
  void AddPedestal();
  void AddTop();
  void AddBoardOnTop(double overhang, const Interval& z);
  void AddHutch();
  void AddGallery();
  void AddSlope();
  void AddPediment();
  void AddMirror();
  void AddRail();
  void AddBarrel();

  const Carcass& carcass_;
  double leaf_width_;
  double thickness_;
  double front_x_;  // of the fronts
  double x1_;       // of the carcass
  double base_;
  Interval below_z_, leaf_z_, above_z_, z_;
  Interval left_y_, right_y_, y_;
  Polygon plan_;   // (x, y); its first edge is the front
  Polygon inner_;  // inside the walls
  std::vector<Solid> solids_;
};

Frame::Frame(const Carcass& carcass, const CarcassLeaf& leaf)
    : carcass_(carcass),
      leaf_width_(leaf.width_m),
      thickness_(leaf.thickness_m),
      front_x_(leaf.front_x_m),
      x1_(leaf.front_x_m - leaf.thickness_m - kLeafToCarcassM),
      base_(carcass.base == CarcassBase::kNone ? 0 : carcass.base_height_m) {
  const auto size = [](const Bay& bay) { return Has(bay) ? bay.size_m + kLeafToBayM : 0; };
  below_z_ = {base_ + kMarginM, base_ + kMarginM + size(carcass.below)};
  leaf_z_ = {below_z_.high, below_z_.high + leaf.height_m};
  above_z_ = {leaf_z_.high, leaf_z_.high + size(carcass.above)};
  z_ = {base_, above_z_.high + kMarginM};
  left_y_ = {-size(carcass.left), -kLeafToBayM};
  right_y_ = {leaf_width_ + kLeafToBayM, leaf_width_ + size(carcass.right)};
  y_ = {-size(carcass.left) - kMarginM, leaf_width_ + size(carcass.right) + kMarginM};
  plan_ = Plan();
  std::vector<double> walls(plan_.size(), carcass.board_m);
  walls[0] = 0;
  for (std::size_t i = 1; i < plan_.size(); ++i) {
    const Eigen::Vector2d edge = plan_[(i + 1) % plan_.size()] - plan_[i];
    const bool is_back = std::abs(edge.x()) < 1e-9;
    if (is_back) walls[i] = kBackM;
  }
  inner_ = InsetEach(plan_, walls);
}

Polygon Frame::Plan() const {
  const double x0 = x1_ - carcass_.depth_m;
  const double width = y_.size();
  const double by = carcass_.form_m;
  if (carcass_.form == CarcassForm::kBox)
    return {{x1_, y_.low}, {x1_, y_.high}, {x0, y_.high}, {x0, y_.low}};
  if (carcass_.form == CarcassForm::kTapered || carcass_.form == CarcassForm::kFlared) {
    const double in = carcass_.form == CarcassForm::kTapered ? by : -by;
    return {{x1_, y_.low}, {x1_, y_.high}, {x0, y_.high - in}, {x0, y_.low + in}};
  }
  if (carcass_.form == CarcassForm::kCorner) {
    const double step = by / std::numbers::sqrt2;
    return {{x1_, y_.low},
            {x1_, y_.high},
            {x1_ - step, y_.high + step},
            {x1_ - 2 * step - width / 2, y_.low + width / 2},
            {x1_ - step, y_.low - step}};
  }
  // quarter ellipses from the front corners to the back
  Polygon plan = {{x1_, y_.low}, {x1_, y_.high}};
  constexpr int kSteps = 4;
  const double reach = std::min(by, 0.4 * width);
  for (int side : {1, -1}) {
    for (int i = 1; i <= kSteps; ++i) {
      const double angle = std::numbers::pi / 2 * (side > 0 ? i : kSteps + 1 - i) / (kSteps + 0.6);
      const double along = reach * (1 - std::cos(angle));
      plan.emplace_back(x1_ - carcass_.depth_m * std::sin(angle),
                        side > 0 ? y_.high - along : y_.low + along);
    }
  }
  return plan;
}

// Posts at the corners, rails between them, and slats.
void Frame::AddOpenSide(double y0) {
  const double b = carcass_.board_m - kCarcassJointM;
  const double x0 = x1_ - carcass_.depth_m;
  // the back's board stands between the rear posts' inner faces and what is behind them
  const double rear = carcass_.back ? x0 + kBackM + kCarcassJointM : x0;
  for (const double x : {rear, x1_ - b})
    Add(ChamferedBox({x, y0, z_.low}, {x + b, y0 + b, z_.high}, kBoardEdgeM));
  const int bars = carcass_.sides == CarcassSides::kSlatted ? 6 : 2;
  const double high = 0.045;
  for (int i = 0; i < bars; ++i) {
    const double z = z_.low + (z_.size() - high) * i / (bars - 1);
    Add(ChamferedBox({rear + b + kCarcassJointM, y0, z},
                     {x1_ - b - kCarcassJointM, y0 + b, z + high}, kBoardEdgeM));
  }
}

void Frame::AddWalls() {
  if (carcass_.sides != CarcassSides::kPanel) {
    AddOpenSide(y_.low);
    AddOpenSide(y_.high - carcass_.board_m + kCarcassJointM);
  }
  for (std::size_t i = 1; i < plan_.size(); ++i) {
    const std::size_t next = (i + 1) % plan_.size();
    const bool is_back = std::abs(plan_[next].x() - plan_[i].x()) < 1e-9;
    if (is_back ? !carcass_.back : carcass_.sides != CarcassSides::kPanel) continue;
    const Polygon wall = {plan_[i], plan_[next], inner_[next], inner_[i]};
    Add(ConvexPrism(Inset(wall, kCarcassJointM), PrismAxis::kZ, {z_.low, z_.high}, kBoardEdgeM));
  }
}

// A level board with its upper face at z + half its thickness, `depth` of the room deep.
void Frame::AddLevel(double z, const Interval& y, double depth) {
  const double half = carcass_.board_m / 2 - kCarcassJointM;
  const auto back = std::ranges::min(inner_, {}, [](const auto& p) { return p.x(); }).x();
  const Polygon deep =
      depth < 1 ? ClippedToBand(inner_, 0, back, back + depth * (x1_ - back)) : inner_;
  const Polygon board = ClippedToBand(deep, 1, y.low, y.high);
  if (board.size() >= 3)
    Add(ConvexPrism(Inset(board, kCarcassJointM), PrismAxis::kZ, {z - half, z + half},
                    kBoardEdgeM));
}

void Frame::AddUpright(double y, const Interval& z) {
  const double half = carcass_.board_m / 2;
  const Polygon board = ClippedToBand(inner_, 1, y - half, y + half);
  Add(ConvexPrism(Inset(board, kCarcassJointM), PrismAxis::kZ,
                  {z.low + kCarcassJointM, z.high - kCarcassJointM}, kBoardEdgeM));
}

void Frame::AddFront(const Interval& y, const Interval& z) {
  ReliefSlab slab;
  slab.outline = {{y.low, z.low}, {y.high, z.high}};
  slab.thickness_m = thickness_;
  slab.edge_radius_m = 0.002;
  const double border = std::min(0.05, 0.22 * std::min(y.size(), z.size()));
  const Rectangle field{slab.outline.min_m.array() + border, slab.outline.max_m.array() - border};
  if (carcass_.fronts == CarcassFronts::kSunk)
    slab.fields = {{field, SunkPanel(0.005, 0.003), ReliefSide::kFront}};
  Add(Moved(ReliefSolid(slab, kCarcassHullToleranceM), {front_x_, 0, 0}));
}

// Part i of n, `gap` between neighbours.
Interval Share(const Interval& whole, int i, int n, double gap) {
  const double size = (whole.size() - gap * (n - 1)) / n;
  return {whole.low + i * (size + gap), whole.low + i * (size + gap) + size};
}

void Frame::AddSideBay(const Bay& bay, const Interval& y) {
  if (!Has(bay)) return;
  const bool at_left = y.low < 0;
  AddUpright(at_left ? -kLeafToBayM / 2 : leaf_width_ + kLeafToBayM / 2,
             {leaf_z_.low + carcass_.board_m, leaf_z_.high - carcass_.board_m});
  const double half = carcass_.board_m / 2;
  const Interval inside = at_left ? Interval{y_.low, -kLeafToBayM / 2 - half}
                                  : Interval{leaf_width_ + kLeafToBayM / 2 + half, y_.high};
  for (int i = 0; i < bay.count; ++i) {
    const Interval z = Share(leaf_z_, i, bay.count, kBetweenFrontsM);
    const bool open = bay.kind == BayKind::kNiche || bay.kind == BayKind::kGrid;
    if (!open) AddFront(y, z);
    if (open && i > 0) AddLevel(z.low - kBetweenFrontsM / 2, inside);
    if (bay.kind == BayKind::kGrid) {
      const double clear = half + kCarcassJointM;
      const bool lowest = i == 0;
      const bool highest = i == bay.count - 1;
      AddUpright((inside.low + inside.high) / 2,
                 {lowest ? leaf_z_.low + 2 * clear : z.low - kBetweenFrontsM / 2 + clear,
                  highest ? leaf_z_.high - 2 * clear : z.high + kBetweenFrontsM / 2 - clear});
    }
  }
}

void Frame::AddWideBay(const Bay& bay, const Interval& z) {
  if (!Has(bay)) return;
  const Interval fronts = z.low < leaf_z_.low ? Interval{z.low, z.high - kLeafToBayM}
                                              : Interval{z.low + kLeafToBayM, z.high};
  const double board = carcass_.board_m;
  for (int i = 0; i < bay.count; ++i) {
    const Interval y =
        Share({y_.low + kMarginM, y_.high - kMarginM}, i, bay.count, kBetweenFrontsM);
    const bool open = bay.kind == BayKind::kNiche || bay.kind == BayKind::kGrid;
    if (!open) AddFront(y, fronts);
    if (!open || i == 0) continue;
    const double middle = (z.low + z.high) / 2;
    const double clear = bay.kind == BayKind::kGrid ? board / 2 : 0;
    const double at = y.low - kBetweenFrontsM / 2;
    AddUpright(at, {z.low + board, clear > 0 ? middle - clear : z.high - board});
    if (clear > 0) AddUpright(at, {middle + clear, z.high - board});
  }
  if (bay.kind == BayKind::kGrid) AddLevel((z.low + z.high) / 2, y_);
}

// Bottom, top, the boards between the zones and the shelves behind the leaf.
void Frame::AddLevels() {
  const double half = carcass_.board_m / 2;
  AddLevel(z_.low + half, y_);
  AddLevel(z_.high - half, y_);
  if (Has(carcass_.below)) AddLevel(leaf_z_.low - kLeafToBayM / 2, y_);
  if (Has(carcass_.above)) AddLevel(leaf_z_.high + kLeafToBayM / 2, y_);
  const Interval inside{Has(carcass_.left) ? -kLeafToBayM / 2 + half : y_.low,
                        Has(carcass_.right) ? leaf_width_ + kLeafToBayM / 2 - half : y_.high};
  for (int i = 1; i <= carcass_.shelves; ++i)
    AddLevel(ShelfHeight(i), inside, carcass_.shelf_depth);
  // a board's thickness below and above is taken by what closes the room
  const double top = carcass_.shelves > 0 ? ShelfHeight(1) - half : leaf_z_.high - carcass_.board_m;
  for (int i = 1; i <= carcass_.dividers; ++i)
    AddUpright(leaf_width_ * i / (carcass_.dividers + 1), {leaf_z_.low + carcass_.board_m, top});
}

double Frame::ShelfHeight(int i) const {
  const double share = static_cast<double>(i) / (carcass_.shelves + 1);
  return leaf_z_.low + leaf_z_.size() * std::pow(share, carcass_.shelf_grading);
}

// Up to four corners of the plan that lie far apart.
std::vector<Eigen::Vector2d> FootPlaces(const Polygon& plan) {
  std::vector<Eigen::Vector2d> places = {plan[0], plan[1]};
  while (places.size() < std::min<std::size_t>(4, plan.size())) {
    const auto distance = [&](const Eigen::Vector2d& p) {
      double nearest = 1e9;
      for (const Eigen::Vector2d& place : places) nearest = std::min(nearest, (p - place).norm());
      return nearest;
    };
    const auto farthest =
        std::max_element(plan.begin(), plan.end(),
                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (distance(*farthest) < 0.12) break;
    places.push_back(*farthest);
  }
  return places;
}

Ring SquareRing(const Eigen::Vector2d& at, double half, double z) {
  return {{at.x() - half, at.y() - half, z},
          {at.x() + half, at.y() - half, z},
          {at.x() + half, at.y() + half, z},
          {at.x() - half, at.y() + half, z}};
}

void Frame::AddLeg(const Eigen::Vector2d& at) {
  const double top = base_ - kCarcassJointM;
  if (carcass_.base == CarcassBase::kStand) {
    const double half = 0.02;
    const double shelf = 0.28 * base_;
    Add(ChamferedBox({at.x() - half, at.y() - half, 0},
                     {at.x() + half, at.y() + half, shelf - kCarcassJointM}, 0.002));
    Add(ChamferedBox({at.x() - half, at.y() - half, shelf + 0.018 + kCarcassJointM},
                     {at.x() + half, at.y() + half, top}, 0.002));
  } else if (carcass_.base == CarcassBase::kLegs) {
    const double half = 0.0225;
    Add(ChamferedBox({at.x() - half, at.y() - half, 0}, {at.x() + half, at.y() + half, top},
                     0.006));
  } else if (carcass_.base == CarcassBase::kFeet) {
    const double half = 0.04;
    Add(ChamferedBox({at.x() - half, at.y() - half, 0}, {at.x() + half, at.y() + half, top}, 0.01));
  } else if (carcass_.base == CarcassBase::kTapered) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : plan_) middle += p / static_cast<double>(plan_.size());
    // splayed outwards as far as the leg stands in
    const Eigen::Vector2d foot = at + 0.02 * (at - middle).normalized();
    Add(LoftSolid({SquareRing(foot, 0.011, 0), SquareRing(foot, 0.013, 0.003),
                   SquareRing(at, 0.024, top - 0.003), SquareRing(at, 0.022, top)},
                  0.003));
  } else {
    const double r = std::min(0.045, 0.5 * base_ + 0.012);
    std::vector<Ring> rings;
    for (int i = 0; i <= 8; ++i) {
      const double angle = std::numbers::pi * (0.16 + 0.68 * i / 8);
      const double z = top * i / 8;
      Ring ring;
      for (const Eigen::Vector2d& p : CirclePolygon(at, r * std::sin(angle), 14))
        ring.emplace_back(p.x(), p.y(), z);
      rings.push_back(ring);
    }
    Add(LoftSolid(rings, 0.005));
  }
}

// Two runners with an upright at each end.
void Frame::AddSled() {
  const double half = 0.015;
  const double x0 = x1_ - carcass_.depth_m;
  for (const double y : {y_.low + 0.05, y_.high - 0.05}) {
    Add(ChamferedBox({x0 + 0.02, y - half, 0}, {x1_ - 0.02, y + half, 0.03}, 0.003));
    for (const double x : {x0 + 0.035, x1_ - 0.035})
      Add(ChamferedBox({x - half, y - half, 0.03 + kCarcassJointM},
                       {x + half, y + half, base_ - kCarcassJointM}, 0.003));
  }
}

// A board under each end, or an upright on a foot.
void Frame::AddEnds() {
  const double x0 = x1_ - carcass_.depth_m;
  const double top = base_ - kCarcassJointM;
  const double half = 0.014;
  for (const double y : {y_.low + 0.04, y_.high - 0.04}) {
    if (carcass_.base == CarcassBase::kPanels) {
      Add(ChamferedBox({x0 + 0.01, y - half, 0}, {x1_ - 0.03, y + half, top}, 0.002));
      continue;
    }
    const double middle = (x0 + x1_) / 2;
    Add(ChamferedBox({x0 + 0.02, y - 0.025, 0}, {x1_ - 0.02, y + 0.025, 0.04}, 0.006));
    Add(ChamferedBox({middle - 0.09, y - half, 0.04 + kCarcassJointM},
                     {middle + 0.09, y + half, top - 0.03 - kCarcassJointM}, 0.004));
    Add(ChamferedBox({x0 + 0.04, y - 0.02, top - 0.03}, {x1_ - 0.04, y + 0.02, top}, 0.004));
  }
  if (carcass_.base == CarcassBase::kTrestle) {
    const double middle = (x0 + x1_) / 2;
    const double z = 0.04 + 0.5 * (top - 0.07);
    Add(ChamferedBox({middle - 0.012, y_.low + 0.04 + half + kCarcassJointM, z - 0.02},
                     {middle + 0.012, y_.high - 0.04 - half - kCarcassJointM, z + 0.02}, 0.003));
  }
}

// A column on a plate.
void Frame::AddPedestal() {
  const double x0 = x1_ - carcass_.depth_m;
  const double top = base_ - kCarcassJointM;
  const Eigen::Vector2d middle((x0 + x1_) / 2, (y_.low + y_.high) / 2);
  const Eigen::Vector2d half(0.42 * carcass_.depth_m, 0.38 * y_.size());
  const auto block = [&](double share, double low, double high) {
    const Eigen::Vector2d reach = share * half;
    Add(ChamferedBox({middle.x() - reach.x(), middle.y() - reach.y(), low},
                     {middle.x() + reach.x(), middle.y() + reach.y(), high}, 0.004));
  };
  block(1, 0, 0.025);
  block(0.4, 0.025 + kCarcassJointM, top);
}

void Frame::AddBase() {
  if (carcass_.base == CarcassBase::kNone) return;
  if (carcass_.base == CarcassBase::kPlinth) {
    std::vector<double> in(plan_.size(), 0.012);
    in[0] = 0.05;
    Add(ConvexPrism(InsetEach(plan_, in), PrismAxis::kZ, {0, base_ - kCarcassJointM}, 0.002));
  } else if (carcass_.base == CarcassBase::kSled) {
    AddSled();
  } else if (carcass_.base == CarcassBase::kPanels || carcass_.base == CarcassBase::kTrestle) {
    AddEnds();
  } else if (carcass_.base == CarcassBase::kPedestal) {
    AddPedestal();
  } else {
    for (const Eigen::Vector2d& at : FootPlaces(Inset(plan_, 0.045))) AddLeg(at);
    const double shelf = 0.28 * base_;
    if (carcass_.base == CarcassBase::kStand)
      Add(ConvexPrism(Inset(plan_, 0.02), PrismAxis::kZ, {shelf, shelf + 0.018}, kBoardEdgeM));
  }
}

void Frame::AddBoardOnTop(double overhang, const Interval& z) {
  std::vector<double> out(plan_.size(), -overhang);
  for (std::size_t i = 1; i < plan_.size(); ++i) {
    const Eigen::Vector2d edge = plan_[(i + 1) % plan_.size()] - plan_[i];
    if (std::abs(edge.x()) < 1e-9) out[i] = 0;  // against the wall
  }
  Add(ConvexPrism(InsetEach(plan_, out), PrismAxis::kZ, {z.low + kCarcassJointM, z.high}, 0.004));
}

// Two uprights, a back, a shelf and a top, less deep than the carcass.
void Frame::AddHutch() {
  const double b = carcass_.board_m;
  const double x0 = x1_ - carcass_.depth_m;
  const double front = x0 + 0.6 * carcass_.depth_m;
  const double z0 = z_.high + 0.02;
  const double z1 = z0 + carcass_.top_height_m;
  AddBoardOnTop(0.012, {z_.high, z0});
  const auto board = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    Add(ChamferedBox(low.array() + kCarcassJointM, high.array() - kCarcassJointM, kBoardEdgeM));
  };
  board({x0, y_.low, z0}, {front, y_.low + b, z1 - b});
  board({x0, y_.high - b, z0}, {front, y_.high, z1 - b});
  board({x0, y_.low + b, z0}, {x0 + kBackM, y_.high - b, z1 - b});
  board({x0, y_.low - 0.01, z1 - b}, {front + 0.01, y_.high + 0.01, z1});
  if (carcass_.top_height_m > 0.3) {
    const double middle = (z0 + z1 - b) / 2;
    board({x0 + kBackM, y_.low + b, middle - b / 2}, {front - 0.01, y_.high - b, middle + b / 2});
  }
}

void Frame::AddGallery() {
  const double b = carcass_.board_m;
  const double x0 = x1_ - carcass_.depth_m;
  const double z0 = z_.high + 0.022;
  AddBoardOnTop(0.01, {z_.high, z0});
  const double h = carcass_.top_height_m;
  const auto board = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    Add(ChamferedBox(low.array() + kCarcassJointM, high.array() - kCarcassJointM, kBoardEdgeM));
  };
  board({x0, y_.low, z0}, {x0 + b, y_.high, z0 + h});
  for (const double y : {y_.low, y_.high - b})
    board({x0 + b, y, z0}, {x0 + 0.7 * carcass_.depth_m, y + b, z0 + 0.6 * h});
}

void Frame::AddSlope() {
  const double x0 = x1_ - carcass_.depth_m;
  const double z0 = z_.high + kCarcassJointM;
  const double shelf = 0.3 * carcass_.depth_m;  // level again behind the slope
  Add(ConvexPrism({{z0, x0},
                   {z0 + carcass_.top_height_m, x0},
                   {z0 + carcass_.top_height_m, x0 + shelf},
                   {z0 + 0.03, x1_ + 0.01},
                   {z0, x1_ + 0.01}},
                  PrismAxis::kY, {y_.low, y_.high}, 0.003));
}

void Frame::AddPediment() {
  AddBoardOnTop(0.02, {z_.high, z_.high + 0.024});
  const double z0 = z_.high + 0.024 + kCarcassJointM;
  Add(ConvexPrism({{y_.low, z0},
                   {y_.high, z0},
                   {(y_.low + y_.high) / 2 + 0.01, z0 + carcass_.top_height_m},
                   {(y_.low + y_.high) / 2 - 0.01, z0 + carcass_.top_height_m}},
                  PrismAxis::kX, {x1_ - 0.05, x1_ - 0.01}, 0.003));
}

// A framed panel that leans against the wall.
void Frame::AddMirror() {
  AddBoardOnTop(0.01, {z_.high, z_.high + 0.022});
  const double z0 = z_.high + 0.022 + kCarcassJointM;
  const double in = 0.08 * y_.size();
  ReliefSlab slab;
  slab.outline = {{y_.low + in, z0}, {y_.high - in, z0 + carcass_.top_height_m}};
  slab.thickness_m = 0.024;
  slab.edge_radius_m = 0.003;
  const double border = 0.04;
  slab.fields = {{{slab.outline.min_m.array() + border, slab.outline.max_m.array() - border},
                  SunkPanel(0.008, 0.004),
                  ReliefSide::kFront}};
  Add(Moved(ReliefSolid(slab, kCarcassHullToleranceM), {x1_ - carcass_.depth_m + 0.024, 0, 0}));
}

// Posts at the corners and rods between them, open in front.
void Frame::AddRail() {
  const double b = 0.018;
  const double x0 = x1_ - carcass_.depth_m;
  const double front = x1_ - 0.02;
  const double z0 = z_.high + 0.022;
  const double z1 = z0 + carcass_.top_height_m;
  AddBoardOnTop(0.01, {z_.high, z0});
  const auto rod = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    Add(ChamferedBox(low.array() + kCarcassJointM, high.array() - kCarcassJointM, 0.003));
  };
  for (const double y : {y_.low, y_.high - b}) {
    for (const double x : {x0, front - b}) rod({x, y, z0}, {x + b, y + b, z1 - b});
    rod({x0, y, z1 - b}, {front, y + b, z1});
  }
  rod({x0, y_.low + b, z1 - b}, {x0 + b, y_.high - b, z1});
}

// The arch runs from side to side.
void Frame::AddBarrel() {
  AddBoardOnTop(0.008, {z_.high, z_.high + 0.02});
  const double z0 = z_.high + 0.02 + kCarcassJointM;
  constexpr int kSteps = 12;
  const double half = y_.size() / 2;
  Polygon arch;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * (0.04 + 0.92 * i / kSteps);
    arch.emplace_back((y_.low + y_.high) / 2 + half * std::cos(angle),
                      z0 + carcass_.top_height_m * std::sin(angle));
  }
  arch.emplace_back(y_.low, z0);
  arch.emplace_back(y_.high, z0);
  Add(ConvexPrism(arch, PrismAxis::kX, {x1_ - carcass_.depth_m, x1_}, 0.003));
}

void Frame::AddTop() {
  switch (carcass_.top) {
    case CarcassTop::kFlush:
      return;
    case CarcassTop::kBoard:
      return AddBoardOnTop(0.015, {z_.high, z_.high + 0.026});
    case CarcassTop::kCornice:
      AddBoardOnTop(0.012, {z_.high, z_.high + 0.02});
      return AddBoardOnTop(0.03, {z_.high + 0.02, z_.high + 0.045});
    case CarcassTop::kGallery:
      return AddGallery();
    case CarcassTop::kSlope:
      return AddSlope();
    case CarcassTop::kPediment:
      return AddPediment();
    case CarcassTop::kHutch:
      return AddHutch();
    case CarcassTop::kMirror:
      return AddMirror();
    case CarcassTop::kRail:
      return AddRail();
    case CarcassTop::kBarrel:
      return AddBarrel();
  }
}

Solid Frame::Build() {
  AddWalls();
  AddLevels();
  AddSideBay(carcass_.left, left_y_);
  AddSideBay(carcass_.right, right_y_);
  AddWideBay(carcass_.below, below_z_);
  AddWideBay(carcass_.above, above_z_);
  AddBase();
  AddTop();
  return Joined(solids_);
}

}  // namespace

void CheckCarcass(const Carcass& carcass, const std::string& path) {
  RequireRange(path, "depth_m", carcass.depth_m, 0.28, 0.9);
  RequireRange(path, "board_m", carcass.board_m, 0.012, 0.035);
  RequireRange(path, "shelves", carcass.shelves, 0, 4);
  RequireRange(path, "shelf_depth", carcass.shelf_depth, 0.3, 1);
  RequireRange(path, "shelf_grading", carcass.shelf_grading, 0.6, 1.6);
  RequireRange(path, "dividers", carcass.dividers, 0, 3);
  RequireRange(path, "base_height_m", carcass.base_height_m, 0.03, 0.55);
  RequireRange(path, "form_m", carcass.form_m, 0.02, 0.4);
  RequireRange(path, "top_height_m", carcass.top_height_m, 0.03, 0.6);
  if (NeedsBox(carcass.top))
    RequireBox(carcass, path, "under top " + std::string(NameOf(carcass.top)));
  if (carcass.sides != CarcassSides::kPanel || !carcass.back)
    RequireBox(carcass, path, "with open sides or back");
  CheckBay(carcass.left, path + ".left", 0.18, 0.8);
  CheckBay(carcass.right, path + ".right", 0.18, 0.8);
  CheckBay(carcass.below, path + ".below", 0.12, 0.5);
  CheckBay(carcass.above, path + ".above", 0.12, 0.5);
}

Rectangle LeafOutline(const Carcass& carcass, const CarcassLeaf& leaf) {
  return Frame(carcass, leaf).leaf_outline();
}

Solid CarcassSolid(const Carcass& carcass, const CarcassLeaf& leaf) {
  return Frame(carcass, leaf).Build();
}

}  // namespace doorforge::internal
