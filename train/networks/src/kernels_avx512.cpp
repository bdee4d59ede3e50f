// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Compiled with -mavx512f -mfma; only called after the processor was asked.
#include <immintrin.h>

#include "kernels.h"

namespace doorforge::internal {
namespace {

#include "kernel_loops.h"

struct Avx512 {
  using Vector = __m512;
  typedef std::int32_t Index __attribute__((vector_size(64)));
  static constexpr int kWidth = 16;
  static constexpr int kTileRows = 12;  // 24 sums of 32 registers

  static Vector Load(const float* p) { return _mm512_loadu_ps(p); }
  static void Store(float* p, Vector v) { _mm512_storeu_ps(p, v); }
  static Vector Broadcast(const float* p) { return _mm512_set1_ps(*p); }
  static Vector MultiplyAdd(Vector a, Vector b, Vector c) { return _mm512_fmadd_ps(a, b, c); }
  static float ScalarMultiplyAdd(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
  static unsigned Bits(Index mask) {
    const __m512i lanes = reinterpret_cast<__m512i>(mask);
    return _mm512_test_epi32_mask(lanes, lanes);
  }
};

}  // namespace

const Kernels kAvx512Kernels = MakeKernels<Avx512>("avx512");

}  // namespace doorforge::internal
