// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/networks/stage_networks.h"

// Which points of a cloud a grasp may be chosen from. Training and inference ask the same.

namespace doorforge::internal {

/// Ascending.
std::vector<std::size_t> HandlePointsOf(std::span<const std::uint8_t> label);

/// The handle's point nearest to the mean of all of them. The affordance reads clouds that begin
/// there. `points` must not be empty.
std::size_t MiddlePoint(std::span<const float> xyz, std::span<const std::size_t> points);

/// The cloud with point `first` and point 0 in each other's place; its colours likewise.
std::vector<float> BeginningAt(std::span<const float> xyz, std::size_t first);
std::vector<std::uint8_t> BeginningAt(std::span<const std::uint8_t> rgb, std::size_t first);

/// Where the numbers of a grasp are told from: point 0 of the cloud in the frame kHand, else the
/// world's origin.
std::array<float, 3> GraspOrigin(const StageNormalisation& normalisation,
                                 std::span<const float> xyz);

/// The window of a cloud from which a grasp is chosen.
CloudWindow GraspWindow(const StageNormalisation& normalisation, std::span<const float> xyz);

/// The window of a cloud in which a handle's place is sought: all of it, from the mean of its
/// points.
CloudWindow PlaceWindow(std::span<const float> xyz);

/// Those of the points that are surely in the cloud's window.
std::vector<std::size_t> PointsInWindow(std::span<const float> xyz, const CloudWindow& window,
                                        std::span<const std::size_t> points);

}  // namespace doorforge::internal
