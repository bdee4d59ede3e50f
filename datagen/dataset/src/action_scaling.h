// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace doorforge::internal {

/// Numbers of an action: a position, then two rows of a rotation (ActionVector).
inline constexpr std::size_t kActionNumbers = 9;

/// Actions within [-1, 1], as learners with a bounded output want them: component by component,
/// action = offset + scale * scaled, to within the rounding of float.
struct ActionScaling {
  std::array<double, kActionNumbers> scale;
  std::array<double, kActionNumbers> offset;

  /// @param actions T x 9, among those that the scaling was found from.
  /// @returns T x 9 within [-1, 1].
  std::vector<float> Scaled(std::span<const float> actions) const;
};

/// Finds the scaling of many actions.
class ActionRange {
 public:
  void Add(std::span<const float> actions);  ///< T x 9

  /// Positions fill [-1, 1] from their least to their largest, each axis by itself. The rows of a
  /// rotation are unit vectors already, of which a shift would make others: they stay as they are,
  /// or are divided by what rounding put them above 1.
  ActionScaling Scaling() const;

 private:
  static constexpr double kNothing = std::numeric_limits<double>::infinity();
  struct Range {
    double low = kNothing;
    double high = -kNothing;
  };

  std::array<Range, kActionNumbers> ranges_;
};

}  // namespace doorforge::internal
