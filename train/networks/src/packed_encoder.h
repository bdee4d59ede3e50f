// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/parameters.h"
#include "doorforge/networks/point_encoder.h"

#include "kernels.h"

namespace doorforge::internal {

/// Rows that go through the layers of a set abstraction together; they stay in the second cache.
inline constexpr int kBlockRows = 128;

/// One dense layer as the kernels read it.
struct PackedLayer {
  int inputs = 0;
  int outputs = 0;
  std::size_t weight_offset = 0;  ///< In the flat parameter vector.
  std::size_t bias_offset = 0;
  std::vector<float> weight{};  ///< Outputs x inputs, as in the flat vector.
  std::vector<float> bias{};
  std::vector<float> forward{};   ///< Panels of inputs x outputs.
  std::vector<float> backward{};  ///< Panels of outputs x the inputs that pass a gradient on.
  int backward_begin = 0;         ///< First such input.
  int backward_count = 0;         ///< How many, a multiple of 32.

  Panels ForwardPanels() const { return {forward.data(), outputs, inputs}; }
  /// From input `first` on; `panel` as in Kernels.
  Panels ForwardPanels(int first, int panel) const {
    return {forward.data() + static_cast<std::ptrdiff_t>(first) * panel, outputs, inputs};
  }
  Panels BackwardPanels() const { return BackwardPanels(0, backward_count); }
  /// Returns those of `count` of the inputs that pass a gradient on, from `first` on; both
  /// multiples of 32.
  Panels BackwardPanels(int first, int count) const {
    return {backward.data() + static_cast<std::ptrdiff_t>(first) * outputs, count, outputs};
  }
};

struct PackedEncoder {
  const Kernels* kernels = nullptr;
  std::array<std::array<PackedLayer, 3>, 4> abstraction;
  std::array<std::vector<PackedLayer>, 4> propagation;
  PackedLayer head;

  bool reads_colors() const;
  /// Width of a level's point rows, 0 to 4: position and feature.
  int LevelWidth(std::size_t level) const;
};

/// Memory for intermediate rows, not initialised.
inline std::unique_ptr<float[]> Scratch(std::size_t count) {
  return std::make_unique_for_overwrite<float[]>(count);
}

/// A run of consecutive centres whose balls have at most kBlockRows members together.
struct CentreBlock {
  std::size_t first;
  std::size_t last;            ///< One past the end.
  std::uint32_t member_begin;  ///< Into CloudGeometry::Level::member.
  int rows;
};

/// The block that starts at centre `first`.
CentreBlock BlockFrom(const CloudGeometry::Level& level, std::size_t first);

/// Calls body(first row, number of rows) for cache-sized cuts of `rows` rows.
template <class Body>
void ForRowBlocks(int rows, const Body& body) {
  for (int row = 0; row < rows; row += kBlockRows)
    body(row, rows - row < kBlockRows ? rows - row : kBlockRows);
}

/// How many coarser points propagation l interpolates between.
std::size_t CoarsePoints(const CloudGeometry& geometry, std::size_t l);

/// Their features.
Rows CoarseFeatures(const PackedEncoder& encoder, const CloudGeometry& geometry,
                    const PointEncoder::Trace& trace, std::size_t l);

/// Whether propagation l's first layer is computed for the coarser points and interpolated then,
/// not the other way round: where there are far fewer of them. Its first rows in the trace are then
/// the points' own features alone.
bool ProjectsFirst(const CloudGeometry& geometry, std::size_t l);

}  // namespace doorforge::internal
