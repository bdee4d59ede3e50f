// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/parameters.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/schemas/safetensors.h"

// Networks as named tensors of a file: "<network>.<layer>.weight" [outputs, inputs] and
// "<network>.<layer>.bias" [outputs], the networks called as NetworkNames says.

namespace doorforge::internal {

/// Stores numbers in some precision, such as MakeTensor<float> or MakeHalfTensor.
using MakeFloats = Tensor (*)(std::span<const float>, std::vector<std::uint64_t>);

/// "<network>."
std::string NetworkPrefix(const char* network);

/// Adds every layer's weight and bias, the layer's name after `prefix`.
void AddParameters(const ParameterLayout& layout, const std::string& prefix,
                   const std::vector<float>& parameters, MakeFloats make, TensorFile& file);

/// The inverse of AddParameters(). Throws Error(kFormat), naming `path`, if a tensor is missing, of
/// another shape, or holds a number that is not finite.
std::vector<float> ReadParameters(const ParameterLayout& layout, const std::string& prefix,
                                  const TensorFile& file, const std::string& path);

/// Both networks of a stage.
TensorFile WeightsOf(const StageNetworks& networks, MakeFloats make);

/// A file may lack the posterior of a motion's actor ("action", "posterior", "mean" and
/// "log_variance", all of them), which training alone reads: adds one that has learned nothing, as
/// InitialNetworks() makes it of seed 0, rounded to F16. Where a part of it is there nothing is
/// added.
void AddMissingPosterior(const StageNetworks& networks, TensorFile& file);

/// The inverse of WeightsOf(), into networks of the family that they name. Throws as
/// ReadParameters().
void ReadWeights(const TensorFile& file, const std::string& path, StageNetworks& networks);

}  // namespace doorforge::internal
