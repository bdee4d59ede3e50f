// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/heads.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "doorforge/networks/point_encoder.h"

#include "dense_layers.h"

namespace doorforge::internal {
namespace {

constexpr int kBranchFeatures = 128;  // of the grasp's branches

std::shared_ptr<const DenseLayers> ActorLayers(const StageNetworks& networks, InstructionSet set) {
  return std::make_shared<DenseLayers>(networks.actor_layout(), networks.actor, set);
}

std::shared_ptr<const DenseLayers> CriticLayers(const StageNetworks& networks, InstructionSet set) {
  return std::make_shared<DenseLayers>(networks.critic_layout(), networks.critic, set);
}

template <std::size_t N>
std::vector<float> Denormalised(const Normaliser<N>& normaliser, const Table& table) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(table.rows) * N);
  for (int row = 0; row < table.rows; ++row) {
    for (std::size_t i = 0; i < N; ++i) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(table.stride) + i;
      values.push_back(table.values[at] * normaliser.deviation[i] + normaliser.mean[i]);
    }
  }
  return values;
}

Table Zeros(int rows, int columns) {
  return {rows, columns, columns, std::vector<float>(static_cast<std::size_t>(rows) * columns)};
}

// Computes for each hand the maximum over its near points, one hand at a time, so that what its
// layers make stays in the second cache.
Table NearFeatures(const DenseLayers& layers, const HeadInputs& inputs) {
  const Rows near = ViewOf(inputs.near, 3);
  const int points = near.rows / inputs.size;
  Table features = Zeros(inputs.size, kBranchFeatures);
  std::span<float> left(features.values);
  Table one;
  Table two;
  for (int hand = 0; hand < inputs.size; ++hand) {
    const Rows own{near.data + static_cast<std::ptrdiff_t>(hand) * points * near.stride,
                   near.stride, points, near.columns};
    layers.Apply("near.0", own, Activation::kRectified, one);
    layers.ApplyToRectified("near.1", one.View(), Activation::kRectified, two);
    layers.MaximumOver("near.2", two.View(), left.first<kBranchFeatures>());
    left = left.subspan(kBranchFeatures);
  }
  return features;
}

}  // namespace

ActorHead::ActorHead(const StageNetworks& networks, InstructionSet set)
    : layers_(ActorLayers(networks, set)),
      action_(networks.normalisation.action),
      linear_branches_(networks.linear_branches) {}

std::vector<float> ActorHead::Decode(const HeadInputs& inputs,
                                     const std::vector<float>& latents) const {
  const Activation between = linear_branches_ ? Activation::kNone : Activation::kLeaky;
  const Table state = layers_->Branch("state", between, ViewOf(inputs.states, 18));
  const Table condition = SideBySide(
      {ViewOf(latents, kLatentSize), ViewOf(inputs.features, kFeatureSize), state.View()});
  return Denormalised(action_, layers_->Branch("decoder", between, condition.View()));
}

CriticHead::CriticHead(const StageNetworks& networks, InstructionSet set)
    : layers_(CriticLayers(networks, set)),
      angle_gain_rad_(networks.normalisation.angle_gain_rad) {}

std::vector<float> CriticHead::Score(const HeadInputs& inputs) const {
  const auto branch = [&](const char* name, const std::vector<float>& values, int columns) {
    return layers_->Branch(name, Activation::kRectified, ViewOf(values, columns));
  };
  const Table state = branch("state", inputs.states, 18);
  const Table action = branch("action", inputs.actions, 9);
  const Table hand = branch("hand", inputs.hands, 3);
  const Table base = branch("base", inputs.bases, 3);
  const Table joined = SideBySide({ViewOf(inputs.features, kFeatureSize), state.View(),
                                   action.View(), hand.View(), base.View()});
  return Denormalised(angle_gain_rad_,
                      layers_->Branch("score", Activation::kRectified, joined.View()));
}

DiscriminatorHead::DiscriminatorHead(const StageNetworks& networks, InstructionSet set)
    : layers_(CriticLayers(networks, set)),
      angle_gain_rad_(networks.normalisation.angle_gain_rad) {}

// The layer behind the branches reads three: features, actions and near points. What a network does
// not look at is zero there, and the near points come last.
std::vector<float> DiscriminatorHead::Score(const HeadInputs& inputs) const {
  Table hidden;
  if (inputs.near.empty()) {
    const Table action =
        layers_->Branch("action", Activation::kRectified, ViewOf(inputs.actions, 9));
    const Table nothing = Zeros(inputs.size, kBranchFeatures);
    const Table joined =
        SideBySide({ViewOf(inputs.features, kFeatureSize), action.View(), nothing.View()});
    hidden = layers_->Apply("score.0", joined.View(), Activation::kLeaky);
  } else {
    hidden =
        layers_->ApplyToLast("score.0", NearFeatures(*layers_, inputs).View(), Activation::kLeaky);
  }
  return Denormalised(angle_gain_rad_, layers_->Apply("score.1", hidden.View(), Activation::kNone));
}

AffordanceHead::AffordanceHead(const StageNetworks& networks, InstructionSet set)
    : layers_(ActorLayers(networks, set)), angle_gain_rad_(networks.normalisation.angle_gain_rad) {}

std::vector<float> AffordanceHead::Score(const HeadInputs& inputs) const {
  const Table point = layers_->Branch("point", Activation::kRectified, ViewOf(inputs.points, 3));
  const Table joined = SideBySide({ViewOf(inputs.features, kFeatureSize), point.View()});
  const Table hidden = layers_->Apply("score.0", joined.View(), Activation::kLeaky);
  return Denormalised(angle_gain_rad_, layers_->Apply("score.1", hidden.View(), Activation::kNone));
}

FinderHead::FinderHead(const ParameterLayout& layout, std::span<const float> parameters,
                       InstructionSet set)
    : layers_(std::make_shared<DenseLayers>(layout, parameters, set)) {}

std::vector<float> FinderHead::Score(const HeadInputs& inputs) const {
  const Table hidden =
      layers_->Apply("score.0", ViewOf(inputs.features, kFeatureSize), Activation::kLeaky);
  const Table score = layers_->Apply("score.1", hidden.View(), Activation::kNone);
  std::vector<float> logits;
  logits.reserve(static_cast<std::size_t>(score.rows));
  for (int row = 0; row < score.rows; ++row)
    logits.push_back(
        score.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(score.stride)]);
  return logits;
}

}  // namespace doorforge::internal
