// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "interior/interior_body.h"

#include <cmath>
#include <utility>

#include "doorforge/mesh/convex_parts.h"

namespace doorforge::internal {
namespace {

constexpr double kRevealM = 0.009;     // the casing stands back from the jamb's edge
constexpr double kJambM = 0.03;        // thickness of the jamb's board
constexpr double kStopM = 0.012;       // how far the stop reaches behind the leaf
constexpr double kStopLengthM = 0.03;  // of the stop, along x
constexpr int kArchSegments = 18;
constexpr double kMountHeightM = 0.8;   // UniDoorManip: 0.8 m above the leaf's bottom
constexpr double kMountToEdgeM = 0.08;  // and 8 cm from its free edge

// The casing's face from its outer to its inner edge, as (distance outwards, height).
std::vector<Eigen::Vector2d> CasingFace(const DoorFrame& frame) {
  const double width = frame.casing_width_m;
  const double depth = frame.casing_depth_m;
  if (frame.casing == CasingFaceKind::kFlat)
    return {{width, depth - 0.002}, {width - 0.002, depth}, {0.002, depth}, {0, depth - 0.002}};
  if (frame.casing == CasingFaceKind::kStepped)
    return {{width, depth - 0.002},      {width - 0.002, depth},      {0.62 * width, depth},
            {0.6 * width, 0.72 * depth}, {0.2 * width, 0.68 * depth}, {0.17 * width, 0.45 * depth},
            {0.002, 0.45 * depth},       {0, 0.45 * depth - 0.002}};
  std::vector<Eigen::Vector2d> rounded;
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    rounded.emplace_back(width * (1 - t), depth * (0.4 + 0.6 * std::sin(0.45 + 2.5 * t)));
  }
  return rounded;
}

// Cross-section of the frame: (u, x) with u outwards from the leaf's gap; counter-clockwise.
std::vector<Eigen::Vector2d> FrameProfile(const InteriorBody& body) {
  const double back = -body.frame.wall_m;
  const double outer = kRevealM + body.frame.casing_width_m;
  const double stop = -body.thickness_m - kInteriorGapM;
  const std::vector<Eigen::Vector2d> face = CasingFace(body.frame);
  std::vector<Eigen::Vector2d> profile = {{0, back}, {kRevealM, back}};
  for (auto p = face.rbegin(); p != face.rend(); ++p)
    profile.emplace_back(kRevealM + p->x(), back - p->y());
  profile.insert(profile.end(), {{outer, back}, {kJambM, back}, {kJambM, 0}, {outer, 0}});
  for (const Eigen::Vector2d& p : face) profile.emplace_back(kRevealM + p.x(), p.y());
  profile.insert(profile.end(), {{kRevealM, 0},
                                 {0, 0},
                                 {0, stop},
                                 {-kStopM, stop},
                                 {-kStopM, stop - kStopLengthM},
                                 {0, stop - kStopLengthM}});
  return profile;
}

/// A point of the opening's edge with the way on which a profile's u runs there: mitred.
struct EdgePoint {
  Eigen::Vector2d position_m;
  Eigen::Vector2d outwards;
};

// The edge at `gap` around the leaf: up one jamb, along the head and down the other.
std::vector<Eigen::Vector2d> EdgeOf(const FrameOpening& opening) {
  const Rectangle& area = opening.area;
  std::vector<Eigen::Vector2d> edge = {{area.min_m.x(), 0}};
  const int segments = opening.arch.rise_m > 0 ? kArchSegments : 1;
  for (int i = 0; i <= segments; ++i) {
    const double y = area.min_m.x() + (area.max_m.x() - area.min_m.x()) * i / segments;
    edge.emplace_back(y, area.max_m.y() - opening.arch.DropAt(y));
  }
  edge.emplace_back(area.max_m.x(), 0);
  return edge;
}

std::vector<EdgePoint> MitredEdge(const FrameOpening& opening) {
  const std::vector<Eigen::Vector2d> points = EdgeOf(opening);
  const auto normal = [&](std::size_t i) {
    const Eigen::Vector2d along = (points[i + 1] - points[i]).normalized();
    return Eigen::Vector2d(-along.y(), along.x());
  };
  std::vector<EdgePoint> edge;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d before = normal(i > 0 ? i - 1 : 0);
    const Eigen::Vector2d after = normal(i + 1 < points.size() ? i : i - 1);
    const Eigen::Vector2d outwards = (before + after) / (1 + before.dot(after));
    edge.push_back({points[i] + kInteriorGapM * outwards, outwards});
  }
  return edge;
}

// A profile along the edge: a ring at every point.
std::vector<Ring> AroundOpening(const std::vector<EdgePoint>& edge,
                                const std::vector<Eigen::Vector2d>& profile) {
  std::vector<Ring> rings;
  for (const EdgePoint& point : edge) {
    Ring ring;
    for (const Eigen::Vector2d& p : profile) {
      const Eigen::Vector2d at = point.position_m + p.x() * point.outwards;
      ring.emplace_back(p.y(), at.x(), at.y());
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

// Boxes of the cross-section, each a mitred prism on every side of the opening.
std::vector<TriangleMesh> FrameHulls(const InteriorBody& body, const std::vector<EdgePoint>& edge) {
  const double back = -body.frame.wall_m;
  const double outer = kRevealM + body.frame.casing_width_m;
  const double depth = body.frame.casing_depth_m;
  const double stop = -body.thickness_m - kInteriorGapM;
  const bool arched = edge.size() > 4;
  const std::vector<Rectangle> boxes = {{{0, back}, {kJambM, 0}},
                                        {{-kStopM, stop - kStopLengthM}, {0, stop}},
                                        {{kRevealM, 0}, {outer, depth}},
                                        {{kRevealM, back - depth}, {outer, back}}};
  // an arch is cut into so many prisms that the jamb's keep within the gap around the leaf; stop
  // and casings are nowhere in its way
  const std::vector<std::size_t> fine = {0, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 20};
  const std::vector<std::size_t> coarse = {0, 1, 6, 10, 14, 19, 20};
  const std::vector<std::size_t> straight = {0, 1, 2, 3};
  std::vector<TriangleMesh> hulls;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Rectangle& box = boxes[k];
    const std::vector<Ring> rings = AroundOpening(
        edge,
        {box.min_m, {box.max_m.x(), box.min_m.y()}, box.max_m, {box.min_m.x(), box.max_m.y()}});
    const std::vector<std::size_t>& cuts = !arched ? straight : k == 0 ? fine : coarse;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      std::vector<Eigen::Vector3d> points;
      for (std::size_t at = cuts[i]; at <= cuts[i + 1]; ++at)
        points.insert(points.end(), rings[at].begin(), rings[at].end());
      hulls.push_back(ConvexHull(points));
    }
  }
  return hulls;
}

// Boards on top of the casings, on both sides of the wall.
Solid CapBoards(const InteriorBody& body, const FrameOpening& opening) {
  const double outer = kInteriorGapM + kRevealM + body.frame.casing_width_m;
  const double low = opening.area.max_m.y() + outer;
  const double out = body.frame.casing_depth_m + 0.012;
  const double left = opening.area.min_m.x() - outer - 0.018;
  const double right = opening.area.max_m.x() + outer + 0.018;
  const double back = -body.frame.wall_m;
  const double high = low + body.frame.cap_m;
  return Joined({ChamferedBox({0, left, low}, {out, right, high}, 0.003),
                 ChamferedBox({back - out, left, low}, {back, right, high}, 0.003)});
}

}  // namespace

void CheckInterior(const InteriorBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.59, 0.97);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 1.58, 1.85);
  RequireRange(path, "thickness_m", body.thickness_m, 0.03, 0.055);
  RequireRange(path, "edge_radius_m", body.edge_radius_m, 0.0005, 0.008);
  RequireRange(path + ".frame", "casing_width_m", body.frame.casing_width_m, 0.03, 0.12);
  RequireRange(path + ".frame", "casing_depth_m", body.frame.casing_depth_m, 0.006, 0.025);
  RequireRange(path + ".frame", "wall_m", body.frame.wall_m,
               body.thickness_m + kInteriorGapM + kStopLengthM + 0.002, 0.25);
  RequireRange(path + ".frame", "cap_m", body.frame.cap_m, 0, 0.08);
}

void CheckPanelled(const PanelledBody& body, const std::string& path) {
  CheckInterior(body, path);
  RequireRange(path, "panel_depth_m", body.panel_depth_m, 0.003, 0.35 * body.thickness_m);
  RequireRange(path, "glazed_rows", body.glazed_rows, 0,
               static_cast<double>(body.fields.rows.size()));
  RequireRange(path + ".fields", "stile_width_m", body.fields.stile_width_m, 0.11, 0.2);
}

Rectangle LeafOutline(const InteriorBody& body) {
  return {{0, kInteriorFloorGapM}, {body.leaf_width_m, kInteriorFloorGapM + body.leaf_height_m}};
}

ReliefSlab FlatSlab(const InteriorBody& body, const Rectangle& outline) {
  ReliefSlab slab;
  slab.outline = outline;
  slab.thickness_m = body.thickness_m;
  slab.edge_radius_m = body.edge_radius_m;
  return slab;
}

ReliefSlab PanelledSlab(const PanelledBody& body, const Rectangle& outline,
                        const std::string& path) {
  ReliefSlab slab = FlatSlab(body, outline);
  const double depth = body.panel_depth_m;
  const ReliefProfile profile =
      body.raised ? RaisedPanel(depth, 0.25 * depth, 0.03) : SunkPanel(depth, 0.004);
  const std::vector<Rectangle> fields = FieldsOf(body.fields, slab.outline, path + ".fields");
  const int solid =
      (static_cast<int>(body.fields.rows.size()) - body.glazed_rows) * body.fields.columns;
  for (int i = 0; i < static_cast<int>(fields.size()); ++i) {
    const Rectangle& field = fields[static_cast<std::size_t>(i)];
    if (i >= solid) {
      slab.openings.push_back(field);
      continue;
    }
    const double widest = (field.max_m - field.min_m).minCoeff() / 2;
    RequireRange(path, "half width of a field [m]", widest, profile.back().distance_m + 0.002, 2);
    slab.fields.push_back({field, profile, ReliefSide::kBoth});
  }
  return slab;
}

Solid FrameAround(const InteriorBody& body, const FrameOpening& opening, const std::string& path) {
  const std::vector<Eigen::Vector2d> profile = FrameProfile(body);
  const std::vector<EdgePoint> edge = MitredEdge(opening);
  Solid frame{LoftProfile(AroundOpening(edge, profile), profile), FrameHulls(body, edge)};
  if (body.frame.cap_m <= 0) return frame;
  RequireRange(path + ".frame", "cap_m", body.frame.cap_m, 0.008,
               opening.arch.rise_m > 0 ? 0 : 0.08);
  return Joined({frame, CapBoards(body, opening)});
}

Part InteriorPart(const InteriorBody& body, const FrameOpening& opening, const Solid& leaf,
                  const Solid& fixed, const std::string& path) {
  Part part;
  part.joint = BodyHinge(0);
  const double height = body.leaf_height_m - opening.arch.rise_m;
  const Solid knuckles = HingeKnuckles(part.joint, {0.12 * height, 0.5 * height, 0.88 * height});
  const Solid frame = FrameAround(body, opening, path);
  part.pieces.push_back(MakePiece("frame", Joined({frame, knuckles, fixed}), body.frame.finish,
                                  path + ".frame.finish"));
  part.pieces.push_back(MakePiece("leaf", leaf, body.finish, path + ".finish"));
  part.part_from_mount =
      Translation({0, body.leaf_width_m - kMountToEdgeM, kInteriorFloorGapM + kMountHeightM});
  return part;
}

Part InteriorPart(const InteriorBody& body, const Solid& leaf, const std::string& path) {
  return InteriorPart(body, {LeafOutline(body), {}}, leaf, {}, path);
}

}  // namespace doorforge::internal
