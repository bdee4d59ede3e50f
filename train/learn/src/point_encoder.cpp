// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/learn/point_encoder.h"

#include <algorithm>
#include <cstring>

#include "doorforge/core/error.h"

#include "kernel_choice.h"
#include "packed_encoder.h"

namespace doorforge {

using internal::CentreBlock;
using internal::kBlockRows;
using internal::Kernels;
using internal::LevelWidth;
using internal::MutableRows;
using internal::PackedEncoder;
using internal::PackedLayer;
using internal::Rows;
using internal::Scratch;

namespace {

// Sizes of UniDoorManip's PointNet++; the first number of each abstraction counts the position.
constexpr std::array<std::array<int, 4>, 4> kAbstractionSizes = {
    {{6, 32, 32, 64}, {67, 64, 64, 128}, {131, 128, 128, 256}, {259, 256, 256, 512}}};
const std::array<std::vector<int>, 4> kPropagationSizes = {
    {{131, 128, 128, 128}, {320, 256, 128}, {384, 256, 256}, {768, 256, 256}}};

std::string LayerName(const char* kind, std::size_t level, std::size_t i) {
  return kind + std::to_string(level + 1) + "." + std::to_string(i);
}

struct GradientInputs {
  int begin;
  int count;
};

// Columns [begin, begin + count) of `matrix` (rows x columns) in panels: for each panel, row by
// row, `panel` columns.
std::vector<float> ColumnPanels(const float* matrix, int rows, int columns, GradientInputs chosen,
                                int panel) {
  std::vector<float> packed;
  packed.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(chosen.count));
  for (int begin = chosen.begin; begin < chosen.begin + chosen.count; begin += panel) {
    for (int row = 0; row < rows; ++row) {
      const float* from = matrix + static_cast<std::ptrdiff_t>(row) * columns + begin;
      packed.insert(packed.end(), from, from + panel);
    }
  }
  return packed;
}

// The same of the transposed matrix, of which the first `depth` rows are taken.
std::vector<float> RowPanels(const float* matrix, int rows, int columns, int depth, int panel) {
  std::vector<float> packed(static_cast<std::size_t>(rows) * static_cast<std::size_t>(depth));
  for (int row = 0; row < rows; ++row) {
    const std::ptrdiff_t first = row / panel * panel;
    float* to = packed.data() + first * depth + row % panel;
    const float* from = matrix + static_cast<std::ptrdiff_t>(row) * columns;
    for (int k = 0; k < depth; ++k) to[static_cast<std::ptrdiff_t>(k) * panel] = from[k];
  }
  return packed;
}

class Packer {
 public:
  Packer(const ParameterLayout& layout, std::string prefix, std::span<const float> parameters,
         int panel)
      : layout_(layout), prefix_(std::move(prefix)), parameters_(parameters), panel_(panel) {}

  PackedLayer Pack(const std::string& name, GradientInputs passed_on) const {
    const DenseLayer& dense = Find(prefix_ + name);
    PackedLayer layer{.inputs = dense.inputs,
                      .outputs = dense.outputs,
                      .weight_offset = dense.offset,
                      .bias_offset = dense.bias_offset(),
                      .backward_begin = passed_on.begin,
                      .backward_count = passed_on.count};
    const float* weight = parameters_.data() + dense.offset;
    layer.weight.assign(weight, weight + dense.weight_count());
    layer.bias.assign(weight + dense.weight_count(), parameters_.data() + dense.end());
    layer.forward = RowPanels(weight, dense.outputs, dense.inputs, dense.inputs, panel_);
    layer.position = RowPanels(weight, dense.outputs, dense.inputs, 3, panel_);
    layer.backward = ColumnPanels(weight, dense.outputs, dense.inputs, passed_on, panel_);
    return layer;
  }

 private:
  const DenseLayer& Find(const std::string& name) const {
    for (const DenseLayer& layer : layout_.layers()) {
      if (layer.name == name) return layer;
    }
    throw Error(ErrorCode::kInvalidArgument, "no layer \"" + name + "\" in this network");
  }

  const ParameterLayout& layout_;
  std::string prefix_;
  std::span<const float> parameters_;
  int panel_;
};

// Max-pools each ball of a block and writes the rectified result into the level's rows.
// NOLINTNEXTLINE(readability-function-size): the operands of a kernel
void PoolBlock(const Kernels& kernels, const CloudGeometry::Level& level, const CentreBlock& block,
               const float* rows, PointEncoder::Trace& trace, std::size_t l) {
  const int width = LevelWidth(l + 1);
  const int features = width - 3;
  for (std::size_t s = block.first; s < block.last; ++s) {
    const std::uint32_t begin = level.ball_begin[s];
    const Rows ball{rows + static_cast<std::size_t>(begin - block.member_begin) * features,
                    features, static_cast<int>(level.ball_begin[s + 1] - begin), features};
    float* out = trace.level[l + 1].data() + s * width;
    std::copy_n(level.centre_xyz.data() + 3 * s, 3, out);
    kernels.column_max(ball, out + 3, trace.argmax[l].data() + s * features);
    for (int i = 3; i < width; ++i) out[i] = std::max(out[i], 0.0F);
  }
}

void AbstractSet(const PackedEncoder& encoder, const CloudGeometry& geometry, std::size_t l,
                 PointEncoder::Trace& trace) {
  const Kernels& kernels = *encoder.kernels;
  const CloudGeometry::Level& level = geometry.levels[l];
  const auto& layers = encoder.abstraction[l];
  const int width = layers[0].outputs;
  const int below = static_cast<int>(trace.level[l].size()) / LevelWidth(l);
  const int centres = static_cast<int>(level.size());

  // W [p_k - c_s, f_k] + b = (W [p_k, f_k] + b) - W_xyz c_s: once per point instead of once per row
  trace.source[l].resize(static_cast<std::size_t>(below) * width);
  internal::ForRowBlocks(below, [&](std::ptrdiff_t row, int count) {
    kernels.multiply(
        {trace.level[l].data() + row * LevelWidth(l), LevelWidth(l), count, LevelWidth(l)},
        layers[0].ForwardPanels(), layers[0].bias.data(),
        {trace.source[l].data() + row * width, width}, false);
  });
  trace.centre[l].resize(static_cast<std::size_t>(centres) * width);
  kernels.multiply({level.centre_xyz.data(), 3, centres, 3}, layers[0].PositionPanels(), nullptr,
                   {trace.centre[l].data(), width}, false);

  trace.level[l + 1].resize(level.size() * LevelWidth(l + 1));
  trace.argmax[l].resize(level.size() * layers[2].outputs);
  const auto first = Scratch(std::size_t{kBlockRows} * width);
  const auto second = Scratch(std::size_t{kBlockRows} * layers[1].outputs);
  const auto third = Scratch(std::size_t{kBlockRows} * layers[2].outputs);
  for (std::size_t start = 0; start < level.size();) {
    const CentreBlock block = internal::BlockFrom(level, start);
    float* row = first.get();
    for (std::size_t s = block.first; s < block.last; ++s) {
      for (std::uint32_t m = level.ball_begin[s]; m < level.ball_begin[s + 1]; ++m, row += width)
        kernels.subtract_relu(
            trace.source[l].data() + static_cast<std::size_t>(level.member[m]) * width,
            trace.centre[l].data() + s * width, width, row);
    }
    kernels.multiply({first.get(), width, block.rows, width}, layers[1].ForwardPanels(),
                     layers[1].bias.data(), {second.get(), layers[1].outputs}, true);
    kernels.multiply({second.get(), layers[1].outputs, block.rows, layers[1].outputs},
                     layers[2].ForwardPanels(), layers[2].bias.data(),
                     {third.get(), layers[2].outputs}, false);
    PoolBlock(kernels, level, block, third.get(), trace, l);
    start = block.last;
  }
}

// Inputs of feature propagation l: the three nearest coarser features, weighted, and the point's
// own.
std::vector<float> Upsample(const Kernels& kernels, const CloudGeometry& geometry, std::size_t l,
                            const PointEncoder::Trace& trace, int width) {
  const CloudGeometry::Upsampling& upsampling = geometry.upsampling[l];
  const int own = LevelWidth(l) - 3;
  const int coarse = width - own;
  std::vector<float> input(upsampling.size() * width);
  for (std::size_t t = 0; t < upsampling.size(); ++t) {
    float* row = input.data() + t * width;
    for (std::size_t j = 3 * t; j < 3 * t + 3; ++j) {
      const std::size_t n = upsampling.neighbour[j];
      const float* feature = l == 3 ? trace.level[4].data() + n * LevelWidth(4) + 3
                                    : trace.propagation[l + 1].back().data() + n * coarse;
      kernels.add_scaled(upsampling.weight[j], feature, coarse, row);
    }
    const float* skip =
        trace.level[l].data() + static_cast<std::size_t>(upsampling.skip[t]) * LevelWidth(l) + 3;
    std::copy_n(skip, own, row + coarse);
  }
  return input;
}

std::vector<float> Dense(const Kernels& kernels, const PackedLayer& layer,
                         const std::vector<float>& input) {
  const int rows = static_cast<int>(input.size()) / layer.inputs;
  std::vector<float> output(static_cast<std::size_t>(rows) * layer.outputs);
  internal::ForRowBlocks(rows, [&](std::ptrdiff_t row, int count) {
    kernels.multiply({input.data() + row * layer.inputs, layer.inputs, count, layer.inputs},
                     layer.ForwardPanels(), layer.bias.data(),
                     {output.data() + row * layer.outputs, layer.outputs}, true);
  });
  return output;
}

}  // namespace

namespace internal {

int LevelWidth(std::size_t level) {
  return level == 0 ? 6 : 3 + kAbstractionSizes[level - 1].back();
}

CentreBlock BlockFrom(const CloudGeometry::Level& level, std::size_t first) {
  CentreBlock block{first, first, level.ball_begin[first], 0};
  while (block.last < level.size()) {
    const int rows = static_cast<int>(level.ball_begin[block.last + 1] - block.member_begin);
    if (rows > kBlockRows) break;
    block.rows = rows;
    ++block.last;
  }
  return block;
}

}  // namespace internal

void AddEncoderLayers(const std::string& prefix, ParameterLayout& layout) {
  for (std::size_t level = 0; level < 4; ++level) {
    const auto& sizes = kAbstractionSizes[level];
    for (std::size_t i = 0; i < 3; ++i)
      layout.Add(prefix + LayerName("sa", level, i), sizes[i], sizes[i + 1]);
  }
  for (std::size_t level = 4; level-- > 0;) {
    const auto& sizes = kPropagationSizes[level];
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
      layout.Add(prefix + LayerName("fp", level, i), sizes[i], sizes[i + 1]);
  }
  layout.Add(prefix + "head", kFeatureSize, kFeatureSize);
}

PointEncoder::PointEncoder(const ParameterLayout& layout, const std::string& prefix,
                           std::span<const float> parameters, InstructionSet set) {
  auto packed = std::make_shared<PackedEncoder>();
  packed->kernels = &internal::KernelsFor(set);
  const Packer packer(layout, prefix, parameters, packed->kernels->panel);
  for (std::size_t level = 0; level < 4; ++level) {
    for (std::size_t i = 0; i < 3; ++i) {
      // positions are given, so the first layer passes a gradient to the features alone
      const int inputs = kAbstractionSizes[level][i];
      const GradientInputs passed_on = i > 0        ? GradientInputs{0, inputs}
                                       : level == 0 ? GradientInputs{0, 0}
                                                    : GradientInputs{3, inputs - 3};
      packed->abstraction[level][i] = packer.Pack(LayerName("sa", level, i), passed_on);
    }
    const auto& sizes = kPropagationSizes[level];
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i) {
      const int passed_on = level == 0 && i == 0 ? kFeatureSize : sizes[i];
      packed->propagation[level].push_back(packer.Pack(LayerName("fp", level, i), {0, passed_on}));
    }
  }
  packed->head = packer.Pack("head", {0, kFeatureSize});
  packed_ = std::move(packed);
}

PointEncoder::Trace PointEncoder::Forward(const CloudGeometry& geometry, Trace storage) const {
  Trace trace = std::move(storage);
  trace.level[0].resize(geometry.xyz.size() * 2);
  for (std::size_t i = 0; i < geometry.xyz.size(); i += 3) {
    std::copy_n(geometry.xyz.data() + i, 3, trace.level[0].data() + 2 * i);
    std::copy_n(geometry.xyz.data() + i, 3, trace.level[0].data() + 2 * i + 3);
  }
  for (std::size_t level = 0; level < 4; ++level) AbstractSet(*packed_, geometry, level, trace);
  for (std::size_t level = 4; level-- > 0;) {
    const auto& layers = packed_->propagation[level];
    auto& rows = trace.propagation[level];
    rows.clear();
    rows.push_back(Upsample(*packed_->kernels, geometry, level, trace, layers[0].inputs));
    for (const PackedLayer& layer : layers)
      rows.push_back(Dense(*packed_->kernels, layer, rows.back()));
  }
  trace.features = Dense(*packed_->kernels, packed_->head, trace.propagation[0].back());
  return trace;
}

}  // namespace doorforge
