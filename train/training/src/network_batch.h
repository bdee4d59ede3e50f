// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/networks/training_sample.h"

#include "head_objectives.h"

namespace doorforge::internal {

using Geometries = std::vector<std::shared_ptr<const CloudGeometry>>;

/// Geometries of a set of samples, kept up to a number of them.
class GeometryCache {
 public:
  /// Builds that of the sample with this index; called from several threads.
  using Build = std::function<CloudGeometry(std::size_t)>;

  /// @param points Output points of a geometry, for its size in memory.
  GeometryCache(std::size_t samples, std::size_t points, std::size_t budget_bytes, Build build);

  /// Returns those of the samples with these indices, found on `threads` threads where not yet
  /// known.
  Geometries Get(std::span<const std::size_t> indices, int threads);

 private:
  Build build_;
  std::size_t kept_;  // samples below this index are kept
  Geometries geometry_;
};

/// The normalised numbers of these samples; features and noise are left empty.
HeadBatch MakeHeadBatch(std::span<const TrainingSample> samples,
                        const StageNormalisation& normalisation);

/// A batch on its way through one network's encoder. Memory is reused from batch to batch.
class EncodedBatch {
 public:
  /// Features of all clouds, n x 128. Sample i is independent of the others.
  const PointEncoder::Trace& trace(std::size_t i) const { return traces_[i]; }
  void Resize(std::size_t size) { traces_.resize(size); }
  void Encode(const PointEncoder& encoder, const CloudGeometry& geometry, std::size_t i) {
    traces_[i] = encoder.Forward(geometry, std::move(traces_[i]));
  }
  std::vector<float> Features(std::size_t size) const;

 private:
  std::vector<PointEncoder::Trace> traces_;
};

}  // namespace doorforge::internal
