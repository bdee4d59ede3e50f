// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/solids/outline_hoop.h"

#include "family.h"
#include "leaf_layout.h"
#include "leaf_styles.h"

namespace doorforge::internal {
namespace {

constexpr double kWindowGapM = 0.005;     // between leaf and frame
constexpr double kWindowJointM = 0.0002;  // between solids that touch
constexpr double kWindowStopM = 0.012;    // how far the frame reaches behind the leaf
constexpr double kWindowHullToleranceM = 0.006;
constexpr double kWindowMountToEdgeM = 0.03;  // UniDoorManip: 3 cm from the leaf's free edge

struct WindowFrame {
  double width_m = 0.05;  ///< Seen from the front.
  double depth_m = 0.09;  ///< Along x; more than the leaf's thickness and the stop.
  double front_m = 0;     ///< x of its face; the leaf's is 0.
  double casing_m = 0;    ///< Not 0: width of a flat board around the frame.
  double sill_m = 0;      ///< Not 0: how far a board below stands out.
  std::string finish = "profile_white";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("width_m", self.width_m);
    visit("depth_m", self.depth_m);
    visit("front_m", self.front_m);
    visit("casing_m", self.casing_m);
    visit("sill_m", self.sill_m);
    visit("finish", self.finish);
  }
};

/// A part of the window that does not open.
struct FixedLight {
  double size_m = 0;   ///< 0: there is none.
  bool panel = false;  ///< Closed by a panel instead of bars.
  BarGrid bars;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("size_m", self.size_m);
    visit("panel", self.panel);
    visit("bars", self.bars);
  }
};

/// What all windows share.
struct WindowBody {
  double leaf_width_m = 0.6;
  double leaf_height_m = 1.0;
  double thickness_m = 0.045;
  double stile_m = 0.07;  ///< Width of the leaf's own frame; the handle sits on it.
  HeadShape head;         ///< The leaf has it, or the light above it where there is one.
  WindowFrame frame;
  FixedLight above;
  FixedLight below;
  FixedLight beside;  ///< At the leaf's free edge.
  std::string finish = "profile_white";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("thickness_m", self.thickness_m);
    visit("stile_m", self.stile_m);
    visit("head", self.head);
    visit("frame", self.frame);
    visit("above", self.above);
    visit("below", self.below);
    visit("beside", self.beside);
    visit("finish", self.finish);
  }
};

struct DividedWindow : WindowBody {
  BarGrid bars;
  double panel_m = 0;  ///< Not 0: the leaf's lower part up to this height is closed.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowBody::VisitFields(self, visit);
    visit("bars", self.bars);
    visit("panel_m", self.panel_m);
  }
};

struct FannedWindow : WindowBody {
  int rays = 5;
  double hub_m = 0.1;
  double bar_width_m = 0.022;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowBody::VisitFields(self, visit);
    visit("rays", self.rays);
    visit("hub_m", self.hub_m);
    visit("bar_width_m", self.bar_width_m);
  }
};

struct LatticeWindow : WindowBody {
  int bars = 5;
  double bar_width_m = 0.018;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowBody::VisitFields(self, visit);
    visit("bars", self.bars);
    visit("bar_width_m", self.bar_width_m);
  }
};

struct ShutterWindow : WindowBody {
  int slats = 14;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowBody::VisitFields(self, visit);
    visit("slats", self.slats);
  }
};

struct SolidShutterWindow : WindowBody {
  int panels = 2;
  bool crossed = false;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowBody::VisitFields(self, visit);
    visit("panels", self.panels);
    visit("crossed", self.crossed);
  }
};

void CheckBars(const BarGrid& bars, const std::string& path) {
  RequireRange(path, "columns", bars.columns, 1, 4);
  RequireRange(path, "rows", bars.rows, 1, 6);
  RequireRange(path, "width_m", bars.width_m, 0.01, 0.06);
}

void Check(const WindowBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.47, 0.93);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 0.5, 1.5);
  RequireRange(path, "thickness_m", body.thickness_m, 0.028, 0.06);
  RequireRange(path, "stile_m", body.stile_m, 0.062, 0.12);
  const WindowFrame& frame = body.frame;
  RequireRange(path + ".frame", "width_m", frame.width_m, 0.03, 0.12);
  RequireRange(path + ".frame", "depth_m", frame.depth_m, body.thickness_m + 0.02, 0.15);
  RequireRange(path + ".frame", "front_m", frame.front_m, -0.02, 0.012);
  RequireRange(path + ".frame", "casing_m", frame.casing_m, 0, 0.32);
  RequireRange(path + ".frame", "sill_m", frame.sill_m, 0, 0.08);
  for (const FixedLight* light : {&body.above, &body.below, &body.beside}) {
    if (light->size_m != 0) RequireRange(path, "size_m of a light", light->size_m, 0.16, 0.8);
    CheckBars(light->bars, path + ".bars");
  }
}

// Where the leaf's lower edge is, so that the window stands on z = 0.
double LeafBottom(const WindowBody& body) {
  const double sill = body.frame.sill_m > 0 ? 0.03 : 0;
  return sill + body.frame.casing_m + body.frame.width_m + kWindowGapM + body.below.size_m;
}

Rectangle LeafBox(const WindowBody& body) {
  const double low = LeafBottom(body);
  return {{0, low}, {body.leaf_width_m, low + body.leaf_height_m}};
}

HeadShape LeafHead(const WindowBody& body) {
  return body.above.size_m > 0 ? HeadShape{} : body.head;
}

Polygon LeafOutline(const WindowBody& body, const std::string& path) {
  return OutlineWithHead(LeafBox(body), LeafHead(body), path + ".head");
}

// The frame that the leaf shuts against; one with a stop behind the leaf, in (u, x).
Solid MainFrame(const WindowBody& body, const Polygon& leaf) {
  const WindowFrame& frame = body.frame;
  const double back = frame.front_m - frame.depth_m;
  const double front = frame.front_m;
  const double stop = -body.thickness_m - 0.004;
  const double outer = kWindowGapM + frame.width_m;
  constexpr double kEdge = 0.003;
  const Polygon section = {
      {-kWindowStopM, back + kEdge}, {-kWindowStopM + kEdge, back}, {outer, back},
      {outer, front - kEdge},        {outer - kEdge, front},        {kWindowGapM + kEdge, front},
      {kWindowGapM, front - kEdge},  {kWindowGapM, stop},           {-kWindowStopM, stop}};
  return OutlineHoop(leaf, section,
                     {{{{kWindowGapM, back}, {outer, front}}, 0.4 * kWindowGapM},
                      {{{-kWindowStopM, back}, {kWindowGapM, stop}}, 0.012}});
}

// A fixed light that fills an outline, its frame inside it.
Solid Light(const WindowBody& body, const Polygon& outline, const FixedLight& light) {
  const double back = body.frame.front_m - 0.8 * body.frame.depth_m;
  const double front = body.frame.front_m - 0.002;
  const double width = std::max(0.03, 0.7 * body.stile_m);
  constexpr double kEdge = 0.004;
  const Polygon section = {{-width, back + 0.2 * (front - back)},
                           {-width + 0.01, back},
                           {0, back},
                           {0, front - kEdge},
                           {-kEdge, front},
                           {-width + 0.01, front},
                           {-width, front - 0.01}};
  std::vector<Solid> solids = {OutlineHoop(outline, section, {{{{-width, back}, {0, front}}}})};
  const Polygon inside = Inset(outline, width);
  const PrismSpan depth{back + 0.3 * (front - back), front - 0.3 * (front - back)};
  if (light.panel)
    solids.push_back(ConvexPrism(Inset(inside, kWindowJointM), PrismAxis::kX, depth, 0));
  else
    solids.push_back(BarsInside(inside, light.bars, depth));
  return Joined(solids);
}

// Boards laid around a rectangle.
Solid Casing(const WindowBody& body, const Rectangle& around) {
  const double width = body.frame.casing_m;
  const double front = body.frame.front_m + 0.004;
  const double back = front - 0.024;
  const Polygon section = {{kWindowJointM, back},  {width, back},  {width, front - 0.006},
                           {width - 0.006, front}, {0.006, front}, {kWindowJointM, front - 0.006}};
  return OutlineHoop(BoxPolygon(around.min_m, around.max_m), section,
                     {{{{kWindowJointM, back}, {width, front}}}});
}

Solid FrameSolid(const WindowBody& body, const std::string& path, const Polygon& leaf) {
  const Rectangle box = LeafBox(body);
  const double margin = kWindowGapM + body.frame.width_m;
  Rectangle all{box.min_m.array() - margin, box.max_m.array() + margin};
  std::vector<Solid> solids = {MainFrame(body, leaf)};
  const auto add = [&](const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                       const HeadShape& head, const FixedLight& light) {
    const Rectangle place{low.array() + kWindowJointM, high.array() - kWindowJointM};
    solids.push_back(Light(body, OutlineWithHead(place, head, path + ".head"), light));
  };
  if (body.beside.size_m > 0) {
    add({all.max_m.x(), all.min_m.y()}, {all.max_m.x() + body.beside.size_m, all.max_m.y()}, {},
        body.beside);
    all.max_m.x() += body.beside.size_m;
  }
  if (body.above.size_m > 0) {
    add({all.min_m.x(), all.max_m.y()}, {all.max_m.x(), all.max_m.y() + body.above.size_m},
        body.head, body.above);
    all.max_m.y() += body.above.size_m;
  }
  if (body.below.size_m > 0) {
    add({all.min_m.x(), all.min_m.y() - body.below.size_m}, {all.max_m.x(), all.min_m.y()}, {},
        body.below);
    all.min_m.y() -= body.below.size_m;
  }
  if (body.frame.casing_m > 0) {
    if (body.head.shape != HeadKind::kFlat)
      throw Error(ErrorCode::kInvalidConfig,
                  path + ".frame.casing_m: found a casing on a window whose head is \"" +
                      std::string(NameOf(body.head.shape)) + "\", allowed on flat ones");
    solids.push_back(Casing(body, all));
    all.min_m.array() -= body.frame.casing_m;
    all.max_m.array() += body.frame.casing_m;
  }
  if (body.frame.sill_m > 0)
    solids.push_back(ChamferedBox(
        {body.frame.front_m - body.frame.depth_m, all.min_m.x() - 0.02, 0},
        {body.frame.front_m + body.frame.sill_m, all.max_m.x() + 0.02, 0.03 - kWindowJointM},
        0.004));
  return Joined(solids);
}

// The leaf's own frame of stiles and rails.
Solid Sash(const WindowBody& body, const Polygon& outline) {
  const double t = body.thickness_m;
  const double s = body.stile_m;
  constexpr double kEdge = 0.004;
  const Polygon section = {{-s, -0.75 * t}, {-s + 0.01, -t}, {-kEdge, -t},   {0, -t + kEdge},
                           {0, -kEdge},     {-kEdge, 0},     {-s + 0.01, 0}, {-s, -0.25 * t}};
  return OutlineHoop(outline, section, {{{{-s, -t}, {0, 0}}}});
}

PrismSpan BarDepth(const WindowBody& body) {
  return {-0.75 * body.thickness_m, -0.25 * body.thickness_m};
}

Part BodyPart(const WindowBody& body, const std::string& path, const Solid& leaf) {
  Part part;
  part.joint = BodyHinge(0);
  const double bottom = LeafBottom(body);
  const double upright =
      body.leaf_height_m - (LeafHead(body).shape == HeadKind::kFlat ? 0 : LeafHead(body).rise_m);
  const Solid knuckles =
      HingeKnuckles(part.joint, {bottom + 0.15 * upright, bottom + 0.85 * upright});
  const Solid frame = FrameSolid(body, path, LeafOutline(body, path));
  part.pieces.push_back(
      MakePiece("frame", Joined({frame, knuckles}), body.frame.finish, path + ".frame.finish"));
  part.pieces.push_back(MakePiece("leaf", leaf, body.finish, path + ".finish"));
  // high enough for an upright handle below an arch
  part.part_from_mount =
      Translation({0, body.leaf_width_m - kWindowMountToEdgeM,
                   bottom + std::min(0.46 * body.leaf_height_m, upright - 0.14)});
  return part;
}

LeafShape ShapeOf(const WindowBody& body) {
  return {LeafBox(body), body.thickness_m, 0.003, body.stile_m};
}

void RequireFlatLeaf(const WindowBody& body, const std::string& path) {
  if (LeafHead(body).shape == HeadKind::kFlat) return;
  throw Error(ErrorCode::kInvalidConfig, path + ".head.shape: found \"" +
                                             std::string(NameOf(body.head.shape)) +
                                             "\", allowed for this leaf flat");
}

Part BuildDivided(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<DividedWindow>(json, path);
  Check(body, path);
  CheckBars(body.bars, path + ".bars");
  const Polygon outline = LeafOutline(body, path);
  const Polygon inside = Inset(outline, body.stile_m);
  std::vector<Solid> solids = {Sash(body, outline)};
  Polygon lights = inside;
  if (body.panel_m > 0) {
    RequireRange(path, "panel_m", body.panel_m, body.stile_m + 0.1, 0.7 * body.leaf_height_m);
    const double rail = LeafBottom(body) + body.panel_m;
    const Polygon within = Inset(inside, kWindowJointM);
    const Polygon lower = ClippedToBand(within, 1, within[0].y(), rail - body.stile_m);
    solids.push_back(ConvexPrism(lower, PrismAxis::kX, BarDepth(body), 0.003));
    solids.push_back(ConvexPrism(
        ClippedToBand(within, 1, rail - body.stile_m + kWindowJointM, rail - kWindowJointM),
        PrismAxis::kX, {-0.98 * body.thickness_m, -0.02 * body.thickness_m}, 0.003));
    lights = Clipped(inside, {0, rail}, {0, -1});
  }
  solids.push_back(BarsInside(lights, body.bars, BarDepth(body)));
  return BodyPart(body, path, Joined(solids));
}

Part BuildFanned(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<FannedWindow>(json, path);
  Check(body, path);
  RequireRange(path, "rays", body.rays, 2, 7);
  RequireRange(path, "bar_width_m", body.bar_width_m, 0.012, 0.035);
  const Polygon outline = LeafOutline(body, path);
  const Polygon inside = Inset(outline, body.stile_m);
  RequireRange(path, "hub_m", body.hub_m, 0.05, 0.35 * body.leaf_width_m - body.stile_m / 2);
  return BodyPart(
      body, path,
      Joined({Sash(body, outline), RaysInside(inside, body.rays, body.hub_m,
                                              {1, 1, body.bar_width_m}, BarDepth(body))}));
}

Part BuildLattice(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<LatticeWindow>(json, path);
  Check(body, path);
  RequireFlatLeaf(body, path);
  RequireRange(path, "bars", body.bars, 3, 10);
  RequireRange(path, "bar_width_m", body.bar_width_m, 0.01, 0.03);
  return BodyPart(body, path, LatticedLeaf(ShapeOf(body), body.bars, body.bar_width_m));
}

Part BuildWindowLouvred(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ShutterWindow>(json, path);
  Check(body, path);
  RequireFlatLeaf(body, path);
  RequireRange(path, "slats", body.slats, 6, 24);
  return BodyPart(body, path, LouvredLeaf(ShapeOf(body), body.slats));
}

Part BuildWindowBraced(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<SolidShutterWindow>(json, path);
  Check(body, path);
  RequireFlatLeaf(body, path);
  RequireRange(path, "panels", body.panels, 1, 3);
  return BodyPart(body, path, BracedLeaf(ShapeOf(body), body.panels, body.crossed));
}

}  // namespace

std::span<const Family> WindowBodyFamilies() {
  static const Family kFamilies[] = {
      {"window_divided", PartRole::kBody, Mechanism::kNone, BuildDivided},
      {"window_fanned", PartRole::kBody, Mechanism::kNone, BuildFanned},
      {"window_lattice", PartRole::kBody, Mechanism::kNone, BuildLattice},
      {"window_louvred", PartRole::kBody, Mechanism::kNone, BuildWindowLouvred},
      {"window_braced", PartRole::kBody, Mechanism::kNone, BuildWindowBraced},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
