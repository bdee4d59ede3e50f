// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/networks/parameters.h"

namespace doorforge {

/// What stands between an encoder layer's product and its ReLU while the network is trained.
/// kBatch: batch normalisation (Ioffe and Szegedy 2015) in the place of the bias, as UniDoorManip.
/// A policy always is kNone: what was learnt is folded into its weights.
enum class EncoderNorm { kNone, kBatch };
inline constexpr NamedValue<EncoderNorm> kEncoderNorms[] = {{EncoderNorm::kNone, "none"},
                                                            {EncoderNorm::kBatch, "batch"}};
constexpr std::span<const NamedValue<EncoderNorm>> ValuesOf(EncoderNorm) { return kEncoderNorms; }

/// How many features the encoder's layers have. kNarrow: a quarter and less, a tenth of the
/// weights; enough to tell a handle from a leaf.
enum class EncoderWidth { kFull, kNarrow };

/// Which encoder: what normalises its layers, whether a point's colour is an input beside its
/// position, and how wide it is.
struct EncoderKind {
  EncoderNorm norm = EncoderNorm::kNone;
  bool colors = false;
  EncoderWidth width = EncoderWidth::kFull;

  friend bool operator==(const EncoderKind&, const EncoderKind&) = default;
};

inline constexpr float kNormEpsilon = 1e-5F;  ///< Added to variances (PyTorch's).
inline constexpr float kNormMomentum = 0.1F;  ///< Share of the newest batch (PyTorch's).

/// They describe the products of all normalised layers of an encoder: a number an output, one after
/// the other in the layout's order.
struct LayerStatistics {
  std::vector<float> mean;
  std::vector<float> variance;
};

/// The normalisation that belongs to `layers()[layer]`: the layer right behind it, "<name>.norm",
/// with one input, whose weight is the scale and whose bias is the shift; null if there is none.
const DenseLayer* NormBehind(const ParameterLayout& layout, std::size_t layer);

/// Mean 0 and variance 1; empty for a layout without normalised layers.
LayerStatistics InitialStatistics(const ParameterLayout& layout);

/// Moves the running statistics towards those of a batch by kNormMomentum.
void MoveTowards(const LayerStatistics& batch, LayerStatistics& running);

/// The flat vector of the same layers without normalisation that computes what the normalised ones
/// do with these statistics; a copy of `parameters` for a layout without such layers.
std::vector<float> FoldNorms(const ParameterLayout& layout, std::span<const float> parameters,
                             const LayerStatistics& running);

}  // namespace doorforge
