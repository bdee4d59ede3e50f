// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/instruction_set.h"
#include "doorforge/networks/parameters.h"

namespace doorforge {

namespace internal {
class DenseLayers;
}  // namespace internal

/// Sizes of a PointNet (Qi et al. 2017) with dense layers behind it, as PartManip's (Geng et al.
/// 2023): of each point a feature, of all points the maximum, beside it numbers of one's own.
struct PointNetShape {
  int point = 7;             ///< Numbers of a point.
  int point_hidden = 128;    ///< At most 256.
  int point_features = 256;  ///< A multiple of 32.
  int cloud_hidden = 256;
  int cloud_features = 112;
  int own = 1;  ///< Numbers beside the cloud.
  int hidden = 512;
  int last_hidden = 64;
  int outputs = 1;

  bool operator==(const PointNetShape&) const = default;
};

/// Its layers: "point.0", "point.1" with ReLU, the maximum over the points, "cloud.0" and "cloud.1"
/// with ReLU, then, of these features and one's own numbers, "head.0" to "head.2" with ELU and
/// "head.3".
ParameterLayout PointNetLayout(const PointNetShape& shape);

/// Weights to begin with: He initialisation, those of the last layer times 0.1; drawn as
/// HeInitialisation().
std::vector<float> PointNetInitialisation(const PointNetShape& shape, std::uint64_t seed,
                                          const std::string& prefix);

/// Computes such a network by this library's own kernels. Immutable; serves several threads.
class PointNet {
 public:
  /// @throws Error(kInvalidArgument) unless there are as many parameters as the layout has, or on a
  ///     shape whose points are out of range.
  PointNet(const PointNetShape& shape, std::span<const float> parameters,
           InstructionSet set = BestInstructionSet());

  /// @param points Row by row, shape().point numbers each, at least one row.
  /// @param own shape().own numbers. Error(kInvalidArgument) for other lengths.
  std::vector<float> operator()(std::span<const float> points, std::span<const float> own) const;

  /// The two halves of it, for who asks about one cloud several times: shape().cloud_features
  /// numbers of a cloud, and what follows from these and from each row of `own`, shape().outputs
  /// numbers a row. A row's numbers do not depend on the rows beside it.
  std::vector<float> CloudFeatures(std::span<const float> points) const;
  std::vector<float> Outputs(std::span<const float> cloud_features,
                             std::span<const float> own) const;

  const PointNetShape& shape() const { return shape_; }

 private:
  PointNetShape shape_;
  std::shared_ptr<const internal::DenseLayers> layers_;
};

}  // namespace doorforge
