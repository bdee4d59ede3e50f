// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels.h"

// The loops themselves, written against a vector type `S` (see kernels_*.cpp):
//   S::Vector    a vector of S::kWidth floats with + - * and comparisons
//   S::Index     a vector of as many 32-bit integers; what a comparison of two vectors gives
//   S::kTileRows rows of a register tile; a tile is kTileRows x 2 vectors
//   Load, Store, Broadcast, MultiplyAdd
//   Bits         of a comparison's Index: bit i is set where lane i is
// Included by each kernels_*.cpp inside an anonymous namespace, with its own compiler flags.

template <class S>
struct Loops {
  using Vector = typename S::Vector;
  static constexpr int kWidth = S::kWidth;
  static constexpr int kPanel = 2 * kWidth;

  // One register tile: M rows of `a` times one panel of `w`.
  template <int M>
  [[gnu::always_inline]] static inline void MultiplyTile(const float* a, std::ptrdiff_t a_stride,
                                                         int depth, const float* w,
                                                         Vector (&sum)[M][2]) {
    for (int k = 0; k < depth; ++k, w += kPanel) {
      const Vector w0 = S::Load(w);
      const Vector w1 = S::Load(w + kWidth);
#pragma GCC unroll 16
      for (int i = 0; i < M; ++i) {
        const Vector x = S::Broadcast(a + i * a_stride + k);
        sum[i][0] = S::MultiplyAdd(x, w0, sum[i][0]);
        sum[i][1] = S::MultiplyAdd(x, w1, sum[i][1]);
      }
    }
  }

  struct ColumnList {
    int count;
    int columns[kMostSparseColumns];
  };

  // Lists the columns that are not zero in all of the first M rows. Their bits are looked at: that
  // -0 counts as something is no fault.
  template <int M>
  static void ListColumns(const Rows& a, ColumnList& used) {
    used.count = 0;
    int k = 0;
    for (; k + kWidth <= a.columns; k += kWidth) {
      typename S::Index any{};
      for (int i = 0; i < M; ++i)
        any |= reinterpret_cast<typename S::Index>(S::Load(a.data + i * a.stride + k));
      any = any != 0;
      int lanes[kWidth];
      __builtin_memcpy(lanes, &any, sizeof lanes);
      for (int lane = 0; lane < kWidth; ++lane) {
        used.columns[used.count] = k + lane;
        used.count -= lanes[lane];  // -1 where there is something
      }
    }
    for (; k < a.columns; ++k) {
      bool any = false;
      for (int i = 0; i < M; ++i) any |= a.data[i * a.stride + k] != 0;
      used.columns[used.count] = k;
      used.count += any ? 1 : 0;
    }
  }

  // The register tile of those columns alone.
  template <int M>
  [[gnu::always_inline]] static inline void MultiplyTile(const float* a, std::ptrdiff_t a_stride,
                                                         const ColumnList& used, const float* w,
                                                         Vector (&sum)[M][2]) {
    for (int n = 0; n < used.count; ++n) {
      const std::ptrdiff_t k = used.columns[n];
      const Vector w0 = S::Load(w + k * kPanel);
      const Vector w1 = S::Load(w + k * kPanel + kWidth);
      const float* column = a + k;
#pragma GCC unroll 16
      for (int i = 0; i < M; ++i) {
        const Vector x = S::Broadcast(column + i * a_stride);
        sum[i][0] = S::MultiplyAdd(x, w0, sum[i][0]);
        sum[i][1] = S::MultiplyAdd(x, w1, sum[i][1]);
      }
    }
  }

  // `depth`: all columns of `a`, or a list of some.
  template <int M, class Depth>
  static void MultiplyRows(const Rows& a, const Depth& depth, const float* w, const float* bias,
                           MutableRows out, bool relu) {
    Vector sum[M][2];
    // unrolled, all loops over the sums leave them in registers
#pragma GCC unroll 16
    for (int i = 0; i < M; ++i) {
      sum[i][0] = bias != nullptr ? S::Load(bias) : Vector{};
      sum[i][1] = bias != nullptr ? S::Load(bias + kWidth) : Vector{};
    }
    MultiplyTile<M>(a.data, a.stride, depth, w, sum);
    const Vector zero{};
#pragma GCC unroll 16
    for (int i = 0; i < M; ++i) {
#pragma GCC unroll 2
      for (int v = 0; v < 2; ++v) {
        const Vector value = relu ? (sum[i][v] > zero ? sum[i][v] : zero) : sum[i][v];
        S::Store(out.data + i * out.stride + v * kWidth, value);
      }
    }
  }

  static Rows Below(const Rows& a, int row) {
    return {a.data + row * a.stride, a.stride, a.rows - row, a.columns};
  }

  static void Multiply(const Rows& a, const Panels& w, const float* bias, MutableRows out,
                       bool relu) {
    for (int column = 0; column < w.columns; column += kPanel) {
      const float* panel = w.data + static_cast<std::ptrdiff_t>(column) * w.depth;
      const float* panel_bias = bias != nullptr ? bias + column : nullptr;
      const auto at = [&](int row) {
        return MutableRows{out.data + row * out.stride + column, out.stride};
      };
      int row = 0;
      for (; row + S::kTileRows <= a.rows; row += S::kTileRows)
        MultiplyRows<S::kTileRows>(Below(a, row), a.columns, panel, panel_bias, at(row), relu);
      for (; row + 4 <= a.rows; row += 4)
        MultiplyRows<4>(Below(a, row), a.columns, panel, panel_bias, at(row), relu);
      for (; row < a.rows; ++row)
        MultiplyRows<1>(Below(a, row), a.columns, panel, panel_bias, at(row), relu);
    }
  }

  // Calls `tile` with the rows from a tile's first on and their columns, each tile once: all panels
  // share a tile's list.
  template <class Tile>
  [[gnu::always_inline]] static inline void ForEachTile(const Rows& a, const Tile& tile) {
    ColumnList used;
    int row = 0;
    for (; row + S::kTileRows <= a.rows; row += S::kTileRows) {
      ListColumns<S::kTileRows>(Below(a, row), used);
      tile.template operator()<S::kTileRows>(row, used);
    }
    for (; row + 4 <= a.rows; row += 4) {
      ListColumns<4>(Below(a, row), used);
      tile.template operator()<4>(row, used);
    }
    for (; row < a.rows; ++row) {
      ListColumns<1>(Below(a, row), used);
      tile.template operator()<1>(row, used);
    }
  }

  static void MultiplySparse(const Rows& a, const Panels& w, const float* bias, MutableRows out,
                             bool relu) {
    if (a.columns > kMostSparseColumns) return Multiply(a, w, bias, out, relu);
    ForEachTile(a, [&]<int M>(int row, const ColumnList& used) {
      for (int column = 0; column < w.columns; column += kPanel)
        MultiplyRows<M>(Below(a, row), used, w.data + static_cast<std::ptrdiff_t>(column) * w.depth,
                        bias != nullptr ? bias + column : nullptr,
                        {out.data + row * out.stride + column, out.stride}, relu);
    });
  }

  // A function of its own, so that the sums get all registers.
  template <int M>
  [[gnu::noinline]] static void MaximumOfRows(const Rows& a, const ColumnList& used, const float* w,
                                              const float* bias, float* best) {
    Vector sum[M][2];
#pragma GCC unroll 16
    for (int i = 0; i < M; ++i) {
      sum[i][0] = S::Load(bias);
      sum[i][1] = S::Load(bias + kWidth);
    }
    MultiplyTile<M>(a.data, a.stride, used, w, sum);
#pragma GCC unroll 2
    for (int v = 0; v < 2; ++v) {
      Vector most = S::Load(best + v * kWidth);
#pragma GCC unroll 16
      for (int i = 0; i < M; ++i) most = sum[i][v] > most ? sum[i][v] : most;
      S::Store(best + v * kWidth, most);
    }
  }

  static void MultiplyMax(const Rows& a, const Panels& w, const float* bias, float* best) {
    for (int column = 0; column < w.columns; column += kWidth) S::Store(best + column, Vector{});
    ForEachTile(a, [&]<int M>(int row, const ColumnList& used) {
      for (int column = 0; column < w.columns; column += kPanel)
        MaximumOfRows<M>(Below(a, row), used,
                         w.data + static_cast<std::ptrdiff_t>(column) * w.depth, bias + column,
                         best + column);
    });
  }

  // M columns of `a` against one panel of columns of `b`, summed over the rows.
  template <int M>
  static void AddOuterTile(const Rows& a, const Rows& b, MutableRows out) {
    Vector sum[M][2];
    for (int i = 0; i < M; ++i) {
      sum[i][0] = S::Load(out.data + i * out.stride);
      sum[i][1] = S::Load(out.data + i * out.stride + kWidth);
    }
    const float* left = a.data;
    const float* right = b.data;
    for (int row = 0; row < a.rows; ++row, left += a.stride, right += b.stride) {
      const Vector b0 = S::Load(right);
      const Vector b1 = S::Load(right + kWidth);
#pragma GCC unroll 16
      for (int i = 0; i < M; ++i) {
        const Vector x = S::Broadcast(left + i);
        sum[i][0] = S::MultiplyAdd(x, b0, sum[i][0]);
        sum[i][1] = S::MultiplyAdd(x, b1, sum[i][1]);
      }
    }
    for (int i = 0; i < M; ++i) {
      S::Store(out.data + i * out.stride, sum[i][0]);
      S::Store(out.data + i * out.stride + kWidth, sum[i][1]);
    }
  }

  static void AddOuter(const Rows& a, const Rows& b, MutableRows out) {
    for (int column = 0; column < b.columns; column += kPanel) {
      const Rows right{b.data + column, b.stride, b.rows, kPanel};
      int i = 0;
      const auto left = [&] { return Rows{a.data + i, a.stride, a.rows, a.columns - i}; };
      const auto at = [&] { return MutableRows{out.data + i * out.stride + column, out.stride}; };
      for (; i + S::kTileRows <= a.columns; i += S::kTileRows)
        AddOuterTile<S::kTileRows>(left(), right, at());
      for (; i + 4 <= a.columns; i += 4) AddOuterTile<4>(left(), right, at());
      for (; i < a.columns; ++i) AddOuterTile<1>(left(), right, at());
    }
  }

  static void ColumnMax(const Rows& a, float* best, std::uint8_t* index) {
    for (int column = 0; column < a.columns; column += kWidth) {
      Vector most = S::Load(a.data + column);
      typename S::Index where{};
      for (int row = 1; row < a.rows; ++row) {
        const Vector value = S::Load(a.data + row * a.stride + column);
        where = value > most ? typename S::Index{} + row : where;
        most = value > most ? value : most;
      }
      S::Store(best + column, most);
      for (int i = 0; i < kWidth; ++i) index[column + i] = static_cast<std::uint8_t>(where[i]);
    }
  }

  static void SubtractRelu(const float* a, const float* b, int count, float* out) {
    const Vector zero{};
    for (int i = 0; i < count; i += kWidth) {
      const Vector value = S::Load(a + i) - S::Load(b + i);
      S::Store(out + i, value > zero ? value : zero);
    }
  }

  static void AddScaled(float factor, const float* x, int count, float* y) {
    const Vector f = S::Broadcast(&factor);
    int i = 0;
    for (; i + kWidth <= count; i += kWidth)
      S::Store(y + i, S::MultiplyAdd(f, S::Load(x + i), S::Load(y + i)));
    for (; i < count; ++i) y[i] = S::ScalarMultiplyAdd(factor, x[i], y[i]);
  }

  static void Mask(const float* activation, int count, float* gradient) {
    const Vector zero{};
    for (int i = 0; i < count; i += kWidth) {
      const Vector value = S::Load(gradient + i);
      S::Store(gradient + i, S::Load(activation + i) > zero ? value : zero);
    }
  }

  static float SquaredDistance(const PointArrays& points, int i, const float* from) {
    const float dx = points.x[i] - from[0];
    const float dy = points.y[i] - from[1];
    const float dz = points.z[i] - from[2];
    return dx * dx + dy * dy + dz * dz;
  }

  [[gnu::always_inline]] static inline Vector SquaredDistances(const PointArrays& points, int i,
                                                               const float* from) {
    const Vector dx = S::Load(points.x + i) - S::Broadcast(from);
    const Vector dy = S::Load(points.y + i) - S::Broadcast(from + 1);
    const Vector dz = S::Load(points.z + i) - S::Broadcast(from + 2);
    return dx * dx + dy * dy + dz * dz;
  }

  static int UpdateNearest(const PointArrays& points, const float* from, float* nearest) {
    Vector most = Vector{} - 1.0F;
    typename S::Index where{};
    int i = 0;
    for (; i + kWidth <= points.count; i += kWidth) {
      const Vector distance = SquaredDistances(points, i, from);
      const Vector before = S::Load(nearest + i);
      const Vector value = distance < before ? distance : before;
      S::Store(nearest + i, value);
      where = value > most ? typename S::Index{} + i : where;
      most = value > most ? value : most;
    }
    float best = -1;
    int index = 0;
    for (int lane = 0; lane < kWidth && i > 0; ++lane) {
      const int candidate = where[lane] + lane;
      if (most[lane] > best || (most[lane] == best && candidate < index)) {
        best = most[lane];
        index = candidate;
      }
    }
    for (; i < points.count; ++i) {
      const float distance = SquaredDistance(points, i, from);
      if (distance < nearest[i]) nearest[i] = distance;
      if (nearest[i] > best) {
        best = nearest[i];
        index = i;
      }
    }
    return index;
  }

  static int FindWithin(const PointArrays& points, const float* from, float radius_2, int limit,
                        std::uint16_t* found) {
    int count = 0;
    int i = 0;
    for (; i + kWidth <= points.count && count < limit; i += kWidth) {
      unsigned inside = S::Bits(SquaredDistances(points, i, from) < Vector{} + radius_2);
      // from one that is inside to the next: which lanes those are no branch can foresee
      for (; inside != 0 && count < limit; inside &= inside - 1)
        found[count++] = static_cast<std::uint16_t>(i + __builtin_ctz(inside));
    }
    for (; i < points.count && count < limit; ++i) {
      if (SquaredDistance(points, i, from) < radius_2)
        found[count++] = static_cast<std::uint16_t>(i);
    }
    return count;
  }
};

template <class S>
constexpr Kernels MakeKernels(const char* name) {
  using L = Loops<S>;
  return {name,           L::kPanel,   L::Multiply,      L::MultiplySparse,
          L::MultiplyMax, L::AddOuter, L::ColumnMax,     L::SubtractRelu,
          L::AddScaled,   L::Mask,     L::UpdateNearest, L::FindWithin};
}
