// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/instruction_set.h"
#include "doorforge/networks/parameters.h"

namespace doorforge {

namespace internal {
class DenseLayers;
}  // namespace internal

/// Sizes of a small network: dense layers with tanh between them.
struct MlpShape {
  int inputs = 1;
  int hidden = 64;
  int outputs = 1;

  bool operator==(const MlpShape&) const = default;
};

/// Its layers "0" and "1" (hidden) and "2" (outputs).
ParameterLayout MlpLayout(const MlpShape& shape);

/// Weights to begin with: normal with variance 1 / inputs, those of the last layer times
/// `last_scale`, biases 0; drawn from the streams "init/<prefix><layer>" of `seed`.
std::vector<float> MlpInitialisation(const MlpShape& shape, std::uint64_t seed,
                                     const std::string& prefix, float last_scale);

/// Computes such a network by this library's own kernels. Immutable; serves several threads. What
/// comes out for one input does not depend on what is computed beside it.
class Mlp {
 public:
  /// @throws Error(kInvalidArgument) unless there are as many parameters as the layout has.
  Mlp(const MlpShape& shape, std::span<const float> parameters,
      InstructionSet set = BestInstructionSet());

  /// @param input shape().inputs numbers; else Error(kInvalidArgument).
  std::vector<float> operator()(std::span<const float> input) const;
  const MlpShape& shape() const { return shape_; }

 private:
  MlpShape shape_;
  std::shared_ptr<const internal::DenseLayers> layers_;
};

}  // namespace doorforge
