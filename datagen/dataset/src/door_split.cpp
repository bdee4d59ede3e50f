// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/door_split.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

using Kind = std::pair<std::string, std::string>;  // category, mechanism

// Sets of doors that share parts (disjoint sets with path halving).
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t Find(std::size_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }

  void Join(std::size_t a, std::size_t b) { parent_[Find(a)] = Find(b); }

 private:
  std::vector<std::size_t> parent_;
};

// Doors in the order of their ids, so that the caller's order does not matter.
std::vector<std::size_t> SortedById(std::span<const DoorParts> doors) {
  std::vector<std::size_t> order(doors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return doors[a].door_id < doors[b].door_id; });
  for (std::size_t i = 1; i < order.size(); ++i)
    Require(doors[order[i - 1]].door_id != doors[order[i]].door_id, ErrorCode::kInvalidArgument,
            "door split: two doors are called " + doors[order[i]].door_id);
  return order;
}

void JoinSharers(std::span<const DoorParts> doors, const std::vector<std::size_t>& order,
                 PartIdentity DoorParts::*role, Groups& groups) {
  std::vector<std::size_t> firsts;  // one door for each part that is not listed yet
  for (const std::size_t door : order) {
    const PartIdentity& part = doors[door].*role;
    bool listed = false;
    for (const std::size_t first : firsts) {
      const PartIdentity& known = doors[first].*role;
      if (!part.SameAs(known)) continue;
      groups.Join(door, first);
      listed = listed || (part.id == known.id && part.sha256 == known.sha256);
    }
    if (!listed) firsts.push_back(door);
  }
}

// Groups as lists of doors, by their first door in `order`.
std::vector<std::vector<std::size_t>> ConnectedDoors(std::span<const DoorParts> doors,
                                                     const std::vector<std::size_t>& order) {
  Groups groups(doors.size());
  JoinSharers(doors, order, &DoorParts::body, groups);
  JoinSharers(doors, order, &DoorParts::handle, groups);
  std::map<std::size_t, std::size_t> place;
  std::vector<std::vector<std::size_t>> lists;
  for (const std::size_t door : order) {
    const auto [entry, is_new] = place.emplace(groups.Find(door), lists.size());
    if (is_new) lists.emplace_back();
    lists[entry->second].push_back(door);
  }
  return lists;
}

using Counts = std::map<Kind, double>;

Counts CountKinds(std::span<const DoorParts> doors, const std::vector<std::size_t>& group) {
  Counts counts;
  for (const std::size_t door : group) ++counts[{doors[door].category, doors[door].mechanism}];
  return counts;
}

}  // namespace

std::vector<DoorSide> SplitDoors(std::span<const DoorParts> doors, double val_fraction,
                                 std::uint64_t seed) {
  Require(val_fraction >= 0 && val_fraction <= 0.5, ErrorCode::kInvalidArgument,
          "door split: val_fraction out of 0..0.5");
  const std::vector<std::size_t> order = SortedById(doors);
  std::vector<std::vector<std::size_t>> groups = ConnectedDoors(doors, order);
  Rng rng(seed, "door_split");
  for (std::size_t i = groups.size(); i > 1; --i)
    std::swap(groups[i - 1], groups[rng.Index(static_cast<std::uint32_t>(i))]);

  const Counts all = CountKinds(doors, order);
  Counts validating;
  std::vector<DoorSide> sides(doors.size(), DoorSide::kTrain);
  for (const std::vector<std::size_t>& group : groups) {
    const Counts counts = CountKinds(doors, group);
    const bool fits = std::all_of(counts.begin(), counts.end(), [&](const auto& entry) {
      const auto& [kind, count] = entry;
      return validating[kind] < val_fraction * all.at(kind) &&
             validating[kind] + count <= 0.5 * all.at(kind);
    });
    if (!fits) continue;
    for (const auto& [kind, count] : counts) validating[kind] += count;
    for (const std::size_t door : group) sides[door] = DoorSide::kVal;
  }
  return sides;
}

}  // namespace doorforge
