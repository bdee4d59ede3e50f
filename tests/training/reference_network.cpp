// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_network.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <ATen/Parallel.h>
#include <torch/types.h>

namespace doorforge::testing {
namespace {

using Point = std::array<float, 3>;

float Squared(const Point& a, const Point& b) {
  const float dx = a[0] - b[0];
  const float dy = a[1] - b[1];
  const float dz = a[2] - b[2];
  return dx * dx + dy * dy + dz * dz;
}

std::vector<Point> SamplePoints(const std::vector<Point>& points, std::size_t count) {
  std::vector<float> nearest(points.size(), 1e10F);
  std::vector<Point> chosen;
  std::size_t current = 0;
  while (chosen.size() < count) {
    chosen.push_back(points[current]);
    for (std::size_t i = 0; i < points.size(); ++i)
      nearest[i] = std::min(nearest[i], Squared(points[i], chosen.back()));
    current = static_cast<std::size_t>(
        std::distance(nearest.begin(), std::max_element(nearest.begin(), nearest.end())));
  }
  return chosen;
}

std::vector<std::int64_t> PaddedBall(const std::vector<Point>& points, const Point& centre,
                                     float radius) {
  std::vector<std::int64_t> ball;
  for (std::size_t i = 0; i < points.size() && ball.size() < 32; ++i) {
    if (Squared(points[i], centre) < radius * radius) ball.push_back(static_cast<std::int64_t>(i));
  }
  ball.resize(32, ball.front());
  return ball;
}

std::vector<std::int64_t> NearestIndices(const std::vector<Point>& points, const Point& query) {
  std::vector<std::int64_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::partial_sort(order.begin(), order.begin() + 3, order.end(),
                    [&](std::int64_t a, std::int64_t b) {
                      const float da = Squared(points[static_cast<std::size_t>(a)], query);
                      const float db = Squared(points[static_cast<std::size_t>(b)], query);
                      return da < db || (da == db && a < b);
                    });
  order.resize(3);
  return order;
}

torch::Tensor ToTensor(const std::vector<float>& values, std::int64_t columns,
                       Precision precision) {
  const torch::Tensor tensor = torch::tensor(values).view({-1, columns});
  return precision == Precision::kDouble ? tensor.to(torch::kFloat64) : tensor;
}

}  // namespace

struct ReferenceNetwork::Tensors {
  ParameterLayout layout;
  std::vector<torch::Tensor> weights;
  std::vector<torch::Tensor> biases;
  torch::Tensor xyz;                       // all points of level 0
  std::array<torch::Tensor, 4> ball;       // rows of the level below
  std::array<torch::Tensor, 4> relative;   // position in the ball
  std::array<torch::Tensor, 4> neighbour;  // rows of the coarser level
  std::array<torch::Tensor, 4> weight;
  struct Normalised {
    torch::Tensor mean, variance;
    std::int64_t rows = 0;
  };
  std::map<std::size_t, Normalised> normalised;  // by the normalisation's layer

  torch::Tensor Normalise(std::size_t layer, const torch::Tensor& product) {
    const torch::Tensor mean = product.mean(0);
    const torch::Tensor centred = product - mean;
    const torch::Tensor variance = (centred * centred).mean(0);
    normalised[layer] = {mean.detach(), variance.detach(), product.size(0)};
    return centred / (variance + 1e-5).sqrt() * weights[layer].view({-1}) + biases[layer];
  }

  torch::Tensor Dense(const std::string& name, const torch::Tensor& x) {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (layout.layers()[i].name != name) continue;
      if (i + 1 < weights.size() && layout.layers()[i + 1].name == name + ".norm")
        return torch::relu(Normalise(i + 1, x.matmul(weights[i].t())));
      return torch::relu(torch::addmm(biases[i], x, weights[i].t()));
    }
    throw std::runtime_error("no layer " + name);
  }

  torch::Tensor Forward() {
    std::array<torch::Tensor, 5> feature;
    feature[0] = xyz;
    for (std::size_t l = 0; l < 4; ++l) {
      torch::Tensor rows = torch::cat({relative[l], feature[l].index_select(0, ball[l])}, 1);
      for (int i = 0; i < 3; ++i)
        rows = Dense("sa" + std::to_string(l + 1) + "." + std::to_string(i), rows);
      feature[l + 1] = std::get<0>(rows.view({-1, 32, rows.size(1)}).max(1));
    }
    torch::Tensor up = feature[4];
    for (std::size_t l = 4; l-- > 0;) {
      const std::int64_t channels = up.size(1);
      torch::Tensor rows = up.index_select(0, neighbour[l]).view({-1, 3, channels});
      rows = (rows * weight[l].view({-1, 3, 1})).sum(1);
      rows = torch::cat({rows, feature[l]}, 1);
      for (int i = 0; i < (l == 0 ? 3 : 2); ++i)
        rows = Dense("fp" + std::to_string(l + 1) + "." + std::to_string(i), rows);
      up = rows;
    }
    return Dense("head", up);
  }
};

ReferenceNetwork::ReferenceNetwork(const ParameterLayout& layout, std::span<const float> parameters,
                                   const std::vector<std::vector<float>>& clouds,
                                   const Point& centre, Precision precision)
    : tensors_(std::make_unique<Tensors>()) {
  at::set_num_threads(1);
  tensors_->layout = layout;
  for (const DenseLayer& layer : layout.layers()) {
    const auto begin = parameters.begin() + static_cast<std::ptrdiff_t>(layer.offset);
    const auto middle = begin + static_cast<std::ptrdiff_t>(layer.weight_count());
    tensors_->weights.push_back(
        ToTensor({begin, middle}, layer.inputs, precision).set_requires_grad(true));
    tensors_->biases.push_back(ToTensor({middle, middle + layer.outputs}, layer.outputs, precision)
                                   .view({-1})
                                   .set_requires_grad(true));
  }
  constexpr std::array<std::size_t, 4> kCounts = {1024, 256, 64, 16};
  constexpr std::array<float, 4> kRadii = {0.1F, 0.2F, 0.4F, 0.8F};
  std::vector<float> xyz;
  std::array<std::vector<std::int64_t>, 4> balls, neighbours;
  std::array<std::vector<float>, 4> relative, weights;
  for (std::size_t b = 0; b < clouds.size(); ++b) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < clouds[b].size(); i += 3)
      points.push_back(
          {clouds[b][i] - centre[0], clouds[b][i + 1] - centre[1], clouds[b][i + 2] - centre[2]});
    for (const Point& p : points) xyz.insert(xyz.end(), p.begin(), p.end());
    for (std::size_t l = 0; l < 4; ++l) {
      const std::vector<Point> centres = SamplePoints(points, kCounts[l]);
      for (const Point& c : centres) {
        for (const std::int64_t i : PaddedBall(points, c, kRadii[l])) {
          balls[l].push_back(i + static_cast<std::int64_t>(b * points.size()));
          for (std::size_t k = 0; k < 3; ++k)
            relative[l].push_back(points[static_cast<std::size_t>(i)][k] - c[k]);
        }
      }
      for (const Point& p : points) {
        float sum = 0;
        std::array<float, 3> w{};
        const std::vector<std::int64_t> nearest = NearestIndices(centres, p);
        for (std::size_t j = 0; j < 3; ++j) {
          w[j] = 1.0F / (Squared(centres[static_cast<std::size_t>(nearest[j])], p) + 1e-8F);
          sum += w[j];
          neighbours[l].push_back(nearest[j] + static_cast<std::int64_t>(b * centres.size()));
        }
        for (const float v : w) weights[l].push_back(v / sum);
      }
      points = centres;
    }
  }
  tensors_->xyz = ToTensor(xyz, 3, precision);
  for (std::size_t l = 0; l < 4; ++l) {
    tensors_->ball[l] = torch::tensor(balls[l]);
    tensors_->relative[l] = ToTensor(relative[l], 3, precision);
    tensors_->neighbour[l] = torch::tensor(neighbours[l]);
    tensors_->weight[l] = ToTensor(weights[l], 3, precision);
  }
}

ReferenceNetwork::~ReferenceNetwork() = default;

ReferenceNetwork::Result ReferenceNetwork::Run(std::span<const float> feature_gradient) {
  for (std::size_t i = 0; i < tensors_->weights.size(); ++i) {
    tensors_->weights[i].mutable_grad() = torch::Tensor();
    tensors_->biases[i].mutable_grad() = torch::Tensor();
  }
  const torch::Tensor features = tensors_->Forward();
  const torch::Tensor wanted =
      torch::from_blob(const_cast<float*>(feature_gradient.data()), features.sizes())
          .to(features.dtype());
  features.backward(wanted);
  Result result;
  const auto append = [](const torch::Tensor& tensor, std::vector<float>& out) {
    const torch::Tensor flat = tensor.contiguous().view(-1).to(torch::kFloat32);
    out.insert(out.end(), flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel());
  };
  append(features.detach(), result.features);
  const auto append_gradient = [&](const torch::Tensor& tensor) {
    append(tensor.grad().defined() ? tensor.grad() : torch::zeros_like(tensor), result.gradient);
  };
  for (std::size_t i = 0; i < tensors_->weights.size(); ++i) {
    append_gradient(tensors_->weights[i]);
    append_gradient(tensors_->biases[i]);
  }
  for (const auto& [layer, normalised] : tensors_->normalised) {
    append(normalised.mean, result.mean);
    append(normalised.variance, result.variance);
    result.rows.insert(result.rows.end(), static_cast<std::size_t>(normalised.mean.numel()),
                       static_cast<double>(normalised.rows));
  }
  return result;
}

}  // namespace doorforge::testing
