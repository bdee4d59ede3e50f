// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/separate_pieces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/mesh_transform.h"

#include "convex/convex_region.h"
#include "measure/mesh_pieces.h"
#include "measure/triangle_tree.h"
#include "repair/surface_operations.h"
#include "repair/thicken_sheet.h"

namespace doorforge {
namespace {

// A union takes about a tenth of a millisecond for each pair of triangles that meet.
constexpr std::size_t kFewPairs = 200;   // drawn again for slivers
constexpr std::size_t kFewestDraws = 2;  // of unions of any number of pairs

constexpr std::size_t kTouching = 8;  // pairs that only touch take the time of one that cross

// They hold for the walls that stand for one piece.
SeparationLimits LimitsOfWalls(double half_m) {
  constexpr double kShift = 0.05;  // of half a wall
  return {.shift_m = kShift * half_m, .fill_cavities = true};
}

bool AreWalls(const SeparationLimits& limits) { return limits.half_wall_m == 0; }

struct Meetings {
  std::size_t pairs = 0;  // of triangles
  std::size_t cost = 0;   // of these, those that cross, and what others stand for
  std::set<std::size_t> with_themselves;
  std::vector<std::vector<std::size_t>> groups;  // of pieces that hang together; two at least
};

// Whether the triangle has corners on both sides of the other's plane, farther than `beyond_m`.
bool Straddles(const TriangleMesh& mesh, int triangle, int other, double beyond_m) {
  const auto corner = [&](int t, int k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k])];
  };
  const Eigen::Vector3d& at = corner(other, 0);
  const Eigen::Vector3d normal = (corner(other, 1) - at).cross(corner(other, 2) - at).normalized();
  double lowest = 0, highest = 0;
  for (int k = 0; k < 3; ++k) {
    const double height = normal.dot(corner(triangle, k) - at);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return lowest < -beyond_m && highest > beyond_m;
}

// Boards that are drawn flush touch in many pairs, few of which their union has to cut; the walls
// of one piece are cut wherever they meet, and of them all pairs count as crossing.
Meetings MeetingsOf(const std::vector<TriangleMesh>& pieces, const SeparationLimits& limits) {
  std::vector<std::size_t> piece_of;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    piece_of.insert(piece_of.end(), pieces[i].triangles.size(), i);
  std::vector<std::size_t> root(pieces.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  Meetings meetings;
  const TriangleMesh merged = Merged(pieces);
  std::size_t touching = 0;
  for (const auto& [s, t] : CrossingTriangles(merged)) {
    const bool crosses = AreWalls(limits) || (Straddles(merged, s, t, limits.shift_m) &&
                                              Straddles(merged, t, s, limits.shift_m));
    ++meetings.pairs;
    touching += !crosses;
    const std::size_t a = piece_of[static_cast<std::size_t>(s)];
    const std::size_t b = piece_of[static_cast<std::size_t>(t)];
    if (a == b) meetings.with_themselves.insert(a);
    const std::size_t root_a = root_of(a);
    const std::size_t root_b = root_of(b);
    root[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }
  meetings.cost = meetings.pairs - touching + (touching + kTouching - 1) / kTouching;
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < pieces.size(); ++i) members[root_of(i)].push_back(i);
  for (auto& [first, group] : members) {
    if (group.size() > 1) meetings.groups.push_back(std::move(group));
  }
  return meetings;
}

// A cavity and the smallest piece around it are one solid.
void JoinCavities(std::vector<TriangleMesh>& pieces) {
  std::vector<TriangleMesh> cavities;
  std::erase_if(pieces, [&](const TriangleMesh& piece) {
    if (VolumeOf(piece) >= 0) return false;
    cavities.push_back(piece);
    return true;
  });
  for (const TriangleMesh& cavity : cavities) {
    TriangleMesh* around = nullptr;
    for (TriangleMesh& piece : pieces) {
      if (TriangleTree(piece).WindingNumber(cavity.vertices[0]) < 0.5) continue;
      if (around == nullptr || VolumeOf(piece) < VolumeOf(*around)) around = &piece;
    }
    if (around == nullptr)
      pieces.push_back(cavity);
    else
      *around = Merged(std::array{*around, cavity});
  }
}

// Moves sheets of one surface apart that touch or barely cross.
std::optional<TriangleMesh> Untangled(const TriangleMesh& piece, double shift_m) {
  for (const double way : {-1.0, 1.0, -5.0, 5.0}) {
    TriangleMesh moved = Offset(piece, way * shift_m);
    if (!SelfIntersects(moved)) return moved;
  }
  return std::nullopt;
}

// A wall as thick as it can be without crossing itself.
std::optional<TriangleMesh> SimpleWallOf(const TriangleMesh& sheet, double half_m) {
  for (const double share : {1.0, 0.25, 0.06}) {
    TriangleMesh wall = Thickened(sheet, share * half_m);
    if (ClosedMesh::From(wall) && !SelfIntersects(wall)) return wall;
  }
  return std::nullopt;
}

// Walls of the surface's patches, and of their patches where one makes no simple wall. False where
// there would be too many.
bool AddWalls(const TriangleMesh& surface, double half_m, std::vector<TriangleMesh>& walls) {
  constexpr std::size_t kMostWalls = 250;
  constexpr std::size_t kMostTriangles = 4000;  // a wrap is quicker
  if (surface.triangles.size() > kMostTriangles) return false;
  for (const TriangleMesh& patch : Patches(surface)) {
    if (walls.size() >= kMostWalls) return false;
    if (IsNeedle(patch, half_m)) continue;
    std::optional<TriangleMesh> wall = SimpleWallOf(patch, half_m);
    if (wall)
      walls.push_back(*std::move(wall));
    else if (patch.triangles.size() == surface.triangles.size() || !AddWalls(patch, half_m, walls))
      return false;
  }
  return true;
}

// Walls of the surface's patches; none where there would be too many.
std::vector<TriangleMesh> WallsOfPatches(const TriangleMesh& surface, double half_m) {
  std::vector<TriangleMesh> walls;
  if (!AddWalls(surface, half_m, walls)) walls.clear();
  return walls;
}

// Walls that stand for one surface, and where they meet.
struct MeetingWalls {
  std::vector<TriangleMesh> walls;
  Meetings meetings;
};

MeetingWalls MeetingWallsOf(const TriangleMesh& surface, double half_m) {
  MeetingWalls found = {.walls = WallsOfPatches(surface, half_m), .meetings = {}};
  found.meetings = MeetingsOf(found.walls, LimitsOfWalls(half_m));
  return found;
}

TriangleMesh WithoutCavities(const TriangleMesh& solid) {
  std::vector<TriangleMesh> shells = PiecesOf(solid);
  std::erase_if(shells, [](const TriangleMesh& shell) { return VolumeOf(shell) < 0; });
  return Merged(shells);
}

// Whether it stays closed, and each triangle keeps an area, at the precision of mesh files.
bool SurvivesFiles(const TriangleMesh& mesh) {
  const TriangleMesh rounded = RoundedToFloat(mesh);
  return ClosedMesh::From(rounded) && MeasureTopology(rounded).degenerate_triangles == 0;
}

// How the solids of one union are moved, one way after the other, until one leaves a simple
// surface. Pieces, which are mostly boards, are first moved without turning them. All draws
// together have no more pairs than a union may have, but two may have more; the last of few is one
// that moves them farther.
std::vector<Nudge> WaysToMove(const SeparationLimits& limits, std::size_t draws, int attempt) {
  constexpr int kTurned = 6;
  const auto seed = static_cast<std::uint64_t>(kTurned * attempt);
  std::vector<Nudge> ways;
  if (!AreWalls(limits)) ways.push_back({.shift_m = limits.shift_m, .turns = false, .seed = seed});
  for (int i = 0; i < kTurned; ++i) {
    ways.push_back({.shift_m = (1 + 0.5 * i) * limits.shift_m,
                    .turns = true,
                    .seed = seed + static_cast<std::uint64_t>(i)});
  }
  if (draws >= ways.size()) return ways;
  const Nudge far = ways[ways.size() - 2];
  ways.resize(std::max(draws, kFewestDraws));
  ways.back() = far;
  return ways;
}

// How many times solids may be united whose triangles meet in so many pairs. Those that meet none
// are copied, reduced and looked through for crossings, which of many takes more time than the
// pairs do.
std::size_t DrawsOf(const std::vector<TriangleMesh>& solids, std::size_t pairs,
                    std::size_t in_all_draws) {
  std::size_t triangles = 0;
  for (const TriangleMesh& solid : solids) triangles += solid.triangles.size();
  constexpr std::size_t kWithTriangles = 3;  // times as many, where triangles count too
  return std::min(in_all_draws / pairs, kWithTriangles * in_all_draws / (pairs + triangles));
}

// Where faces nearly coincide, a union has slivers, which cross each other by rounding; most vanish
// when what costs less than the shift is collapsed. Those that files would flatten are worth
// another draw where that takes little. Where each draw leaves some that cross, those of the last
// are drawn anew one by one; not of the first, of which a rim may be so torn that what walls
// enclose is no cavity any more.
std::optional<TriangleMesh> SimpleUnion(const std::vector<TriangleMesh>& solids,
                                        const SeparationLimits& limits, std::size_t pairs,
                                        std::size_t in_all_draws, int attempt) {
  const std::vector<Nudge> ways = WaysToMove(limits, DrawsOf(solids, pairs, in_all_draws), attempt);
  // a wrap is quicker where these do not unite at once, or cross then
  const bool are_many_walls = AreWalls(limits) && kFewestDraws * pairs > in_all_draws;
  std::optional<TriangleMesh> flattened, crossing;
  for (const Nudge& way : ways) {
    const std::optional<TriangleMesh> whole = United(solids, way);
    if (!whole && are_many_walls) break;
    if (!whole) continue;
    const TriangleMesh simple = WithoutSlivers(*whole, 0.5 * limits.shift_m);
    for (const TriangleMesh& mesh : {simple, *whole}) {
      if (!ClosedMesh::From(mesh)) continue;
      // of two that files would flatten the first is kept
      const bool survives = SurvivesFiles(mesh);
      if ((!survives && flattened) || SelfIntersects(mesh)) continue;
      if (survives) return mesh;
      flattened = mesh;
    }
    if (flattened && pairs > kFewPairs) break;
    if (ClosedMesh::From(simple)) crossing = simple;
  }
  if (flattened || !crossing || are_many_walls) return flattened;
  return WithCrossingsMended(*crossing);
}

// Puts the union of each group in the place of its first member. False where there is none.
bool Unite(std::vector<TriangleMesh>& pieces, const Meetings& meetings,
           const SeparationLimits& limits, std::size_t in_all_draws, int attempt) {
  std::vector<char> gone(pieces.size(), 0);
  for (const std::vector<std::size_t>& group : meetings.groups) {
    std::vector<TriangleMesh> members;
    for (const std::size_t i : group) {
      members.push_back(std::move(pieces[i]));
      gone[i] = i != group.front();
    }
    std::optional<TriangleMesh> whole =
        SimpleUnion(members, limits, meetings.pairs, in_all_draws, attempt);
    if (!whole) return false;
    pieces[group.front()] = limits.fill_cavities ? WithoutCavities(*whole) : *std::move(whole);
  }
  std::size_t index = 0;
  std::erase_if(pieces, [&](const TriangleMesh&) { return gone[index++] != 0; });
  return true;
}

// Unites solids, none of which is a cavity, as they meet.
Separation SeparatedOf(std::vector<TriangleMesh> pieces, Meetings meetings,
                       const SeparationLimits& limits, PairBudget& pairs) {
  constexpr int kGrowthRounds = 4;  // growing pieces may make them meet others
  Separation separation;
  const std::size_t before = pieces.size();
  for (int round = 0; round < kGrowthRounds; ++round) {
    if (meetings.groups.empty() && meetings.with_themselves.empty()) {
      separation.united = static_cast<int>(before - pieces.size());
      separation.solids = std::move(pieces);
      return separation;
    }
    if (!pairs.Take(meetings.cost)) {
      separation.problem = std::to_string(meetings.cost) +
                           " pairs of triangles meet, more than are left of max_pairs, which is " +
                           std::to_string(pairs.allowed());
      return separation;
    }
    std::vector<const TriangleMesh*> tangled;
    for (const std::size_t i : meetings.with_themselves) tangled.push_back(&pieces[i]);
    Untangling untangling = WithoutOwnCrossings(tangled, limits, pairs);
    if (untangling.pieces.size() < tangled.size()) {
      separation.problem = std::move(untangling.problem);
      return separation;
    }
    auto moved = untangling.pieces.begin();
    for (const std::size_t i : meetings.with_themselves) pieces[i] = std::move(*moved++);
    separation.untangled += static_cast<int>(tangled.size());
    if (!Unite(pieces, meetings, limits, pairs.in_all_draws(), round)) {
      separation.problem = std::to_string(before) + " pieces that meet have no simple union";
      return separation;
    }
    // one is free of crossings already
    meetings = pieces.size() > 1 ? MeetingsOf(pieces, limits) : Meetings();
  }
  separation.problem = "pieces still cross after they were united";
  return separation;
}

std::optional<TriangleMesh> UnionOf(MeetingWalls found, double half_m, PairBudget& pairs) {
  if (found.walls.empty()) return std::nullopt;
  const Separation separation =
      SeparatedOf(std::move(found.walls), std::move(found.meetings), LimitsOfWalls(half_m), pairs);
  if (separation.solids.empty()) return std::nullopt;
  return Merged(separation.solids);
}

}  // namespace

bool IsNeedle(const TriangleMesh& patch, double half_m) {
  constexpr double kNarrow = 1e-3;  // of half the wall
  const MeshTopology topology = MeasureTopology(patch);
  return !(2 * topology.area_m2 > kNarrow * half_m * topology.bounds.diagonal().norm());
}

std::optional<TriangleMesh> WallsOf(const TriangleMesh& surface, double half_m, PairBudget& pairs) {
  if (MeasureTopology(surface).boundary_edges > 0) {
    if (std::optional<TriangleMesh> wall = SimpleWallOf(surface, half_m)) return wall;
  }
  return UnionOf(MeetingWallsOf(surface, half_m), half_m, pairs);
}

Untangling WithoutOwnCrossings(const std::vector<const TriangleMesh*>& pieces,
                               const SeparationLimits& limits, PairBudget& pairs) {
  const double half_m = limits.half_wall_m;
  std::vector<std::optional<TriangleMesh>> moved;
  std::vector<MeetingWalls> walls(pieces.size());  // of those that are not moved
  std::size_t needed = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    moved.push_back(Untangled(*pieces[i], limits.shift_m));
    if (moved.back() || half_m == 0) continue;
    walls[i] = MeetingWallsOf(*pieces[i], half_m);
    if (pieces.size() > 1) needed += walls[i].meetings.cost;
  }
  Untangling untangling;
  if (needed > pairs.left()) {
    untangling.problem = "walls of pieces that cross themselves meet in " + std::to_string(needed) +
                         " pairs of triangles, more than are left of " + "max_pairs, which is " +
                         std::to_string(pairs.allowed());
    return untangling;
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!moved[i]) moved[i] = UnionOf(std::move(walls[i]), half_m, pairs);
    if (!moved[i]) {
      untangling.problem =
          "a piece of " + std::to_string(pieces[i]->triangles.size()) + " triangles crosses itself";
      return untangling;
    }
    untangling.pieces.push_back(*std::move(moved[i]));
  }
  return untangling;
}

Separation Separated(std::vector<TriangleMesh> pieces, const SeparationLimits& limits,
                     PairBudget& pairs) {
  JoinCavities(pieces);
  Meetings meetings = MeetingsOf(pieces, limits);
  return SeparatedOf(std::move(pieces), std::move(meetings), limits, pairs);
}

}  // namespace doorforge
