// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dense_layers.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "doorforge/core/error.h"

#include "kernel_choice.h"

namespace doorforge::internal {
namespace {

constexpr float kLeakySlope = 0.01F;

Table MakeTable(int rows, int columns, int stride) {
  return {rows, columns, stride, std::vector<float>(static_cast<std::size_t>(rows) * stride)};
}

}  // namespace

Rows ViewOf(const std::vector<float>& values, int columns) {
  return {values.data(), columns, static_cast<int>(values.size()) / columns, columns};
}

Table SideBySide(std::initializer_list<Rows> parts) {
  int columns = 0;
  for (const Rows& part : parts) columns += part.columns;
  Table joined = MakeTable(parts.begin()->rows, columns, columns);
  int first = 0;
  for (const Rows& part : parts) {
    for (int row = 0; row < part.rows; ++row)
      std::copy_n(part.data + row * part.stride, part.columns,
                  joined.values.data() + static_cast<std::ptrdiff_t>(row) * columns + first);
    first += part.columns;
  }
  return joined;
}

DenseLayers::DenseLayers(const ParameterLayout& layout, std::span<const float> parameters,
                         InstructionSet set)
    : kernels_(&KernelsFor(set)) {
  for (const DenseLayer& dense : layout.layers())
    if (!dense.name.starts_with("encoder."))
      layers_.push_back(Pack(dense, parameters.data() + dense.offset));
}

// The kernels compute whole panels of outputs: what a layer lacks is filled up with zeros.
DenseLayers::Layer DenseLayers::Pack(const DenseLayer& dense, const float* weight) const {
  const int panel = kernels_->panel;
  const int padded = (dense.outputs + panel - 1) / panel * panel;
  Layer layer{.name = dense.name,
              .outputs = dense.outputs,
              .weight = {nullptr, padded, dense.inputs},
              .panels = std::vector<float>(static_cast<std::size_t>(padded) * dense.inputs),
              .bias = std::vector<float>(static_cast<std::size_t>(padded))};
  for (int output = 0; output < dense.outputs; ++output) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(output / panel) * panel;
    float* to = layer.panels.data() + first * dense.inputs + output % panel;
    for (int input = 0; input < dense.inputs; ++input)
      to[static_cast<std::ptrdiff_t>(input) * panel] = *weight++;
  }
  std::copy_n(weight, dense.outputs, layer.bias.begin());
  return layer;
}

const DenseLayers::Layer& DenseLayers::Find(const std::string& name) const {
  const auto found = std::ranges::find(layers_, name, &Layer::name);
  if (found == layers_.end())
    throw Error(ErrorCode::kInvalidArgument, "no layer \"" + name + "\" in this network");
  return *found;
}

// Reads the layer's last inputs, as many as `x` has columns.
void DenseLayers::Apply(const Layer& layer, Multiply multiply, const Rows& x, Activation activation,
                        Table& out) const {
  out.rows = x.rows;
  out.columns = layer.outputs;
  out.stride = layer.weight.columns;
  out.values.resize(static_cast<std::size_t>(out.rows) * static_cast<std::size_t>(out.stride));
  const std::ptrdiff_t skipped = layer.weight.depth - x.columns;
  multiply(
      x,
      {layer.panels.data() + skipped * kernels_->panel, layer.weight.columns, layer.weight.depth},
      layer.bias.data(), {out.values.data(), out.stride}, activation == Activation::kRectified);
  if (activation == Activation::kLeaky)
    for (float& value : out.values) value = value > 0 ? value : kLeakySlope * value;
}

const DenseLayers::Layer& DenseLayers::FindFor(const std::string& name, const Rows& x) const {
  const Layer& layer = Find(name);
  Require(x.columns == layer.weight.depth, ErrorCode::kInvalidArgument,
          "layer \"" + name + "\": reads " + std::to_string(layer.weight.depth) + " numbers, not " +
              std::to_string(x.columns));
  return layer;
}

void DenseLayers::Apply(const std::string& name, const Rows& x, Activation activation,
                        Table& out) const {
  Apply(FindFor(name, x), kernels_->multiply, x, activation, out);
}

void DenseLayers::ApplyToRectified(const std::string& name, const Rows& x, Activation activation,
                                   Table& out) const {
  Apply(FindFor(name, x), kernels_->multiply_sparse, x, activation, out);
}

Table DenseLayers::Apply(const std::string& name, const Rows& x, Activation activation) const {
  Table out;
  Apply(name, x, activation, out);
  return out;
}

Table DenseLayers::ApplyToLast(const std::string& name, const Rows& x,
                               Activation activation) const {
  const Layer& layer = Find(name);
  Require(x.columns <= layer.weight.depth, ErrorCode::kInvalidArgument,
          "layer \"" + name + "\": reads " + std::to_string(layer.weight.depth) + " numbers, not " +
              std::to_string(x.columns));
  Table out;
  Apply(layer, kernels_->multiply, x, activation, out);
  return out;
}

Table DenseLayers::Branch(const std::string& name, Activation between, const Rows& x) const {
  const Table first = Apply(name + ".0", x, between);
  const Table second = Apply(name + ".1", first.View(), between);
  return Apply(name + ".2", second.View(), Activation::kNone);
}

void DenseLayers::MaximumOver(const std::string& name, const Rows& x, std::span<float> best) const {
  const Layer& layer = FindFor(name, x);
  Require(
      x.columns <= kMostSparseColumns, ErrorCode::kInvalidArgument,
      "layer \"" + name + "\": reads more than " + std::to_string(kMostSparseColumns) + " numbers");
  Require(std::cmp_equal(best.size(), layer.outputs) && layer.outputs == layer.weight.columns,
          ErrorCode::kInvalidArgument,
          "layer \"" + name + "\": gives " + std::to_string(layer.outputs) +
              " numbers in panels of " + std::to_string(kernels_->panel));
  kernels_->multiply_max(x, {layer.panels.data(), layer.weight.columns, layer.weight.depth},
                         layer.bias.data(), best.data());
}

}  // namespace doorforge::internal
