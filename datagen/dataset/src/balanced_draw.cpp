// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "balanced_draw.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

template <class T>
void Shuffle(std::vector<T>& items, Rng rng) {
  for (std::size_t i = items.size(); i > 1; --i)
    std::swap(items[i - 1], items[rng.Index(static_cast<std::uint32_t>(i))]);
}

using Members = std::vector<std::size_t>;  // doors, by id

// Category, then mechanism; maps keep them in the order of their names.
std::map<std::string, std::map<std::string, Members>> Sorted(std::span<const DoorParts> doors) {
  Members order(doors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return doors[a].door_id < doors[b].door_id; });
  std::map<std::string, std::map<std::string, Members>> sorted;
  for (const std::size_t door : order)
    sorted[doors[door].category][doors[door].mechanism].push_back(door);
  return sorted;
}

}  // namespace

std::size_t RoundDealer::Next() {
  if (at_ == order_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    Shuffle(order_, Rng(seed_, "plan/" + stream_ + "/" + std::to_string(round_++)));
    at_ = 0;
  }
  return order_[at_++];
}

BalancedDraw::BalancedDraw(std::span<const DoorParts> doors, std::uint64_t seed)
    : dealer_(0, seed, "") {
  for (const auto& [category, kinds] : Sorted(doors)) {
    Category entry{RoundDealer(kinds.size(), seed, category), {}};
    for (const auto& [mechanism, members] : kinds)
      entry.kinds.push_back(KindOf(doors, members, seed));
    categories_.push_back(std::move(entry));
  }
  dealer_ = RoundDealer(categories_.size(), seed, "categories");
}

BalancedDraw::Kind BalancedDraw::KindOf(std::span<const DoorParts> doors, const Members& members,
                                        std::uint64_t seed) {
  const DoorParts& first = doors[members.front()];
  const std::string stream = first.category + "/" + first.mechanism;
  std::map<std::string, std::size_t> handles;
  std::map<std::string, std::vector<Choice>> bodies;
  for (const std::size_t door : members) {
    const auto [handle, is_new] = handles.emplace(doors[door].handle.id, handles.size());
    bodies[doors[door].body.id].push_back({door, handle->second});
  }
  Kind kind{
      RoundDealer(bodies.size(), seed, stream), {}, std::vector<std::uint64_t>(handles.size())};
  for (auto& [body, choices] : bodies) {
    Shuffle(choices, Rng(seed, "plan/" + stream + "/" + body));
    kind.bodies.push_back(std::move(choices));
  }
  return kind;
}

// The body's door with the handle that was used least; of several the one that was opened least.
std::size_t BalancedDraw::NextOf(Kind& kind) {
  std::vector<Choice>& choices = kind.bodies[kind.dealer.Next()];
  const auto least =
      std::min_element(choices.begin(), choices.end(), [&](const Choice& a, const Choice& b) {
        return std::tuple(kind.handle_uses[a.handle], a.uses) <
               std::tuple(kind.handle_uses[b.handle], b.uses);
      });
  ++kind.handle_uses[least->handle];
  ++least->uses;
  return least->door;
}

std::size_t BalancedDraw::Next() {
  Category& category = categories_[dealer_.Next()];
  return NextOf(category.kinds[category.dealer.Next()]);
}

}  // namespace doorforge
