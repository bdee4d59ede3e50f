// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace doorforge::internal {

double Logistic(double x);

/// Rows of numbers that are to tell a yes from a no.
struct LogisticProblem {
  std::vector<Eigen::VectorXd> rows;
  std::vector<bool> yes;  ///< One for each row.
  Eigen::VectorXd ridge;  ///< Half of it times the square of each weight is added; > 0.
};

/// The weights of the greatest likelihood, under which Logistic(row . weights) is the probability
/// of a yes, by Newton's method in double precision: the one minimum of a convex function, without
/// draws or settings.
Eigen::VectorXd FitLogistic(const LogisticProblem& problem);

}  // namespace doorforge::internal
