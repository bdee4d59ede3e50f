// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// The inner loops of the encoder, compiled once per instruction set. This header and the kernel
// sources use raw pointers and no inline function of any library on purpose: an inline function
// compiled for a newer processor must never be the copy that the linker keeps for all.

namespace doorforge::internal {

/// A row-major matrix; row i begins at data + i * stride.
struct Rows {
  const float* data;
  std::ptrdiff_t stride;
  int rows;
  int columns;
};

struct MutableRows {
  float* data;
  std::ptrdiff_t stride;
};

/// A matrix cut into panels of Kernels::panel columns, each panel row by row. Of its rows from
/// `data` on, a product takes as many as the left matrix has columns.
struct Panels {
  const float* data;
  int columns;  ///< A multiple of Kernels::panel.
  int depth;    ///< Rows of a whole panel: the next one begins depth x panel further on.
};

/// Points as three arrays of `count` floats.
struct PointArrays {
  const float* x;
  const float* y;
  const float* z;
  int count;
};

/// Columns of the left matrix up to which zeros are left out.
constexpr int kMostSparseColumns = 256;

struct Kernels {
  const char* name;
  int panel;  ///< Columns that a register tile covers.

  /// out = a * w + bias (bias may be null), with negative values set to 0 if `relu`.
  /// Every output is summed in the order of a's columns.
  void (*multiply)(const Rows& a, const Panels& w, const float* bias, MutableRows out, bool relu);
  /// Gives what multiply gives, for an `a` of which much is zero, as of what a rectified layer
  /// made: columns that are zero in all rows of a register tile are left out, which changes no sum
  /// of finite numbers. Rows that are alike should lie together.
  void (*multiply_sparse)(const Rows& a, const Panels& w, const float* bias, MutableRows out,
                          bool relu);
  /// best[j] = max over rows of max((a * w + bias)[row][j], 0), each output summed as by
  /// multiply_sparse.
  void (*multiply_max)(const Rows& a, const Panels& w, const float* bias, float* best);
  /// out[i][j] += sum over rows r of a[r][i] * b[r][j], in the order of rows. b's columns are a
  /// multiple of `panel`.
  void (*add_outer)(const Rows& a, const Rows& b, MutableRows out);
  /// best[j] = max over rows of a[r][j], index[j] = the first such row. Columns as in add_outer.
  void (*column_max)(const Rows& a, float* best, std::uint8_t* index);
  /// out = max(a - b, 0).
  void (*subtract_relu)(const float* a, const float* b, int count, float* out);
  /// y += factor * x.
  void (*add_scaled)(float factor, const float* x, int count, float* y);
  /// gradient[i] = 0 where activation[i] <= 0.
  void (*mask)(const float* activation, int count, float* gradient);
  /// nearest[i] = min(nearest[i], squared distance of point i to `from`); returns the lowest index
  /// of the largest nearest[i]. Multiplies and adds are not fused, so that all instruction sets
  /// agree in every tie.
  int (*update_nearest)(const PointArrays& points, const float* from, float* nearest);
  /// Lowest indices, at most `limit`, of the points with squared distance to `from` < radius_2;
  /// returns how many.
  int (*find_within)(const PointArrays& points, const float* from, float radius_2, int limit,
                     std::uint16_t* found);
};

extern const Kernels kBaselineKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace doorforge::internal
