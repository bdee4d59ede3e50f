// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "doorforge/networks/head_inputs.h"
#include "doorforge/networks/instruction_set.h"
#include "doorforge/networks/stage_networks.h"

// The layers behind the encoders as a policy runs them, by this library's own kernels. Training
// computes the same layers in libtorch, because it needs their gradients; the two agree to rounding
// (tests/networks). The layers are those of UniDoorManip, Section 4, as ActorLayout() and
// CriticLayout() list them. A head keeps its own copy of the weights. All are immutable and serve
// several threads; a sample's result does not depend on the samples beside it, and is the same for
// "avx2" and "avx512" (InstructionSet).

namespace doorforge::internal {

class DenseLayers;

/// Decodes actions of the family kMotion.
class ActorHead {
 public:
  explicit ActorHead(const StageNetworks& networks, InstructionSet set = BestInstructionSet());
  /// Reads `features` and `states`, and n x 128 latents.
  /// @returns Action numbers in the world's units, n x 9.
  std::vector<float> Decode(const HeadInputs& inputs, const std::vector<float>& latents) const;

 private:
  std::shared_ptr<const DenseLayers> layers_;
  Normaliser<9> action_;
  bool linear_branches_;
};

/// Scores actions of the family kMotion.
class CriticHead {
 public:
  explicit CriticHead(const StageNetworks& networks, InstructionSet set = BestInstructionSet());
  /// Reads all but `near` and `points`.
  /// @returns How far the door or the handle is expected to turn by the action [rad], n.
  std::vector<float> Score(const HeadInputs& inputs) const;

 private:
  std::shared_ptr<const DenseLayers> layers_;
  Normaliser<1> angle_gain_rad_;
};

/// Scores hands of the family kGrasp.
class DiscriminatorHead {
 public:
  explicit DiscriminatorHead(const StageNetworks& networks,
                             InstructionSet set = BestInstructionSet());
  /// Reads `near`, or `features` and `actions` where that is empty.
  /// @returns Door angles that are expected in the end [rad], n.
  std::vector<float> Score(const HeadInputs& inputs) const;

 private:
  std::shared_ptr<const DenseLayers> layers_;
  Normaliser<1> angle_gain_rad_;
};

/// Scores points of the family kGrasp.
class AffordanceHead {
 public:
  explicit AffordanceHead(const StageNetworks& networks, InstructionSet set = BestInstructionSet());
  /// Reads `features` and `points`.
  /// @returns Door angles that are expected of the best hands there [rad], n.
  std::vector<float> Score(const HeadInputs& inputs) const;

 private:
  std::shared_ptr<const DenseLayers> layers_;
  Normaliser<1> angle_gain_rad_;
};

/// Tells handles' points from others, by either network of the family kFind.
class FinderHead {
 public:
  /// `layout` and `parameters` of one of the two networks.
  FinderHead(const ParameterLayout& layout, std::span<const float> parameters,
             InstructionSet set = BestInstructionSet());
  /// Reads `features`.
  /// @returns The logit of being a handle's, n.
  std::vector<float> Score(const HeadInputs& inputs) const;

 private:
  std::shared_ptr<const DenseLayers> layers_;
};

}  // namespace doorforge::internal
