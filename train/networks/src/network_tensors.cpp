// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/network_tensors.h"

#include <algorithm>
#include <cmath>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

bool IsOfPosterior(std::string_view name, const std::string& prefix) {
  const auto begins = [&](const char* layer) { return name.starts_with(prefix + layer); };
  return begins("action.") || begins("posterior.") || begins("mean.") || begins("log_variance.");
}

}  // namespace

std::string NetworkPrefix(const char* network) { return std::string(network) + "."; }

void AddParameters(const ParameterLayout& layout, const std::string& prefix,
                   const std::vector<float>& parameters, MakeFloats make, TensorFile& file) {
  for (const DenseLayer& layer : layout.layers()) {
    const auto slice = [&](std::size_t begin, std::size_t count) {
      return std::span<const float>(parameters).subspan(begin, count);
    };
    const auto outputs = static_cast<std::uint64_t>(layer.outputs);
    file.tensors[prefix + layer.name + ".weight"] =
        make(slice(layer.offset, layer.weight_count()),
             {outputs, static_cast<std::uint64_t>(layer.inputs)});
    file.tensors[prefix + layer.name + ".bias"] =
        make(slice(layer.bias_offset(), outputs), {outputs});
  }
}

std::vector<float> ReadParameters(const ParameterLayout& layout, const std::string& prefix,
                                  const TensorFile& file, const std::string& path) {
  std::vector<float> parameters;
  parameters.reserve(layout.size());
  const auto append = [&](const std::string& name, const std::vector<std::uint64_t>& shape) {
    const std::string where = path + ": " + name;
    for (const float value : FloatsOf(TensorNamed(file, name, path), shape, where)) {
      if (!std::isfinite(value))
        throw Error(ErrorCode::kFormat, where + ": holds a number that is not finite");
      parameters.push_back(value);
    }
  };
  for (const DenseLayer& layer : layout.layers()) {
    const auto outputs = static_cast<std::uint64_t>(layer.outputs);
    append(prefix + layer.name + ".weight", {outputs, static_cast<std::uint64_t>(layer.inputs)});
    append(prefix + layer.name + ".bias", {outputs});
  }
  return parameters;
}

TensorFile WeightsOf(const StageNetworks& networks, MakeFloats make) {
  TensorFile file;
  const NetworkNames names = NamesOf(networks.family);
  AddParameters(networks.actor_layout(), NetworkPrefix(names.actor), networks.actor, make, file);
  AddParameters(networks.critic_layout(), NetworkPrefix(names.critic), networks.critic, make, file);
  return file;
}

void AddMissingPosterior(const StageNetworks& networks, TensorFile& file) {
  if (networks.family != NetworkFamily::kMotion) return;
  const std::string prefix = NetworkPrefix(NamesOf(networks.family).actor);
  const auto of_posterior = [&](const auto& tensor) { return IsOfPosterior(tensor.first, prefix); };
  if (std::ranges::any_of(file.tensors, of_posterior)) return;
  const StageNetworks untrained =
      InitialNetworks(networks.normalisation, networks.linear_branches, 0);
  for (const auto& tensor : WeightsOf(untrained, MakeHalfTensor).tensors)
    if (of_posterior(tensor)) file.tensors.insert(tensor);
}

void ReadWeights(const TensorFile& file, const std::string& path, StageNetworks& networks) {
  const NetworkNames names = NamesOf(networks.family);
  networks.actor = ReadParameters(networks.actor_layout(), NetworkPrefix(names.actor), file, path);
  networks.critic =
      ReadParameters(networks.critic_layout(), NetworkPrefix(names.critic), file, path);
}

}  // namespace doorforge::internal
