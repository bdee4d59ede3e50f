// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "doorforge/dataset/door_split.h"

namespace doorforge {

/// Deals numbers 0..count - 1 round by round, each round in an order drawn anew.
class RoundDealer {
 public:
  RoundDealer(std::size_t count, std::uint64_t seed, std::string stream)
      : seed_(seed), stream_(std::move(stream)), order_(count), at_(count) {}
  std::size_t Next();

 private:
  std::uint64_t seed_;
  std::string stream_;
  std::vector<std::size_t> order_;
  std::size_t at_;
  std::uint64_t round_ = 0;
};

/// Draws doors so that no category outweighs another by the number of its doors: see MakePlan().
class BalancedDraw {
 public:
  /// The order of the doors does not matter.
  BalancedDraw(std::span<const DoorParts> doors, std::uint64_t seed);
  std::size_t Next();  ///< Index into the doors.

 private:
  struct Choice {
    std::size_t door;
    std::size_t handle;  ///< Index into Kind::handle_uses.
    std::uint64_t uses = 0;
  };
  /// Doors of one category and mechanism.
  struct Kind {
    RoundDealer dealer;                       ///< It deals bodies.
    std::vector<std::vector<Choice>> bodies;  ///< Its doors, in an order drawn once.
    std::vector<std::uint64_t> handle_uses;
  };
  struct Category {
    RoundDealer dealer;  ///< It deals kinds.
    std::vector<Kind> kinds;
  };

  static Kind KindOf(std::span<const DoorParts> doors, const std::vector<std::size_t>& members,
                     std::uint64_t seed);
  static std::size_t NextOf(Kind& kind);

  std::vector<Category> categories_;
  RoundDealer dealer_;  ///< It deals categories.
};

}  // namespace doorforge
