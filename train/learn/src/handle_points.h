// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Which points of a cloud a grasp may be chosen from. Training and inference ask the same.

namespace doorforge::internal {

/// Ascending.
std::vector<std::size_t> HandlePointsOf(std::span<const std::uint8_t> label);

/// The handle's point nearest to the mean of all of them. The affordance reads clouds that begin
/// there. `points` must not be empty.
std::size_t MiddlePoint(std::span<const float> xyz, std::span<const std::size_t> points);

/// The cloud with point `first` and point 0 in each other's place.
std::vector<float> BeginningAt(std::span<const float> xyz, std::size_t first);

}  // namespace doorforge::internal
