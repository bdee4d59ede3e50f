// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/batch_norm.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/instruction_set.h"
#include "doorforge/networks/parameters.h"

namespace doorforge {

namespace internal {
struct PackedEncoder;
}

/// Length of the feature that the encoder gives a point.
inline constexpr int kFeatureSize = 128;

/// How far a colour's channel reaches as an input, from black to white: no farther than the points
/// of the first ball lie apart. Where it was ten times as far, what a colour says drowned what a
/// place says.
inline constexpr double kColorScale = 0.1;

/// A channel of a point's colour as it enters, around 0.
inline float ColorInput(std::uint8_t channel) {
  return static_cast<float>(kColorScale) * (static_cast<float>(channel) / 255.0F - 0.5F);
}

/// PointNet++ for segmentation, single-scale (Qi et al. 2017; UniDoorManip's sizes, or with
/// EncoderWidth::kNarrow smaller ones): four set abstractions, four feature propagations, one dense
/// layer, all with bias and ReLU. A point's input feature is its position, and with
/// EncoderKind::colors its colour; the first set abstraction reads the position relative to the
/// centre as well.
///
/// Adds the encoder's layers ("<prefix>sa1.0" ... "<prefix>fp1.2", "<prefix>head") to `layout`,
/// with kBatch behind each its normalisation, see NormBehind().
void AddEncoderLayers(const std::string& prefix, ParameterLayout& layout, EncoderKind kind = {});

/// The encoder's parameters in the order that the inner loops of one instruction set read them.
class PointEncoder {
 public:
  /// What a forward pass keeps for the backward pass, and its result.
  struct Trace {
    /// [l]: n x (3 + C_l), position and feature of level l's points; [0] has its position twice,
    /// and its colour where that is read.
    std::array<std::vector<float>, 5> level;
    std::array<std::vector<float>, 4> source;  ///< First layer of each point, before the centre.
    std::array<std::vector<float>, 4> centre;  ///< First layer of each centre's position.
    std::array<std::vector<std::uint8_t>, 4> argmax;  ///< Ball member that gave each feature.
    /// [l][i]: input of layer i of feature propagation l; the last entry is its output. Where far
    /// more points are wanted than it interpolates between, the first are the points' own features
    /// alone: the first layer is then computed before it is interpolated.
    std::array<std::vector<std::vector<float>>, 4> propagation;
    std::vector<float> features;  ///< Outputs x 128.
  };

  /// `parameters` is a flat vector of `layout`, in which the encoder's layers have `prefix` and no
  /// normalisation. Whether it reads colours and how wide it is follow from the layout.
  PointEncoder(const ParameterLayout& layout, const std::string& prefix,
               std::span<const float> parameters, InstructionSet set);

  /// Features of all rows of the geometry's last upsampling. `storage` may be any former trace, to
  /// reuse memory.
  ///
  /// @throws Error(kInvalidArgument) if the encoder reads colours and the geometry has none.
  Trace Forward(const CloudGeometry& geometry, Trace storage = {}) const;

  /// Adds the gradient of sum(feature_gradient * features) to `gradient`, a flat vector of the
  /// layout. Gradients that are exactly zero cost nothing: rows of a ball that won no maximum are
  /// left out.
  void AddGradient(const CloudGeometry& geometry, const Trace& trace,
                   std::span<const float> feature_gradient, std::span<float> gradient) const;

 private:
  std::shared_ptr<const internal::PackedEncoder> packed_;
};

}  // namespace doorforge
