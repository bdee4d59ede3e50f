// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/mlp.h"

#include <cmath>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "dense_layers.h"

namespace doorforge {

ParameterLayout MlpLayout(const MlpShape& shape) {
  ParameterLayout layout;
  layout.Add("0", shape.inputs, shape.hidden);
  layout.Add("1", shape.hidden, shape.hidden);
  layout.Add("2", shape.hidden, shape.outputs);
  return layout;
}

std::vector<float> MlpInitialisation(const MlpShape& shape, std::uint64_t seed,
                                     const std::string& prefix, float last_scale) {
  const ParameterLayout layout = MlpLayout(shape);
  std::vector<float> parameters(layout.size());
  for (const DenseLayer& layer : layout.layers()) {
    Rng rng(seed, "init/" + prefix + layer.name);
    const double scale = (layer.name == "2" ? last_scale : 1.0F) / std::sqrt(layer.inputs);
    for (std::size_t i = 0; i < layer.weight_count(); ++i)
      parameters[layer.offset + i] = static_cast<float>(scale * rng.Normal());
  }
  return parameters;
}

Mlp::Mlp(const MlpShape& shape, std::span<const float> parameters, InstructionSet set)
    : shape_(shape) {
  const ParameterLayout layout = MlpLayout(shape);
  Require(parameters.size() == layout.size(), ErrorCode::kInvalidArgument,
          "network: " + std::to_string(parameters.size()) + " parameters, its layers have " +
              std::to_string(layout.size()));
  layers_ = std::make_shared<const internal::DenseLayers>(layout, parameters, set);
}

std::vector<float> Mlp::operator()(std::span<const float> input) const {
  internal::Table x{1,
                    static_cast<int>(input.size()),
                    static_cast<int>(input.size()),
                    {input.begin(), input.end()}};
  for (const char* name : {"0", "1"}) {
    x = layers_->Apply(name, x.View(), internal::Activation::kNone);
    for (float& value : x.values) value = std::tanh(value);
  }
  const internal::Table out = layers_->Apply("2", x.View(), internal::Activation::kNone);
  return {out.values.begin(), out.values.begin() + shape_.outputs};
}

}  // namespace doorforge
