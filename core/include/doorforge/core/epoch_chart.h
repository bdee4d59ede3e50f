// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace doorforge::page {

/// A loss over the epochs of a training.
struct EpochCurve {
  std::string name;  ///< Read out to those who cannot see the chart.
  std::string unit;  ///< Title of the upright axis.
  std::vector<double> epoch;
  std::vector<double> train;       ///< There is a value an epoch; what is not finite is left out.
  std::vector<double> validation;  ///< There is a value an epoch here as well.
  double best_epoch = 0;           ///< Marked by a line; 0: none.
};

/// The curve as SVG; empty without epochs. Its colours are those of kPageStyle.
std::string EpochChart(const EpochCurve& curve);

}  // namespace doorforge::page
