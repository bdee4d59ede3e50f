// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/mesh/convex_parts.h"

#include "interior/interior_body.h"

namespace doorforge::internal {
namespace {

/// What follows the arch.
enum class ArchedPart {
  kHead,    ///< Leaf and frame do.
  kFields,  ///< The top fields do, within a rectangular leaf.
};
inline constexpr NamedValue<ArchedPart> kArchedPartWords[] = {{ArchedPart::kHead, "head"},
                                                              {ArchedPart::kFields, "fields"}};
constexpr std::span<const NamedValue<ArchedPart>> ValuesOf(ArchedPart) { return kArchedPartWords; }

struct ArchedBody : PanelledBody {
  double rise_m = 0.1;  ///< The arch rises so far over the leaf's width.
  ArchedPart arch = ArchedPart::kHead;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    PanelledBody::VisitFields(self, visit);
    visit("rise_m", self.rise_m);
    visit("arch", self.arch);
  }
};

/// The leaf that stays.
enum class FixedLeaf {
  kLeaf,   ///< It looks as the moving one.
  kLight,  ///< It has one column of openings.
};
inline constexpr NamedValue<FixedLeaf> kFixedLeafWords[] = {{FixedLeaf::kLeaf, "leaf"},
                                                            {FixedLeaf::kLight, "light"}};
constexpr std::span<const NamedValue<FixedLeaf>> ValuesOf(FixedLeaf) { return kFixedLeafWords; }

struct DoubleBody : PanelledBody {
  double fixed_width_m = 0.6;  ///< The leaf beside the moving one has it.
  FixedLeaf fixed = FixedLeaf::kLeaf;
  int fixed_rows = 1;  ///< Openings of a light.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    PanelledBody::VisitFields(self, visit);
    visit("fixed_width_m", self.fixed_width_m);
    visit("fixed", self.fixed);
    visit("fixed_rows", self.fixed_rows);
  }
};

struct LouvredBody : PanelledBody {
  int louvred_rows = 1;    ///< So many rows of fields from the top hold slats.
  double pitch_m = 0.04;   ///< From slat to slat.
  double slat_m = 0.007;   ///< Thickness of a slat.
  double slope_rad = 0.9;  ///< The slats lean so far from the horizontal, down to the front.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    PanelledBody::VisitFields(self, visit);
    visit("louvred_rows", self.louvred_rows);
    visit("pitch_m", self.pitch_m);
    visit("slat_m", self.slat_m);
    visit("slope_rad", self.slope_rad);
  }
};

/// Lowers a slab's upper part so that level lines become arches: nothing below `from_m`, the whole
/// drop at `full_m`, and `at_top` of it at the top edge.
struct ArchBend {
  Arch arch;
  double from_m;
  double full_m;
  double top_m;
  double at_top;

  double ShareAt(double z_m) const {
    if (z_m <= from_m) return 0;
    if (z_m <= full_m) return (z_m - from_m) / (full_m - from_m);
    return 1 + (at_top - 1) * (z_m - full_m) / (top_m - full_m);
  }

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    return {p.x(), p.y(), p.z() - ShareAt(p.z()) * arch.DropAt(p.y())};
  }
};

// A box as the bend leaves it, cut into strips so narrow that no strip's hull fills more than
// `tolerance_m` of what an arch leaves open below.
std::vector<TriangleMesh> BentBox(const TriangleMesh& box, const ArchBend& bend,
                                  double tolerance_m) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : box.vertices) bounds.extend(vertex);
  const Eigen::Vector3d low = bounds.min();
  const Eigen::Vector3d high = bounds.max();
  if (high.z() <= bend.from_m) return {box};
  const double share = bend.ShareAt(low.z());
  const double width = high.y() - low.y();
  const double sag = share * bend.arch.rise_m * std::pow(width / bend.arch.half_width_m / 2, 2);
  const int strips = std::max(1, static_cast<int>(std::ceil(std::sqrt(sag / tolerance_m))));
  std::vector<TriangleMesh> hulls;
  for (int i = 0; i < strips; ++i) {
    const int steps = strips == 1 ? 12 : 4;
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k <= steps; ++k) {
      const double y = low.y() + width * (i + static_cast<double>(k) / steps) / strips;
      for (const double x : {low.x(), high.x()}) {
        for (const double z : {low.z(), high.z()}) points.push_back(bend({x, y, z}));
      }
    }
    hulls.push_back(ConvexHull(points));
  }
  return hulls;
}

Solid Bent(const Solid& solid, const ArchBend& bend) {
  constexpr double kToleranceM = 0.006;
  Solid bent{solid.mesh, {}};
  for (Eigen::Vector3d& vertex : bent.mesh.vertices) vertex = bend(vertex);
  for (const TriangleMesh& box : solid.hulls) {
    const std::vector<TriangleMesh> hulls = BentBox(box, bend, kToleranceM);
    bent.hulls.insert(bent.hulls.end(), hulls.begin(), hulls.end());
  }
  return bent;
}

Part BuildArched(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ArchedBody>(json, path);
  CheckPanelled(body, path);
  RequireRange(path, "rise_m", body.rise_m, 0.03, 0.2);
  const bool head = body.arch == ArchedPart::kHead;
  ReliefSlab slab = PanelledSlab(body, LeafOutline(body), path);
  const double top = slab.outline.max_m.y();
  const double full = top - body.fields.top_rail_m;
  double from = full;
  const auto lowest = [&](const Rectangle& field) {
    if (field.max_m.y() > full - 1e-6) from = field.min_m.y();
  };
  for (const ReliefField& field : slab.fields) lowest(field.area);
  for (const Rectangle& opening : slab.openings) lowest(opening);
  // straight sides where the top fields begin; the bend has to end above their lower mouldings
  from += 0.4 * (full - from);
  RequireRange(path, "height of the top fields' upper part [m]", full - from, 1.5 * body.rise_m, 2);
  const Arch arch{body.leaf_width_m / 2, body.leaf_width_m / 2, body.rise_m};
  for (int i = 1; i < 18; ++i) slab.extra_cuts_m[0].push_back(body.leaf_width_m * i / 18);
  slab.extra_cuts_m[1] = {from, full};
  const Solid leaf =
      Bent(ReliefSolid(slab, kInteriorHullToleranceM), {arch, from, full, top, head ? 1.0 : 0.0});
  return InteriorPart(body, {slab.outline, head ? arch : Arch{}}, leaf, {}, path);
}

// The leaf that stays: beside the moving one's free edge.
ReliefSlab FixedSlab(const DoubleBody& body, const std::string& path) {
  Rectangle outline = LeafOutline(body);
  outline.min_m.x() = body.leaf_width_m + kInteriorGapM;
  outline.max_m.x() = outline.min_m.x() + body.fixed_width_m;
  if (body.fixed == FixedLeaf::kLeaf) return PanelledSlab(body, outline, path);
  RequireRange(path, "fixed_rows", body.fixed_rows, 1, 6);
  ReliefSlab slab = FlatSlab(body, outline);
  FieldGrid lights = body.fields;
  lights.columns = 1;
  lights.stile_width_m = 0.07;
  lights.bar_width_m = 0.04;
  lights.rows.assign(static_cast<std::size_t>(body.fixed_rows), 1.0);
  slab.openings = FieldsOf(lights, outline, path);
  return slab;
}

Part BuildDouble(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<DoubleBody>(json, path);
  CheckPanelled(body, path);
  RequireRange(path, "fixed_width_m", body.fixed_width_m, 0.22, 0.8);
  const ReliefSlab leaf = PanelledSlab(body, LeafOutline(body), path);
  const ReliefSlab fixed = FixedSlab(body, path);
  constexpr double kFixedHullToleranceM = 0.012;
  return InteriorPart(body, {{leaf.outline.min_m, fixed.outline.max_m}, {}},
                      ReliefSolid(leaf, kInteriorHullToleranceM),
                      ReliefSolid(fixed, kFixedHullToleranceM), path);
}

// One slat across an opening, with chamfered edges; its middle at height z.
Solid Slat(const LouvredBody& body, const Rectangle& opening, double z) {
  const double half = body.slat_m / 2;
  // as deep as the leaf less a little, so that the slats lie within its faces
  const double reach =
      (body.thickness_m / 2 - 0.003 - half * std::sin(body.slope_rad)) / std::cos(body.slope_rad);
  const Eigen::Vector2d along(std::cos(body.slope_rad), -std::sin(body.slope_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d center(-body.thickness_m / 2, z);
  Ring ends[2];
  for (const Eigen::Vector2d& p : RoundedRectangle({reach, half}, 0.3 * half, 1)) {
    const Eigen::Vector2d at = center + p.x() * along + p.y() * across;
    ends[0].emplace_back(at.x(), opening.max_m.x(), at.y());
    ends[1].emplace_back(at.x(), opening.min_m.x(), at.y());
  }
  return {Loft({ends[0], ends[1]}), {}};
}

// The slats of one opening: one hull stands for all, since nothing passes between them.
Solid Slats(const LouvredBody& body, const Rectangle& opening, const std::string& path) {
  const double height = opening.max_m.y() - opening.min_m.y();
  const double rise = (body.thickness_m - 0.006) * std::tan(body.slope_rad) / 2;
  const double margin = rise + 0.004;
  const int count = static_cast<int>((height - 2 * margin) / body.pitch_m) + 1;
  RequireRange(path, "slats of a field", count, 3, 60);
  const double pitch = (height - 2 * margin) / (count - 1);
  std::vector<Solid> slats;
  for (int i = 0; i < count; ++i)
    slats.push_back(Slat(body, opening, opening.min_m.y() + margin + i * pitch));
  Solid all = Joined(slats);
  all.hulls = {ConvexHull(all.mesh.vertices)};
  return all;
}

Part BuildLouvred(const nlohmann::ordered_json& json, const std::string& path) {
  auto body = ReadParameters<LouvredBody>(json, path);
  RequireRange(path, "louvred_rows", body.louvred_rows, 1,
               static_cast<double>(body.fields.rows.size()));
  RequireRange(path, "glazed_rows", body.glazed_rows, 0, 0);
  body.glazed_rows = body.louvred_rows;
  CheckPanelled(body, path);
  RequireRange(path, "slope_rad", body.slope_rad, 0.5, 1.0);
  RequireRange(path, "slat_m", body.slat_m, 0.004, 0.012);
  // neighbours overlap as seen along x
  RequireRange(path, "pitch_m", body.pitch_m, 0.02,
               std::min(0.045, (body.thickness_m - 0.006) * std::tan(body.slope_rad)));
  const ReliefSlab slab = PanelledSlab(body, LeafOutline(body), path);
  std::vector<Solid> solids = {ReliefSolid(slab, kInteriorHullToleranceM)};
  for (const Rectangle& opening : slab.openings) solids.push_back(Slats(body, opening, path));
  return InteriorPart(body, Joined(solids), path);
}

}  // namespace

std::span<const Family> InteriorShapedBodyFamilies() {
  static const Family kFamilies[] = {
      {"interior_arched", PartRole::kBody, Mechanism::kNone, BuildArched},
      {"interior_double", PartRole::kBody, Mechanism::kNone, BuildDouble},
      {"interior_louvred", PartRole::kBody, Mechanism::kNone, BuildLouvred},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
