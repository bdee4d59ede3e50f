// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "device_encoder.h"

#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include <torch/cuda.h>
#include <torch/types.h>

#include "doorforge/core/error.h"
#include "doorforge/networks/point_encoder.h"

namespace doorforge::internal {
namespace {

using Indices = std::vector<std::int64_t>;

constexpr std::int64_t kBall = 32;  // members of a ball, padded

std::optional<torch::Device> DeviceOf(const std::string& name) {
  if (name == "libtorch") return torch::Device(torch::kCPU);
  try {
    torch::Device device(name);
    if (device.is_cuda()) return device;
  } catch (const std::exception&) {  // no name of a device
  }
  return std::nullopt;
}

// The geometries of a batch as one: rows of all samples under each other.
struct JoinedGeometry {
  std::vector<float> xyz;                    // level 0
  std::vector<float> rgb;                    // likewise, -0.5 to 0.5
  std::array<std::vector<float>, 4> centre;  // of each level's balls
  std::array<Indices, 4> ball;               // rows of the level below, 32 a ball
  std::array<Indices, 4> skip;               // of each upsampling, rows of its level
  std::array<Indices, 4> neighbour;          // rows of the coarser upsampling or of level 4
  std::array<std::vector<float>, 4> weight;
  Indices read;  // rows of the last upsampling
};

void AppendShifted(const std::vector<std::uint16_t>& from, std::size_t shift, Indices& to) {
  for (const std::uint16_t index : from) to.push_back(static_cast<std::int64_t>(shift + index));
}

// Padded with the first member, which cannot change a maximum.
void AppendBalls(const CloudGeometry::Level& level, std::size_t shift, Indices& to) {
  for (std::size_t s = 0; s < level.size(); ++s) {
    const std::size_t begin = level.ball_begin[s];
    const std::size_t size = level.ball_begin[s + 1] - begin;
    for (std::size_t i = 0; i < static_cast<std::size_t>(kBall); ++i)
      to.push_back(static_cast<std::int64_t>(shift + level.member[begin + (i < size ? i : 0)]));
  }
}

void Append(const CloudGeometry& geometry, JoinedGeometry& joined) {
  std::array<std::size_t, 5> rows{};  // of each level, before this sample
  rows[0] = joined.xyz.size() / 3;
  for (std::size_t l = 0; l < 4; ++l) rows[l + 1] = joined.centre[l].size() / 3;
  std::array<std::size_t, 5> targets{};
  for (std::size_t l = 0; l < 4; ++l) targets[l] = joined.skip[l].size();
  targets[4] = rows[4];
  joined.xyz.insert(joined.xyz.end(), geometry.xyz.begin(), geometry.xyz.end());
  for (const std::uint8_t value : geometry.rgb) joined.rgb.push_back(ColorInput(value));
  for (std::size_t l = 0; l < 4; ++l) {
    const CloudGeometry::Level& level = geometry.levels[l];
    const CloudGeometry::Upsampling& upsampling = geometry.upsampling[l];
    joined.centre[l].insert(joined.centre[l].end(), level.centre_xyz.begin(),
                            level.centre_xyz.end());
    AppendBalls(level, rows[l], joined.ball[l]);
    AppendShifted(upsampling.skip, rows[l], joined.skip[l]);
    AppendShifted(upsampling.neighbour, targets[l + 1], joined.neighbour[l]);
    joined.weight[l].insert(joined.weight[l].end(), upsampling.weight.begin(),
                            upsampling.weight.end());
  }
  std::vector<std::uint16_t> read = geometry.read;
  if (read.empty()) {
    read.resize(geometry.upsampling[0].size());
    std::iota(read.begin(), read.end(), std::uint16_t{0});
  }
  AppendShifted(read, targets[0], joined.read);
}

// Where and how precisely a network computes.
struct Place {
  torch::Device device;
  torch::ScalarType real;
};

template <class T>
torch::Tensor Rows(const std::vector<T>& values, std::int64_t columns, const Place& place) {
  constexpr bool kReal = std::is_same_v<T, float>;
  return torch::from_blob(const_cast<T*>(values.data()),
                          {static_cast<std::int64_t>(values.size()) / columns, columns},
                          kReal ? torch::kFloat32 : torch::kInt64)
      .to(place.device, kReal ? place.real : torch::kInt64, /*non_blocking=*/false, /*copy=*/true);
}

torch::Tensor Here(const torch::Tensor& tensor) {
  return tensor.to(torch::kCPU, torch::kFloat32).contiguous();
}

std::string LayerName(const char* kind, std::size_t level, int i) {
  return kind + std::to_string(level + 1) + "." + std::to_string(i);
}

}  // namespace

void RequireDevice(const std::string& device) {
  if (device == "cpu") return;
  const auto found = DeviceOf(device);
  Require(found.has_value(), ErrorCode::kInvalidConfig,
          "config.device: \"" + device + "\" is none; there are cpu, libtorch, cuda and cuda:N");
  if (!found->is_cuda()) return;
  const bool there = torch::cuda::is_available() &&
                     (!found->has_index() ||
                      static_cast<std::size_t>(found->index()) < torch::cuda::device_count());
  Require(there, ErrorCode::kInvalidConfig,
          "config.device: this libtorch finds no " + device +
              "; Debian's is built without CUDA, another one is named to CMake by "
              "CMAKE_PREFIX_PATH");
}

struct DeviceEncoder::Network {
  const ParameterLayout* layout;
  Place place;
  std::vector<torch::Tensor> weights;  // of the encoder's layers, others undefined
  std::vector<torch::Tensor> biases;
  std::vector<torch::Tensor> means;      // of the batch, of each normalised layer, others undefined
  std::vector<torch::Tensor> variances;  // unbiased
  torch::Tensor features;

  torch::Tensor Dense(const std::string& name, const torch::Tensor& x) const {
    const std::vector<DenseLayer>& layers = layout->layers();
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (layers[i].name != "encoder." + name) continue;
      if (NormBehind(*layout, i) == nullptr)
        return torch::relu(torch::addmm(biases[i], x, weights[i].t()));
      // with a momentum of 1 the running statistics are those of this batch
      return torch::batch_norm(torch::mm(x, weights[i].t()), weights[i + 1].view(-1), biases[i + 1],
                               means[i], variances[i], /*training=*/true, /*momentum=*/1.0,
                               kNormEpsilon, /*cudnn_enabled=*/true)
          .relu_();
    }
    throw Error(ErrorCode::kInvalidArgument, "no layer \"" + name + "\" in this network");
  }

  bool ReadsColors() const { return layout->layers().front().inputs > 6; }

  torch::Tensor Abstract(const JoinedGeometry& joined, std::size_t l, const torch::Tensor& xyz,
                         const torch::Tensor& feature) const {
    const torch::Tensor ball = Rows(joined.ball[l], 1, place).view(-1);
    const torch::Tensor centre = Rows(joined.centre[l], 3, place).repeat_interleave(kBall, 0);
    torch::Tensor rows =
        torch::cat({xyz.index_select(0, ball) - centre, feature.index_select(0, ball)}, 1);
    for (int i = 0; i < 3; ++i) rows = Dense(LayerName("sa", l, i), rows);
    return rows.view({-1, kBall, rows.size(1)}).amax(1);
  }

  torch::Tensor Propagate(const JoinedGeometry& joined, std::size_t l, const torch::Tensor& coarse,
                          const torch::Tensor& own) const {
    const torch::Tensor neighbour = Rows(joined.neighbour[l], 1, place).view(-1);
    const torch::Tensor weight = Rows(joined.weight[l], 3, place).view({-1, 3, 1});
    const torch::Tensor near = coarse.index_select(0, neighbour).view({-1, 3, coarse.size(1)});
    const torch::Tensor skip = Rows(joined.skip[l], 1, place).view(-1);
    torch::Tensor rows = torch::cat({(near * weight).sum(1), own.index_select(0, skip)}, 1);
    for (int i = 0; i < (l == 0 ? 3 : 2); ++i) rows = Dense(LayerName("fp", l, i), rows);
    return rows;
  }

  torch::Tensor Forward(const JoinedGeometry& joined) const {
    torch::Tensor xyz = Rows(joined.xyz, 3, place);
    std::array<torch::Tensor, 5> feature{xyz};
    if (ReadsColors()) {
      Require(joined.rgb.size() == joined.xyz.size(), ErrorCode::kInvalidArgument,
              "these networks read the colours of points, and a cloud has none");
      feature[0] = torch::cat({xyz, Rows(joined.rgb, 3, place)}, 1);
    }
    for (std::size_t l = 0; l < 4; ++l) {
      feature[l + 1] = Abstract(joined, l, xyz, feature[l]);
      xyz = Rows(joined.centre[l], 3, place);
    }
    torch::Tensor up = feature[4];
    for (std::size_t l = 4; l-- > 0;) up = Propagate(joined, l, up, feature[l]);
    const torch::Tensor read = Rows(joined.read, 1, place).view(-1);
    return Dense("head", up).index_select(0, read);
  }
};

DeviceEncoder::DeviceEncoder(const ParameterLayout& layout, std::span<const float> parameters,
                             const std::string& device, bool in_double) {
  RequireDevice(device);
  network_ = std::make_unique<Network>(
      Network{&layout,
              {*DeviceOf(device), in_double ? torch::kFloat64 : torch::kFloat32},
              {},
              {},
              {},
              {},
              {}});
  for (std::size_t i = 0; i < layout.layers().size(); ++i) {
    const DenseLayer& layer = layout.layers()[i];
    const bool ours = layer.name.starts_with("encoder.");
    const float* data = parameters.data();
    const std::vector<float> weight(data + layer.offset, data + layer.bias_offset());
    const std::vector<float> bias(data + layer.bias_offset(), data + layer.end());
    const auto leaf = [&](const torch::Tensor& tensor) { return tensor.set_requires_grad(true); };
    network_->weights.push_back(ours ? leaf(Rows(weight, layer.inputs, network_->place))
                                     : torch::Tensor());
    network_->biases.push_back(
        ours ? leaf(Rows(bias, layer.outputs, network_->place).view(-1).detach())
             : torch::Tensor());
    const auto statistic = [&] {
      return NormBehind(layout, i) == nullptr
                 ? torch::Tensor()
                 : Rows(std::vector<float>(bias.size()), layer.outputs, network_->place).view(-1);
    };
    network_->means.push_back(statistic());
    network_->variances.push_back(statistic());
  }
}

DeviceEncoder::~DeviceEncoder() = default;
DeviceEncoder::DeviceEncoder(DeviceEncoder&&) noexcept = default;
DeviceEncoder& DeviceEncoder::operator=(DeviceEncoder&&) noexcept = default;

std::vector<float> DeviceEncoder::Forward(const Geometries& geometries, bool for_gradient) {
  network_->features = torch::Tensor();
  if (geometries.empty()) return {};
  JoinedGeometry joined;
  for (const auto& geometry : geometries) Append(*geometry, joined);
  const at::AutoGradMode mode(for_gradient);
  const torch::Tensor features = network_->Forward(joined);
  if (for_gradient) network_->features = features;
  const torch::Tensor here = Here(features.detach());
  return {here.data_ptr<float>(), here.data_ptr<float>() + here.numel()};
}

LayerStatistics DeviceEncoder::Statistics() const {
  LayerStatistics statistics;
  const auto append = [](const torch::Tensor& tensor, std::vector<float>& out) {
    if (!tensor.defined()) return;
    const torch::Tensor here = Here(tensor);
    out.insert(out.end(), here.data_ptr<float>(), here.data_ptr<float>() + here.numel());
  };
  for (const torch::Tensor& mean : network_->means) append(mean, statistics.mean);
  for (const torch::Tensor& variance : network_->variances) append(variance, statistics.variance);
  return statistics;
}

void DeviceEncoder::AddGradient(std::span<const float> feature_gradient,
                                std::span<float> gradient) const {
  if (!network_->features.defined()) return;
  const std::vector<float> wanted(feature_gradient.begin(), feature_gradient.end());
  network_->features.backward(Rows(wanted, kFeatureSize, network_->place));
  const auto add = [&](const torch::Tensor& tensor, std::size_t offset) {
    if (!tensor.defined() || !tensor.grad().defined()) return;
    const torch::Tensor here = Here(tensor.grad());
    const float* from = here.data_ptr<float>();
    for (std::int64_t i = 0; i < here.numel(); ++i)
      gradient[offset + static_cast<std::size_t>(i)] += from[i];
  };
  for (std::size_t i = 0; i < network_->weights.size(); ++i) {
    add(network_->weights[i], network_->layout->layers()[i].offset);
    add(network_->biases[i], network_->layout->layers()[i].bias_offset());
  }
}

}  // namespace doorforge::internal
