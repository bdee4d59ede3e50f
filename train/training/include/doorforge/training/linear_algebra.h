// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace doorforge {

/// Below this rate libtorch runs on the reference BLAS, which is 20 to 50 times slower.
inline constexpr double kLeastGflops = 20;

/// What libtorch multiplies matrices with on this machine.
struct LinearAlgebra {
  std::string torch_version;
  std::string blas_library;  ///< File that is mapped into this process; empty if not found.
  double gflops = 0;         ///< One thread, 512 x 512 matrices, best of five, processor time.
};

/// Takes 0.1 s with a good BLAS and a second with the reference one.
LinearAlgebra MeasureLinearAlgebra();

/// How to get a BLAS of the right kind on Debian: commands, for people.
std::string LinearAlgebraRemedy();

}  // namespace doorforge
