// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bitset>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/networks/point_encoder.h"

#include "packed_encoder.h"

namespace doorforge {
namespace {

using internal::CentreBlock;
using internal::kBlockRows;
using internal::Kernels;
using internal::PackedEncoder;
using internal::PackedLayer;
using internal::Scratch;
using Floats = std::vector<float>;
using Scratched = std::unique_ptr<float[]>;

// A row-major matrix with rows side by side.
struct Matrix {
  const float* data;
  int rows;
  int columns;

  internal::Rows View() const { return {data, columns, rows, columns}; }
  Matrix Part(std::ptrdiff_t row, int count) const {
    return {data + row * columns, count, columns};
  }
};

// Adds columns that were summed as rows (n x outputs) to the weight's columns from `column` on.
void AddTransposed(const Floats& rows, const PackedLayer& layer, int column, float* weight) {
  const int count = static_cast<int>(rows.size()) / layer.outputs;
  for (int o = 0; o < layer.outputs; ++o) {
    for (int i = 0; i < count; ++i)
      weight[o * layer.inputs + column + i] +=
          rows[static_cast<std::size_t>(i) * static_cast<std::size_t>(layer.outputs) +
               static_cast<std::size_t>(o)];
  }
}

// Adds the gradient of a layer's bias and of the weights of its last inputs, as many as `input` has
// columns, given that of its output before the ReLU.
void AddLayerGradient(const Kernels& kernels, const PackedLayer& layer, const Matrix& input,
                      const Matrix& output_gradient, std::span<float> gradient) {
  float* weight = gradient.data() + layer.weight_offset + layer.inputs - input.columns;
  float* bias = gradient.data() + layer.bias_offset;
  const int tail = input.columns % 32;  // the last propagation's columns of position and colour
  internal::ForRowBlocks(input.rows, [&](std::ptrdiff_t row, int count) {
    internal::Rows columns = input.Part(row, count).View();
    columns.columns -= tail;
    kernels.add_outer(output_gradient.Part(row, count).View(), columns, {weight, layer.inputs});
  });
  Floats tail_weight(static_cast<std::size_t>(tail) *
                     static_cast<std::size_t>(layer.outputs));  // transposed
  for (std::ptrdiff_t row = 0; row < input.rows; ++row) {
    const float* from = output_gradient.data + row * layer.outputs;
    kernels.add_scaled(1.0F, from, layer.outputs, bias);
    const float* values = input.data + (row + 1) * input.columns - tail;
    for (int i = 0; i < tail; ++i)
      kernels.add_scaled(values[i], from, layer.outputs,
                         tail_weight.data() + static_cast<std::ptrdiff_t>(i) * layer.outputs);
  }
  AddTransposed(tail_weight, layer, input.columns - tail, weight);
}

// Gradient of a layer's inputs of these panels, given that of its output before the ReLU.
void PassBack(const Kernels& kernels, const internal::Panels& panels, const Matrix& output_gradient,
              float* input_gradient) {
  internal::ForRowBlocks(output_gradient.rows, [&](std::ptrdiff_t row, int count) {
    kernels.multiply(output_gradient.Part(row, count).View(), panels, nullptr,
                     {input_gradient + row * panels.columns, panels.columns}, false);
  });
}

// One set abstraction on the way back.
class SetGradient {
 public:
  SetGradient(const PackedEncoder& encoder, const CloudGeometry& geometry,
              const PointEncoder::Trace& trace, std::size_t l)
      : kernels_(*encoder.kernels),
        layers_(encoder.abstraction[l]),
        level_(geometry.levels[l]),
        trace_(trace),
        l_(l),
        output_width_(encoder.LevelWidth(l + 1)),
        widths_{layers_[0].outputs, layers_[1].outputs, layers_[2].outputs},
        row_width_(encoder.LevelWidth(l)),
        below_(static_cast<int>(trace.level[l].size()) / row_width_),
        source_(static_cast<std::size_t>(below_) * widths_[0]),
        centre_(level_.size() * widths_[0]),
        first_(Scratch(std::size_t{kBlockRows} * widths_[0])),
        second_(Scratch(std::size_t{kBlockRows} * widths_[1])),
        second_gradient_(Scratch(std::size_t{kBlockRows} * widths_[1])),
        first_gradient_(Scratch(std::size_t{kBlockRows} * widths_[0])) {}

  // Adds to `gradient`; returns the gradient of the features below (n x C, empty at level 0).
  Floats Run(const Floats& feature_gradient, std::span<float> gradient) {
    for (std::size_t start = 0; start < level_.size();) {
      const CentreBlock block = internal::BlockFrom(level_, start);
      ChooseRows(block, feature_gradient);
      Recompute();
      LastLayer(block, feature_gradient, gradient);
      MiddleLayer(gradient);
      Scatter();
      start = block.last;
    }
    return FirstLayer(gradient);
  }

 private:
  struct Row {
    std::uint16_t member;  // point of the level below
    std::size_t centre;
  };

  const std::uint8_t* ArgmaxOf(std::size_t s) const {
    return trace_.argmax[l_].data() + s * widths_[2];
  }
  const float* OutputOf(std::size_t s) const {
    return trace_.level[l_ + 1].data() + s * output_width_ + 3;
  }

  // A row of a ball has a gradient only if it gave a maximum that is positive and is asked for.
  void ChooseRows(const CentreBlock& block, const Floats& feature_gradient) {
    std::bitset<kBlockRows> used;
    for (std::size_t s = block.first; s < block.last; ++s) {
      const std::uint8_t* argmax = ArgmaxOf(s);
      const float* output = OutputOf(s);
      const float* wanted = feature_gradient.data() + s * widths_[2];
      const std::uint32_t begin = level_.ball_begin[s] - block.member_begin;
      for (int c = 0; c < widths_[2]; ++c) {
        if (output[c] > 0 && wanted[c] != 0) used.set(begin + argmax[c]);
      }
    }
    rows_.clear();
    for (std::size_t s = block.first; s < block.last; ++s) {
      for (std::uint32_t m = level_.ball_begin[s]; m < level_.ball_begin[s + 1]; ++m) {
        const std::uint32_t row = m - block.member_begin;
        if (!used[row]) continue;
        compact_[row] = static_cast<std::uint8_t>(rows_.size());
        rows_.push_back({level_.member[m], s});
      }
    }
  }

  int row_count() const { return static_cast<int>(rows_.size()); }

  // Activations of the chosen rows: cheaper than to keep those of all rows in memory.
  void Recompute() {
    const int width = widths_[0];
    for (std::size_t i = 0; i < rows_.size(); ++i)
      kernels_.subtract_relu(
          trace_.source[l_].data() + static_cast<std::size_t>(rows_[i].member) * width,
          trace_.centre[l_].data() + rows_[i].centre * width, width, first_.get() + i * width);
    kernels_.multiply({first_.get(), width, row_count(), width}, layers_[1].ForwardPanels(),
                      layers_[1].bias.data(), {second_.get(), widths_[1]}, true);
  }

  // Through the maximum: each feature touches one row.
  void LastLayer(const CentreBlock& block, const Floats& feature_gradient,
                 std::span<float> gradient) {
    const PackedLayer& layer = layers_[2];
    const int width = widths_[1];
    std::fill_n(second_gradient_.get(), rows_.size() * width, 0.0F);
    for (std::size_t s = block.first; s < block.last; ++s) {
      const std::uint8_t* argmax = ArgmaxOf(s);
      const float* output = OutputOf(s);
      const float* wanted = feature_gradient.data() + s * widths_[2];
      const std::uint32_t begin = level_.ball_begin[s] - block.member_begin;
      for (int c = 0; c < widths_[2]; ++c) {
        if (!(output[c] > 0) || wanted[c] == 0) continue;
        const std::size_t row = compact_[begin + argmax[c]];
        const std::size_t weight = static_cast<std::size_t>(c) * width;
        kernels_.add_scaled(wanted[c], layer.weight.data() + weight, width,
                            second_gradient_.get() + row * width);
        kernels_.add_scaled(wanted[c], second_.get() + row * width, width,
                            gradient.data() + layer.weight_offset + weight);
        gradient[layer.bias_offset + static_cast<std::size_t>(c)] += wanted[c];
      }
    }
    kernels_.mask(second_.get(), row_count() * width, second_gradient_.get());
  }

  void MiddleLayer(std::span<float> gradient) {
    const Matrix output_gradient{second_gradient_.get(), row_count(), widths_[1]};
    AddLayerGradient(kernels_, layers_[1], {first_.get(), row_count(), widths_[0]}, output_gradient,
                     gradient);
    PassBack(kernels_, layers_[1].BackwardPanels(), output_gradient, first_gradient_.get());
    kernels_.mask(first_.get(), row_count() * widths_[0], first_gradient_.get());
  }

  // The first layer is a difference of a point's and a centre's row, see AbstractSet.
  void Scatter() {
    const int width = widths_[0];
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const float* from = first_gradient_.get() + i * width;
      kernels_.add_scaled(1.0F, from, width,
                          source_.data() + static_cast<std::size_t>(rows_[i].member) * width);
      kernels_.add_scaled(-1.0F, from, width, centre_.data() + rows_[i].centre * width);
    }
  }

  Floats FirstLayer(std::span<float> gradient) {
    const PackedLayer& layer = layers_[0];
    const float* points = trace_.level[l_].data();
    const int by_hand = l_ == 0 ? row_width_ : 3;  // columns of the weight for what is given
    Floats position(static_cast<std::size_t>(by_hand) * static_cast<std::size_t>(widths_[0]));
    for (int k = 0; k < below_; ++k)
      AddPosition(source_.data() + static_cast<std::ptrdiff_t>(k) * widths_[0],
                  points + static_cast<std::ptrdiff_t>(k) * row_width_, by_hand, position);
    for (std::size_t s = 0; s < level_.size(); ++s)
      AddPosition(centre_.data() + s * widths_[0], level_.centre_xyz.data() + 3 * s, 3, position);
    float* weight = gradient.data() + layer.weight_offset;
    AddTransposed(position, layer, 0, weight);
    float* bias = gradient.data() + layer.bias_offset;
    for (int k = 0; k < below_; ++k)
      kernels_.add_scaled(1.0F, source_.data() + static_cast<std::ptrdiff_t>(k) * widths_[0],
                          widths_[0], bias);
    if (l_ == 0) return {};
    const Matrix source_gradient{source_.data(), below_, widths_[0]};
    kernels_.add_outer(source_gradient.View(), {points + 3, row_width_, below_, row_width_ - 3},
                       {weight + 3, layer.inputs});
    Floats below(static_cast<std::size_t>(below_) * layer.backward_count);
    PassBack(kernels_, layer.BackwardPanels(), source_gradient, below.data());
    return below;
  }

  void AddPosition(const float* row_gradient, const float* values, int count, Floats& position) {
    if (row_gradient[0] == 0 &&
        std::all_of(row_gradient, row_gradient + widths_[0], [](float g) { return g == 0; }))
      return;
    for (int i = 0; i < count; ++i)
      kernels_.add_scaled(values[i], row_gradient, widths_[0],
                          position.data() + static_cast<std::ptrdiff_t>(i) * widths_[0]);
  }

  const Kernels& kernels_;
  const std::array<PackedLayer, 3>& layers_;
  const CloudGeometry::Level& level_;
  const PointEncoder::Trace& trace_;
  std::size_t l_;
  int output_width_;
  std::array<int, 3> widths_;
  int row_width_;
  int below_;
  Floats source_;  // gradient of Trace::source
  Floats centre_;  // gradient of Trace::centre
  Scratched first_;
  Scratched second_;
  Scratched second_gradient_;
  Scratched first_gradient_;
  std::vector<Row> rows_;
  std::array<std::uint8_t, kBlockRows> compact_{};
};

// Gradients of all feature rows that the upsampling reads.
struct FeatureGradients {
  std::array<Floats, 5> level;    // of the set abstractions' features
  std::array<Floats, 4> targets;  // of the propagations' outputs
};

// The features that propagation l interpolates.
Floats& CoarseGradient(FeatureGradients& gradients, std::size_t l) {
  return l == 3 ? gradients.level[4] : gradients.targets[l + 1];
}

// Sums over the targets, weighted as they were interpolated, what each passes on to a neighbour.
void ScatterToNeighbours(const Kernels& kernels, const CloudGeometry::Upsampling& upsampling,
                         const internal::Rows& rows, Floats& sums) {
  for (std::size_t t = 0; t < upsampling.size(); ++t) {
    const float* row = rows.data + static_cast<std::ptrdiff_t>(t) * rows.stride;
    for (std::size_t j = 3 * t; j < 3 * t + 3; ++j)
      kernels.add_scaled(
          upsampling.weight[j], row, rows.columns,
          sums.data() + static_cast<std::size_t>(upsampling.neighbour[j]) * rows.columns);
  }
}

// Goes over the skip connection, to the points' own features; at level 0 they are positions.
void ScatterToOwn(const Kernels& kernels, const CloudGeometry& geometry, std::size_t l,
                  const internal::Rows& rows, FeatureGradients& gradients) {
  if (l == 0) return;
  for (std::size_t t = 0; t < geometry.upsampling[l].size(); ++t)
    kernels.add_scaled(
        1.0F, rows.data + static_cast<std::ptrdiff_t>(t) * rows.stride, rows.columns,
        gradients.level[l].data() + std::size_t{geometry.upsampling[l].skip[t]} * rows.columns);
}

// Through the inputs of a propagation.
void ScatterUpsampling(const PackedEncoder& encoder, const CloudGeometry& geometry, std::size_t l,
                       const Matrix& input_gradient, FeatureGradients& gradients) {
  const Kernels& kernels = *encoder.kernels;
  const int own = l == 0 ? 0 : encoder.LevelWidth(l) - 3;
  const int width = input_gradient.columns;
  const int coarse = width - own;
  ScatterToNeighbours(kernels, geometry.upsampling[l],
                      {input_gradient.data, width, input_gradient.rows, coarse},
                      CoarseGradient(gradients, l));
  ScatterToOwn(kernels, geometry, l,
               {input_gradient.data + coarse, width, input_gradient.rows, own}, gradients);
}

// Back through the dense layers of one propagation; `rows` are its inputs and its output.
Floats DenseGradient(const Kernels& kernels, std::span<const PackedLayer> layers,
                     std::span<const Floats> rows, Floats output_gradient,
                     std::span<float> gradient) {
  for (std::size_t i = layers.size(); i-- > 0;) {
    const PackedLayer& layer = layers[i];
    const int count = static_cast<int>(rows[i].size()) / layer.inputs;
    kernels.mask(rows[i + 1].data(), count * layer.outputs, output_gradient.data());
    const Matrix masked{output_gradient.data(), count, layer.outputs};
    AddLayerGradient(kernels, layer, {rows[i].data(), count, layer.inputs}, masked, gradient);
    Floats input_gradient(static_cast<std::size_t>(count) * layer.backward_count);
    PassBack(kernels, layer.BackwardPanels(), masked, input_gradient.data());
    output_gradient = std::move(input_gradient);
  }
  return output_gradient;
}

// The way back through ProjectedLayer(), given the gradient of its output: summed for the coarser
// points first, since then both products are of few rows.
class ProjectedGradient {
 public:
  ProjectedGradient(const PackedEncoder& encoder, const CloudGeometry& geometry,
                    const PointEncoder::Trace& trace, std::size_t l)
      : kernels_(*encoder.kernels),
        layer_(encoder.propagation[l][0]),
        own_(encoder.LevelWidth(l) - 3),
        geometry_(geometry),
        rows_(trace.propagation[l]),
        features_(internal::CoarseFeatures(encoder, geometry, trace, l)),
        l_(l) {}

  // Adds to `gradient` and to those of the features.
  void Run(Floats output_gradient, FeatureGradients& gradients, std::span<float> gradient) const {
    const int targets = static_cast<int>(geometry_.upsampling[l_].size());
    const int width = layer_.outputs;
    kernels_.mask(rows_[1].data(), targets * width, output_gradient.data());
    const Matrix masked{output_gradient.data(), targets, width};
    Coarse(masked, CoarseGradient(gradients, l_), gradient);
    AddLayerGradient(kernels_, layer_, {rows_[0].data(), targets, own_}, masked, gradient);
    if (l_ == 0) return;
    Floats own_gradient(static_cast<std::size_t>(targets) * own_);
    PassBack(kernels_, layer_.BackwardPanels(features_.columns, own_), masked, own_gradient.data());
    ScatterToOwn(kernels_, geometry_, l_, {own_gradient.data(), own_, targets, own_}, gradients);
  }

 private:
  void Coarse(const Matrix& masked, Floats& coarse_gradient, std::span<float> gradient) const {
    Floats sums(static_cast<std::size_t>(features_.rows) * masked.columns);
    ScatterToNeighbours(kernels_, geometry_.upsampling[l_], masked.View(), sums);
    const Matrix summed{sums.data(), features_.rows, masked.columns};
    internal::ForRowBlocks(features_.rows, [&](std::ptrdiff_t row, int count) {
      kernels_.add_outer(
          summed.Part(row, count).View(),
          {features_.data + row * features_.stride, features_.stride, count, features_.columns},
          {gradient.data() + layer_.weight_offset, layer_.inputs});
    });
    PassBack(kernels_, layer_.BackwardPanels(0, features_.columns), summed, coarse_gradient.data());
  }

  const Kernels& kernels_;
  const PackedLayer& layer_;
  int own_;  // columns of the points' own features
  const CloudGeometry& geometry_;
  const std::vector<Floats>& rows_;
  internal::Rows features_;
  std::size_t l_;
};

}  // namespace

void PointEncoder::AddGradient(const CloudGeometry& geometry, const Trace& trace,
                               std::span<const float> feature_gradient,
                               std::span<float> gradient) const {
  Require(feature_gradient.size() == trace.features.size(), ErrorCode::kInvalidArgument,
          "one gradient per feature is needed");
  const Kernels& kernels = *packed_->kernels;
  FeatureGradients gradients;
  for (std::size_t l = 1; l <= 4; ++l)
    gradients.level[l].resize(geometry.levels[l - 1].size() * (packed_->LevelWidth(l) - 3));
  for (std::size_t l = 0; l < 4; ++l)
    gradients.targets[l].resize(trace.propagation[l].back().size());

  const std::array<Floats, 2> head_rows = {trace.propagation[0].back(), trace.features};
  gradients.targets[0] =
      DenseGradient(kernels, {&packed_->head, 1}, head_rows,
                    Floats(feature_gradient.begin(), feature_gradient.end()), gradient);
  for (std::size_t l = 0; l < 4; ++l) {
    const std::span layers(packed_->propagation[l]);
    const std::span rows(trace.propagation[l]);
    const std::size_t dense = internal::ProjectsFirst(geometry, l) ? 1 : 0;
    Floats input_gradient = DenseGradient(kernels, layers.subspan(dense), rows.subspan(dense),
                                          std::move(gradients.targets[l]), gradient);
    const int targets = static_cast<int>(geometry.upsampling[l].size());
    if (dense > 0)
      ProjectedGradient(*packed_, geometry, trace, l)
          .Run(std::move(input_gradient), gradients, gradient);
    else
      ScatterUpsampling(
          *packed_, geometry, l,
          {input_gradient.data(), targets, static_cast<int>(input_gradient.size()) / targets},
          gradients);
  }
  for (std::size_t l = 4; l-- > 0;) {
    const Floats below =
        SetGradient(*packed_, geometry, trace, l).Run(gradients.level[l + 1], gradient);
    for (std::size_t i = 0; i < below.size(); ++i) gradients.level[l][i] += below[i];
  }
}

}  // namespace doorforge
