// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels.h"

namespace doorforge::internal {
namespace {

#include "kernel_loops.h"

// Four floats with whatever the compiler's default target offers; works on any processor.
struct Baseline {
  typedef float Vector __attribute__((vector_size(16)));
  typedef std::int32_t Index __attribute__((vector_size(16)));
  typedef float Unaligned __attribute__((vector_size(16), aligned(4), may_alias));
  static constexpr int kWidth = 4;
  static constexpr int kTileRows = 4;

  static Vector Load(const float* p) { return *reinterpret_cast<const Unaligned*>(p); }
  static void Store(float* p, Vector v) { *reinterpret_cast<Unaligned*>(p) = v; }
  static Vector Broadcast(const float* p) { return Vector{} + *p; }
  static Vector MultiplyAdd(Vector a, Vector b, Vector c) { return a * b + c; }
  static float ScalarMultiplyAdd(float a, float b, float c) { return a * b + c; }
  static unsigned Bits(Index mask) {
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
  }
};

}  // namespace

const Kernels kBaselineKernels = MakeKernels<Baseline>("baseline");

}  // namespace doorforge::internal
