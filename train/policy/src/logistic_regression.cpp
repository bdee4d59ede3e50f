// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "logistic_regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace doorforge::internal {
namespace {

constexpr int kNewtonSteps = 50;
constexpr int kHalvings = 20;

struct LogisticObjective {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd curvature;
};

LogisticObjective ObjectiveAt(const Eigen::VectorXd& weights, const LogisticProblem& problem) {
  const Eigen::Index size = weights.size();
  LogisticObjective objective{0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const Eigen::VectorXd& row = problem.rows[i];
    const double score = row.dot(weights);
    const double p = Logistic(score);
    const double signed_score = problem.yes[i] ? -score : score;
    objective.value += std::max(0.0, signed_score) + std::log1p(std::exp(-std::fabs(signed_score)));
    objective.gradient += (p - (problem.yes[i] ? 1 : 0)) * row;
    objective.curvature.selfadjointView<Eigen::Lower>().rankUpdate(row, p * (1 - p));
  }
  objective.curvature.triangularView<Eigen::StrictlyUpper>() = objective.curvature.transpose();
  objective.value += 0.5 * problem.ridge.cwiseProduct(weights).dot(weights);
  objective.gradient += problem.ridge.cwiseProduct(weights);
  objective.curvature.diagonal() += problem.ridge;
  return objective;
}

}  // namespace

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

// A step that does not descend is halved.
Eigen::VectorXd FitLogistic(const LogisticProblem& problem) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(problem.ridge.size());
  LogisticObjective now = ObjectiveAt(weights, problem);
  for (int i = 0; i < kNewtonSteps && now.gradient.norm() > 1e-9 * (1 + now.value); ++i) {
    Eigen::VectorXd step = now.curvature.ldlt().solve(now.gradient);
    LogisticObjective next = ObjectiveAt(weights - step, problem);
    for (int half = 0; half < kHalvings && next.value > now.value; ++half) {
      step *= 0.5;
      next = ObjectiveAt(weights - step, problem);
    }
    if (next.value >= now.value) break;
    weights -= step;
    now = std::move(next);
  }
  return weights;
}

}  // namespace doorforge::internal
