// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "network_batch.h"

#include "doorforge/core/parallel_for.h"

namespace doorforge::internal {
namespace {

// Point 0's geometry of a cloud, rounded up.
constexpr std::size_t kGeometryBytes = 160UL * 1024;

template <std::size_t N>
void Append(const std::array<float, N>& values, std::vector<float>& out) {
  out.insert(out.end(), values.begin(), values.end());
}

}  // namespace

GeometryCache::GeometryCache(std::size_t samples, std::size_t points, std::size_t budget_bytes,
                             Build build)
    : build_(std::move(build)),
      kept_(std::min(samples, budget_bytes / (points * kGeometryBytes))),
      geometry_(kept_) {}

Geometries GeometryCache::Get(std::span<const std::size_t> indices, int threads) {
  Geometries found(indices.size());
  ParallelFor(indices.size(), threads, [&](std::size_t i) {
    const std::size_t index = indices[i];
    if (index < kept_) found[i] = geometry_[index];
    if (found[i] == nullptr) found[i] = std::make_shared<const CloudGeometry>(build_(index));
  });
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < kept_) geometry_[indices[i]] = found[i];
  }
  return found;
}

HeadBatch MakeHeadBatch(std::span<const TrainingSample> samples,
                        const StageNormalisation& normalisation) {
  HeadBatch batch;
  batch.size = static_cast<int>(samples.size());
  for (const TrainingSample& sample : samples) {
    AppendRobotState(normalisation, {sample.proprioception, sample.way}, batch);
    Append(normalisation.action.Apply(sample.action), batch.actions);
    batch.angle_gains_rad.push_back(sample.angle_gain_rad);
  }
  return batch;
}

std::vector<float> EncodedBatch::Features(std::size_t size) const {
  std::vector<float> features;
  features.reserve(size * kFeatureSize);
  for (std::size_t i = 0; i < size; ++i)
    features.insert(features.end(), traces_[i].features.begin(), traces_[i].features.end());
  return features;
}

}  // namespace doorforge::internal
