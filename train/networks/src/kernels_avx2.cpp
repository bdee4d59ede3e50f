// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Compiled with -mavx2 -mfma; only called after the processor was asked.
#include <immintrin.h>

#include "kernels.h"

namespace doorforge::internal {
namespace {

#include "kernel_loops.h"

struct Avx2 {
  using Vector = __m256;
  typedef std::int32_t Index __attribute__((vector_size(32)));
  static constexpr int kWidth = 8;
  static constexpr int kTileRows = 6;  // 12 sums, 2 weights and a broadcast fill 16 registers

  static Vector Load(const float* p) { return _mm256_loadu_ps(p); }
  static void Store(float* p, Vector v) { _mm256_storeu_ps(p, v); }
  static Vector Broadcast(const float* p) { return _mm256_broadcast_ss(p); }
  static Vector MultiplyAdd(Vector a, Vector b, Vector c) { return _mm256_fmadd_ps(a, b, c); }
  static float ScalarMultiplyAdd(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
  static unsigned Bits(Index mask) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
  }
};

}  // namespace

const Kernels kAvx2Kernels = MakeKernels<Avx2>("avx2");

}  // namespace doorforge::internal
