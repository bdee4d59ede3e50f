// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

namespace doorforge::internal {

/// Colour and density of a material as recipes name it.
struct Finish {
  const char* name;
  Eigen::Vector3d color_rgb;  ///< In [0, 1].
  double density_kg_m3;       ///< It is the whole piece's: a hollow-core leaf counts its cavities.
};

/// Throws Error(kInvalidConfig) that suggests the nearest name; `path` names the parameter.
const Finish& FinishNamed(const std::string& name, const std::string& path);

}  // namespace doorforge::internal
