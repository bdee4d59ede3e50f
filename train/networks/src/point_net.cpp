// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/point_net.h"

#include <cmath>

#include "doorforge/core/error.h"

#include "dense_layers.h"

namespace doorforge {
namespace {

constexpr float kLastScale = 0.1F;    // actions begin near their middle
constexpr int kFeatureMultiple = 32;  // the widest panel of the kernels

internal::Rows RowOf(std::span<const float> values) {
  return {values.data(), static_cast<std::ptrdiff_t>(values.size()), 1,
          static_cast<int>(values.size())};
}

void RequireRows(std::size_t found, int columns, std::size_t rows, const char* what) {
  const std::size_t needed = rows * static_cast<std::size_t>(columns);
  Require(rows > 0 && found == needed, ErrorCode::kInvalidArgument,
          "network: " + std::to_string(found) + " " + what + ", it reads " +
              std::to_string(columns) + " in a row");
}

void Elu(internal::Table& x) {
  for (float& value : x.values) value = value > 0 ? value : std::expm1(value);
}

}  // namespace

ParameterLayout PointNetLayout(const PointNetShape& shape) {
  ParameterLayout layout;
  layout.Add("point.0", shape.point, shape.point_hidden);
  layout.Add("point.1", shape.point_hidden, shape.point_features);
  layout.Add("cloud.0", shape.point_features, shape.cloud_hidden);
  layout.Add("cloud.1", shape.cloud_hidden, shape.cloud_features);
  layout.Add("head.0", shape.cloud_features + shape.own, shape.hidden);
  layout.Add("head.1", shape.hidden, shape.hidden);
  layout.Add("head.2", shape.hidden, shape.last_hidden);
  layout.Add("head.3", shape.last_hidden, shape.outputs);
  return layout;
}

std::vector<float> PointNetInitialisation(const PointNetShape& shape, std::uint64_t seed,
                                          const std::string& prefix) {
  const ParameterLayout layout = PointNetLayout(shape);
  std::vector<float> parameters = HeInitialisation(layout, seed, prefix);
  const DenseLayer& last = layout.layers().back();
  for (std::size_t i = last.offset; i < last.end(); ++i) parameters[i] *= kLastScale;
  return parameters;
}

PointNet::PointNet(const PointNetShape& shape, std::span<const float> parameters,
                   InstructionSet set)
    : shape_(shape) {
  const ParameterLayout layout = PointNetLayout(shape);
  Require(parameters.size() == layout.size(), ErrorCode::kInvalidArgument,
          "network: " + std::to_string(parameters.size()) + " parameters, its layers have " +
              std::to_string(layout.size()));
  Require(shape.point_hidden <= internal::kMostSparseColumns &&
              shape.point_features % kFeatureMultiple == 0,
          ErrorCode::kInvalidArgument,
          "network: point_hidden is at most 256, and point_features a multiple of 32");
  layers_ = std::make_shared<const internal::DenseLayers>(layout, parameters, set);
}

std::vector<float> PointNet::operator()(std::span<const float> points,
                                        std::span<const float> own) const {
  RequireRows(own.size(), shape_.own, 1, "numbers beside the cloud");
  return Outputs(CloudFeatures(points), own);
}

std::vector<float> PointNet::CloudFeatures(std::span<const float> points) const {
  const std::size_t count = points.size() / static_cast<std::size_t>(shape_.point);
  RequireRows(points.size(), shape_.point, count, "numbers of points");
  const internal::Rows rows{points.data(), shape_.point, static_cast<int>(count), shape_.point};
  const internal::Table hidden = layers_->Apply("point.0", rows, internal::Activation::kRectified);
  std::vector<float> best(static_cast<std::size_t>(shape_.point_features));
  layers_->MaximumOver("point.1", hidden.View(), best);
  internal::Table x = layers_->Apply("cloud.0", RowOf(best), internal::Activation::kRectified);
  x = layers_->Apply("cloud.1", x.View(), internal::Activation::kRectified);
  return {x.values.begin(), x.values.begin() + shape_.cloud_features};
}

std::vector<float> PointNet::Outputs(std::span<const float> cloud_features,
                                     std::span<const float> own) const {
  const std::size_t count = own.size() / static_cast<std::size_t>(shape_.own);
  RequireRows(own.size(), shape_.own, count, "numbers beside the cloud");
  RequireRows(cloud_features.size(), shape_.cloud_features, 1, "features of a cloud");
  const int rows = static_cast<int>(count);
  // a stride of 0 repeats the cloud's features in each row
  const internal::Rows seen{cloud_features.data(), 0, rows, shape_.cloud_features};
  internal::Table x = internal::SideBySide({seen, {own.data(), shape_.own, rows, shape_.own}});
  for (const char* name : {"head.0", "head.1", "head.2"}) {
    x = layers_->Apply(name, x.View(), internal::Activation::kNone);
    Elu(x);
  }
  const internal::Table out = layers_->Apply("head.3", x.View(), internal::Activation::kNone);
  std::vector<float> numbers;
  for (int row = 0; row < rows; ++row) {
    const auto first = out.values.begin() + static_cast<std::ptrdiff_t>(row) * out.stride;
    numbers.insert(numbers.end(), first, first + shape_.outputs);
  }
  return numbers;
}

}  // namespace doorforge
