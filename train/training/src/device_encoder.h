// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/batch_norm.h"
#include "doorforge/networks/parameters.h"

#include "network_batch.h"

namespace doorforge::internal {

/// The encoder in libtorch's operators, where libtorch can compute: the network of PointEncoder on
/// the same geometries, a whole batch at once. For devices that this library has no kernels for,
/// and for the training of layers that are normalised over the batch.
class DeviceEncoder {
 public:
  /// @param device "libtorch" for the processor, or a name that libtorch knows, such as "cuda:0".
  /// @param in_double Computes in double precision: tells rounding from faults.
  /// @throws Error(kInvalidConfig) as RequireDevice().
  DeviceEncoder(const ParameterLayout& layout, std::span<const float> parameters,
                const std::string& device, bool in_double = false);
  ~DeviceEncoder();
  DeviceEncoder(DeviceEncoder&&) noexcept;
  DeviceEncoder& operator=(DeviceEncoder&&) noexcept;

  /// Features of the geometries' output points, one geometry after the other, n x 128. With
  /// `for_gradient` what AddGradient() needs is kept. Normalised layers use the statistics of
  /// all rows of the geometries, in balls their padding included, as UniDoorManip's.
  std::vector<float> Forward(const Geometries& geometries, bool for_gradient);

  /// Returns those of the last Forward(): means and unbiased variances.
  LayerStatistics Statistics() const;

  /// Adds the gradient of sum(feature_gradient * features) of the last Forward() to `gradient`, a
  /// flat vector of the layout. Once after each.
  void AddGradient(std::span<const float> feature_gradient, std::span<float> gradient) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

/// @throws Error(kInvalidConfig) if `device` is none, or one that libtorch does not find here.
void RequireDevice(const std::string& device);

}  // namespace doorforge::internal
