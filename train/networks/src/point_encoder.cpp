// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/point_encoder.h"

#include <algorithm>
#include <cstring>

#include "doorforge/core/error.h"

#include "kernel_choice.h"
#include "packed_encoder.h"

namespace doorforge {

using internal::CentreBlock;
using internal::kBlockRows;
using internal::Kernels;
using internal::MutableRows;
using internal::PackedEncoder;
using internal::PackedLayer;
using internal::Rows;
using internal::Scratch;

namespace {

// The first number of each abstraction counts the position. The first layers of "sa1" and "fp1"
// have kColors inputs more where colours are read. Features are multiples of the kernels' panels.
struct EncoderSizes {
  std::array<std::array<int, 4>, 4> abstraction;
  std::array<std::vector<int>, 4> propagation;
};

// UniDoorManip's PointNet++.
const EncoderSizes kFullSizes = {
    {{{6, 32, 32, 64}, {67, 64, 64, 128}, {131, 128, 128, 256}, {259, 256, 256, 512}}},
    {{{131, 128, 128, 128}, {320, 256, 128}, {384, 256, 256}, {768, 256, 256}}}};
const EncoderSizes kNarrowSizes = {
    {{{6, 32, 32, 32}, {35, 32, 32, 64}, {67, 64, 64, 64}, {67, 64, 64, 128}}},
    {{{67, 64, 64, 64}, {96, 64, 64}, {128, 64, 64}, {192, 64, 64}}}};

const EncoderSizes& SizesOf(EncoderWidth width) {
  return width == EncoderWidth::kNarrow ? kNarrowSizes : kFullSizes;
}

constexpr int kColors = 3;

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

// Packs the transposed matrix.
std::vector<float> RowPanels(const float* matrix, int rows, int columns, int panel) {
  std::vector<float> packed(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row / panel) * panel;
    float* to = packed.data() + first * columns + row % panel;
    const float* from = matrix + static_cast<std::ptrdiff_t>(row) * columns;
    for (int k = 0; k < columns; ++k) to[static_cast<std::ptrdiff_t>(k) * panel] = from[k];
  }
  return packed;
}

class Packer {
 public:
  Packer(const ParameterLayout& layout, std::string prefix, std::span<const float> parameters,
         int panel)
      : layout_(layout), prefix_(std::move(prefix)), parameters_(parameters), panel_(panel) {}

  int Outputs(const std::string& name) const { return Find(prefix_ + name).outputs; }

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
    layer.forward = RowPanels(weight, dense.outputs, dense.inputs, panel_);
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
void PoolBlock(const PackedEncoder& encoder, const CloudGeometry::Level& level,
               const CentreBlock& block, const float* rows, PointEncoder::Trace& trace,
               std::size_t l) {
  const Kernels& kernels = *encoder.kernels;
  const int width = encoder.LevelWidth(l + 1);
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
  const int row_width = encoder.LevelWidth(l);
  const int below = static_cast<int>(trace.level[l].size()) / row_width;
  const int centres = static_cast<int>(level.size());

  // W [p_k - c_s, f_k] + b = (W [p_k, f_k] + b) - W_xyz c_s: once per point instead of once per row
  trace.source[l].resize(static_cast<std::size_t>(below) * width);
  internal::ForRowBlocks(below, [&](std::ptrdiff_t row, int count) {
    kernels.multiply({trace.level[l].data() + row * row_width, row_width, count, row_width},
                     layers[0].ForwardPanels(), layers[0].bias.data(),
                     {trace.source[l].data() + row * width, width}, false);
  });
  trace.centre[l].resize(static_cast<std::size_t>(centres) * width);
  kernels.multiply({level.centre_xyz.data(), 3, centres, 3}, layers[0].ForwardPanels(), nullptr,
                   {trace.centre[l].data(), width}, false);

  trace.level[l + 1].resize(level.size() * encoder.LevelWidth(l + 1));
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
    PoolBlock(encoder, level, block, third.get(), trace, l);
    start = block.last;
  }
}

using Floats = std::vector<float>;

void FillPointRows(const PackedEncoder& encoder, const CloudGeometry& geometry, Floats& rows) {
  const bool reads_colors = encoder.reads_colors();
  Require(!reads_colors || geometry.rgb.size() == geometry.xyz.size(), ErrorCode::kInvalidArgument,
          "these networks read the colours of points, and the cloud has none");
  const auto width = static_cast<std::size_t>(encoder.LevelWidth(0));
  rows.resize(geometry.xyz.size() / 3 * width);
  float* row = rows.data();
  for (std::size_t i = 0; i < geometry.xyz.size(); i += 3, row += width) {
    std::copy_n(geometry.xyz.data() + i, 3, row);
    std::copy_n(geometry.xyz.data() + i, 3, row + 3);
    if (!reads_colors) continue;
    for (std::size_t k = 0; k < 3; ++k) row[6 + k] = ColorInput(geometry.rgb[i + k]);
  }
}

// y += the weighted features of target t's three neighbours.
void AddInterpolated(const Kernels& kernels, const CloudGeometry::Upsampling& upsampling,
                     std::size_t t, const Rows& features, float* y) {
  for (std::size_t j = 3 * t; j < 3 * t + 3; ++j)
    kernels.add_scaled(upsampling.weight[j],
                       features.data + upsampling.neighbour[j] * features.stride, features.columns,
                       y);
}

// Inputs of propagation l: the interpolated features, unless those come later, and the point's own.
Floats PropagationInputs(const PackedEncoder& encoder, const CloudGeometry& geometry, std::size_t l,
                         const PointEncoder::Trace& trace) {
  const Kernels& kernels = *encoder.kernels;
  const CloudGeometry::Upsampling& upsampling = geometry.upsampling[l];
  const Rows features = internal::CoarseFeatures(encoder, geometry, trace, l);
  const int row_width = encoder.LevelWidth(l);
  const int own = row_width - 3;
  const bool interpolates = !internal::ProjectsFirst(geometry, l);
  const int coarse = interpolates ? features.columns : 0;
  Floats input(upsampling.size() * (coarse + own));
  for (std::size_t t = 0; t < upsampling.size(); ++t) {
    float* row = input.data() + t * (coarse + own);
    if (interpolates) AddInterpolated(kernels, upsampling, t, features, row);
    const float* skip =
        trace.level[l].data() + static_cast<std::size_t>(upsampling.skip[t]) * row_width + 3;
    std::copy_n(skip, own, row + coarse);
  }
  return input;
}

// The first layer of a propagation that projects first:
// W [sum_j w_j f_j, s] + b = sum_j w_j (W_f f_j) + W_s s + b, the product once per coarser point.
Floats ProjectedLayer(const PackedEncoder& encoder, const CloudGeometry& geometry, std::size_t l,
                      const PointEncoder::Trace& trace, const Floats& own) {
  const Kernels& kernels = *encoder.kernels;
  const PackedLayer& layer = encoder.propagation[l][0];
  const int width = layer.outputs;
  const Rows features = internal::CoarseFeatures(encoder, geometry, trace, l);
  Floats projected(static_cast<std::size_t>(features.rows) * width);
  internal::ForRowBlocks(features.rows, [&](std::ptrdiff_t row, int count) {
    kernels.multiply(
        {features.data + row * features.stride, features.stride, count, features.columns},
        layer.ForwardPanels(), nullptr, {projected.data() + row * width, width}, false);
  });
  const int targets = static_cast<int>(geometry.upsampling[l].size());
  const int own_width = encoder.LevelWidth(l) - 3;
  const Floats zero(static_cast<std::size_t>(width));
  Floats output(static_cast<std::size_t>(targets) * width);
  internal::ForRowBlocks(targets, [&](std::ptrdiff_t row, int count) {
    float* out = output.data() + row * width;
    kernels.multiply({own.data() + row * own_width, own_width, count, own_width},
                     layer.ForwardPanels(features.columns, kernels.panel), layer.bias.data(),
                     {out, width}, false);
    for (int t = 0; t < count; ++t, out += width) {
      AddInterpolated(kernels, geometry.upsampling[l], static_cast<std::size_t>(row + t),
                      {projected.data(), width, features.rows, width}, out);
      kernels.subtract_relu(out, zero.data(), width, out);
    }
  });
  return output;
}

Floats Dense(const Kernels& kernels, const PackedLayer& layer, const Floats& input) {
  const int rows = static_cast<int>(input.size()) / layer.inputs;
  Floats output(static_cast<std::size_t>(rows) * layer.outputs);
  internal::ForRowBlocks(rows, [&](std::ptrdiff_t row, int count) {
    kernels.multiply({input.data() + row * layer.inputs, layer.inputs, count, layer.inputs},
                     layer.ForwardPanels(), layer.bias.data(),
                     {output.data() + row * layer.outputs, layer.outputs}, true);
  });
  return output;
}

}  // namespace

namespace internal {

bool PackedEncoder::reads_colors() const {
  return abstraction[0][0].inputs == kFullSizes.abstraction[0][0] + kColors;
}

int PackedEncoder::LevelWidth(std::size_t level) const {
  return level == 0 ? abstraction[0][0].inputs : 3 + abstraction.at(level - 1)[2].outputs;
}

std::size_t CoarsePoints(const CloudGeometry& geometry, std::size_t l) {
  return l == 3 ? geometry.levels[3].size() : geometry.upsampling[l + 1].size();
}

Rows CoarseFeatures(const PackedEncoder& encoder, const CloudGeometry& geometry,
                    const PointEncoder::Trace& trace, std::size_t l) {
  const int rows = static_cast<int>(CoarsePoints(geometry, l));
  const int coarsest = encoder.LevelWidth(4);
  if (l == 3) return {trace.level[4].data() + 3, coarsest, rows, coarsest - 3};
  const int width = encoder.propagation[l + 1].back().outputs;
  return {trace.propagation[l + 1].back().data(), width, rows, width};
}

bool ProjectsFirst(const CloudGeometry& geometry, std::size_t l) {
  return geometry.upsampling[l].size() >= 4 * CoarsePoints(geometry, l);
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

void AddEncoderLayers(const std::string& prefix, ParameterLayout& layout, EncoderKind kind) {
  const auto add = [&](const std::string& name, int inputs, int outputs) {
    const bool reads_points = name == "sa1.0" || name == "fp1.0";
    layout.Add(prefix + name, inputs + (kind.colors && reads_points ? kColors : 0), outputs);
    if (kind.norm == EncoderNorm::kBatch) layout.Add(prefix + name + ".norm", 1, outputs);
  };
  const EncoderSizes& all = SizesOf(kind.width);
  for (std::size_t level = 0; level < 4; ++level) {
    const auto& sizes = all.abstraction[level];
    for (std::size_t i = 0; i < 3; ++i) add(LayerName("sa", level, i), sizes[i], sizes[i + 1]);
  }
  for (std::size_t level = 4; level-- > 0;) {
    const auto& sizes = all.propagation[level];
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
      add(LayerName("fp", level, i), sizes[i], sizes[i + 1]);
  }
  add("head", all.propagation[0].back(), kFeatureSize);
}

PointEncoder::PointEncoder(const ParameterLayout& layout, const std::string& prefix,
                           std::span<const float> parameters, InstructionSet set) {
  auto packed = std::make_shared<PackedEncoder>();
  packed->kernels = &internal::KernelsFor(set);
  const Packer packer(layout, prefix, parameters, packed->kernels->panel);
  const bool narrow = packer.Outputs(LayerName("sa", 0, 2)) != kFullSizes.abstraction[0].back();
  const EncoderSizes& all = narrow ? kNarrowSizes : kFullSizes;
  for (std::size_t level = 0; level < 4; ++level) {
    for (std::size_t i = 0; i < 3; ++i) {
      // positions are given, so the first layer passes a gradient to the features alone
      const int inputs = all.abstraction[level][i];
      const GradientInputs passed_on = i > 0        ? GradientInputs{0, inputs}
                                       : level == 0 ? GradientInputs{0, 0}
                                                    : GradientInputs{3, inputs - 3};
      packed->abstraction[level][i] = packer.Pack(LayerName("sa", level, i), passed_on);
    }
    const auto& sizes = all.propagation[level];
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i) {
      const int passed_on = level == 0 && i == 0 ? all.propagation[1].back() : sizes[i];
      packed->propagation[level].push_back(packer.Pack(LayerName("fp", level, i), {0, passed_on}));
    }
  }
  packed->head = packer.Pack("head", {0, all.propagation[0].back()});
  packed_ = std::move(packed);
}

PointEncoder::Trace PointEncoder::Forward(const CloudGeometry& geometry, Trace storage) const {
  Trace trace = std::move(storage);
  FillPointRows(*packed_, geometry, trace.level[0]);
  for (std::size_t level = 0; level < 4; ++level) AbstractSet(*packed_, geometry, level, trace);
  for (std::size_t level = 4; level-- > 0;) {
    const auto& layers = packed_->propagation[level];
    auto& rows = trace.propagation[level];
    rows.clear();
    rows.push_back(PropagationInputs(*packed_, geometry, level, trace));
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const bool projects = i == 0 && internal::ProjectsFirst(geometry, level);
      rows.push_back(projects ? ProjectedLayer(*packed_, geometry, level, trace, rows[0])
                              : Dense(*packed_->kernels, layers[i], rows[i]));
    }
  }
  trace.features = Dense(*packed_->kernels, packed_->head, trace.propagation[0].back());
  return trace;
}

}  // namespace doorforge
