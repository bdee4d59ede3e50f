// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/familiarity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "doorforge/core/error.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/mirror.h"

namespace doorforge {
namespace {

constexpr float kReach = 0.6F;  // [m]
constexpr int kCellsASide = 4;
constexpr std::array<float, 10> kRadii = {0.05F, 0.1F,  0.17F, 0.25F,   0.33F,
                                          0.5F,  0.75F, 1,     5 / 3.F, 2.5F};  // [reach]
constexpr std::size_t kCells = std::size_t{kCellsASide} * kCellsASide * kCellsASide;
constexpr std::array<float, 3> kMomentRadii = {0.2F, 0.5F, 4 / 3.F};  // [reach]
constexpr std::array<float, 2> kHandleRadii = {0.2F, 0.5F};  // [reach], of what is the handle's
constexpr std::size_t kMomentNumbers = 9;
constexpr std::size_t kAllNumbers =
    3 + kRadii.size() + kCells + kMomentNumbers * kMomentRadii.size() + 1;
constexpr std::size_t kHandleNumbers = 2 * (1 + kHandleRadii.size() * (1 + kMomentNumbers));

constexpr std::size_t kMostTraining = 4096;
constexpr std::size_t kMostValidation = 2048;
constexpr std::size_t kLeastTraining = 20;
constexpr std::size_t kHeldOut = 10;  // every so many, where there are no validation samples
// Logarithms of counts, and lengths in units of the reach: so that what hardly varied is not blown
// up.
constexpr double kLeastDeviation = 0.05;

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

using Points = std::vector<Eigen::Vector3f>;  // from the place, in units of the reach

float LogCount(std::ptrdiff_t count) {
  return static_cast<float>(std::log1p(static_cast<double>(count)));
}

std::ptrdiff_t CountWithin(const Points& points, float radius) {
  return std::ranges::count_if(
      points, [&](const Eigen::Vector3f& point) { return point.squaredNorm() < radius * radius; });
}

// A cell is half a reach wide; the outermost hold all that lies beyond them as well.
void AppendCells(const Points& points, SightNumbers& out) {
  std::array<std::ptrdiff_t, kCells> counts{};
  for (const Eigen::Vector3f& point : points) {
    std::size_t cell = 0;
    for (const float coordinate : point)
      cell = kCellsASide * cell +
             static_cast<std::size_t>(std::clamp(std::floor(2 * coordinate) + kCellsASide / 2.F,
                                                 0.F, kCellsASide - 1.F));
    ++counts.at(cell);
  }
  for (const std::ptrdiff_t count : counts) out.push_back(LogCount(count));
}

// Mean and covariance of what is within the radius, in units of it.
void AppendMoments(const Points& points, float radius, SightNumbers& out) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const Eigen::Vector3f& point : points) {
    if (point.squaredNorm() >= radius * radius) continue;
    const Eigen::Vector3d scaled = (point / radius).cast<double>();
    sum += scaled;
    squares += scaled * scaled.transpose();
    ++count;
  }
  const Eigen::Vector3d mean = sum / std::max(1, count);
  const Eigen::Matrix3d covariance = squares / std::max(1, count) - mean * mean.transpose();
  for (const double coordinate : mean) out.push_back(static_cast<float>(coordinate));
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = row; column < 3; ++column)
      out.push_back(static_cast<float>(covariance(row, column)));
  }
}

Points PointsFrom(const SightCloud& cloud, const Eigen::Vector3f& place) {
  Points points;
  points.reserve(cloud.xyz.size() / 3);
  for (std::size_t i = 0; i + 2 < cloud.xyz.size(); i += 3)
    points.emplace_back(
        (Eigen::Vector3f(cloud.xyz[i], cloud.xyz[i + 1], cloud.xyz[i + 2]) - place) / kReach);
  return points;
}

// What the mask says is the handle, and what it says is not: a mask on something flat, or beside
// the handle, shows in how the two lie to each other.
void AppendHandle(const Points& points, std::span<const std::uint8_t> label, SightNumbers& out) {
  std::array<Points, 2> parts;
  for (std::size_t i = 0; i < points.size(); ++i)
    parts.at(label[i] == static_cast<std::uint8_t>(PointLabel::kHandle) ? 0 : 1)
        .push_back(points[i]);
  for (const Points& part : parts) {
    out.push_back(LogCount(static_cast<std::ptrdiff_t>(part.size())));
    for (const float radius : kHandleRadii) {
      out.push_back(LogCount(CountWithin(part, radius)));
      AppendMoments(part, radius, out);
    }
  }
}

// The middle of what the mask says is the handle: a contact may be anywhere on it.
Eigen::Vector3f MiddleOfHandle(const SightCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    if (cloud.label[i] != static_cast<std::uint8_t>(PointLabel::kHandle)) continue;
    sum += Eigen::Vector3f(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2])
               .cast<double>();
    ++count;
  }
  if (count == 0) return {cloud.xyz[0], cloud.xyz[1], cloud.xyz[2]};
  return (sum / count).cast<float>();
}

std::vector<std::size_t> EvenlyTaken(std::size_t count, std::size_t most) {
  const std::size_t taken = std::min(count, most);
  std::vector<std::size_t> indices(taken);
  for (std::size_t i = 0; i < taken; ++i) indices[i] = i * count / taken;
  return indices;
}

// A sample a column.
// Samples that are taken, in their order.
struct TakenSamples {
  std::span<const TrainingSample> samples;
  std::vector<std::size_t> indices;
  NetworkFamily family;
  SampleSides sides;

  SightNumbers Numbers(std::size_t i) const {
    TrainingSample sample = samples[indices[i]];
    if (sides == SampleSides::kMirroredToo && i % 2 == 1) {
      sample.proprioception = MirroredSideways(sample.proprioception);
      sample.is_mirrored = !sample.is_mirrored;
    }
    std::vector<float> mirrored;
    return SightNumbersOf({ShownCloud(sample, mirrored), sample.label}, sample.proprioception,
                          family);
  }
};

Matrix ColumnsOf(const TakenSamples& taken) {
  Matrix columns(static_cast<Eigen::Index>(SightSize(taken.family)),
                 static_cast<Eigen::Index>(taken.indices.size()));
  for (std::size_t i = 0; i < taken.indices.size(); ++i) {
    const SightNumbers numbers = taken.Numbers(i);
    columns.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::VectorXf>(numbers.data(), columns.rows()).cast<double>();
  }
  return columns;
}

// The correlation of normalised columns, moved towards a multiple of the identity by as much as
// its error asks for: Ledoit and Wolf, "A well-conditioned estimator for large-dimensional
// covariance matrices", 2004, equations 14 and the lemmas before it.
Matrix ShrunkCovariance(const Matrix& columns) {
  const auto size = static_cast<double>(columns.rows());
  const auto count = static_cast<double>(columns.cols());
  const Matrix sample = columns * columns.transpose() / count;
  const double scale = sample.trace() / size;
  const Matrix target = scale * Matrix::Identity(sample.rows(), sample.cols());
  const double dispersion = (sample - target).squaredNorm();
  double error = 0;
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    error += std::pow(columns.col(i).squaredNorm(), 2);
  error = std::clamp(error / (count * count) - sample.squaredNorm() / count, 0.0, dispersion);
  const double share = dispersion > 0 ? error / dispersion : 1;
  return (1 - share) * sample + share * target;
}

std::vector<float> ToFloats(const Matrix& matrix) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      values.push_back(static_cast<float>(matrix(row, column)));
  }
  return values;
}

void Whiten(const Matrix& columns, Familiarity& familiarity) {
  const Vector mean = columns.rowwise().mean();
  Matrix normalised = columns.colwise() - mean;
  const Vector deviation =
      (normalised.rowwise().squaredNorm() / static_cast<double>(columns.cols()))
          .cwiseSqrt()
          .cwiseMax(kLeastDeviation);
  normalised = deviation.cwiseInverse().asDiagonal() * normalised;
  Matrix covariance = ShrunkCovariance(normalised);
  // what never varied, in data of one scene say, has a correlation of nothing with everything
  covariance.diagonal().array() += 1e-3;
  const Matrix whitening =
      covariance.llt().matrixL().solve(Matrix(deviation.cwiseInverse().asDiagonal()));
  familiarity.mean = ToFloats(mean);
  familiarity.whitening = ToFloats(whitening);
}

}  // namespace

std::size_t SightSize(NetworkFamily family) {
  return family == NetworkFamily::kGrasp ? kAllNumbers + kHandleNumbers : kAllNumbers;
}

SightNumbers SightNumbersOf(const SightCloud& cloud, const Proprioception& proprioception,
                            NetworkFamily family) {
  const bool grasps = family == NetworkFamily::kGrasp;
  Require(cloud.xyz.size() >= 3, ErrorCode::kInvalidArgument, "a sight without a point");
  Require(!grasps || cloud.label.size() == cloud.xyz.size() / 3, ErrorCode::kInvalidArgument,
          "the sight of a grasp without a label for each point");
  const Eigen::Vector3f place = grasps ? MiddleOfHandle(cloud) : HandPositionOf(proprioception);
  const Points points = PointsFrom(cloud, place);
  SightNumbers numbers;
  numbers.reserve(SightSize(family));
  for (const float coordinate : points.front()) numbers.push_back(coordinate);
  if (grasps) AppendHandle(points, cloud.label, numbers);
  for (const float radius : kRadii) numbers.push_back(LogCount(CountWithin(points, radius)));
  AppendCells(points, numbers);
  for (const float radius : kMomentRadii) AppendMoments(points, radius, numbers);
  numbers.push_back(place.z());
  return numbers;
}

double Familiarity::DistanceOf(const SightNumbers& numbers) const {
  const std::size_t size = mean.size();
  Require(numbers.size() == size, ErrorCode::kInvalidArgument,
          "a sight of " + std::to_string(numbers.size()) + " numbers, expected " +
              std::to_string(size));
  double squares = 0;
  for (std::size_t row = 0; row < size; ++row) {
    double sum = 0;
    for (std::size_t column = 0; column <= row; ++column)
      sum += static_cast<double>(whitening[row * size + column]) *
             (static_cast<double>(numbers[column]) - static_cast<double>(mean[column]));
    squares += sum * sum;
  }
  return std::sqrt(squares / static_cast<double>(size));
}

double Familiarity::PercentileOf(double distance) const {
  const auto less = std::ranges::count_if(
      distances, [&](float one) { return static_cast<double>(one) < distance; });
  return 100 * static_cast<double>(less) / static_cast<double>(distances.size());
}

double Familiarity::DistanceAt(double percentile) const {
  const double place =
      std::clamp(percentile / 100, 0.0, 1.0) * static_cast<double>(distances.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, distances.size() - 1);
  const double share = place - static_cast<double>(low);
  return (1 - share) * static_cast<double>(distances[low]) +
         share * static_cast<double>(distances[high]);
}

std::optional<Familiarity> FitFamiliarity(std::span<const TrainingSample> train,
                                          std::span<const TrainingSample> validation,
                                          NetworkFamily family, SampleSides sides) {
  if (train.size() < kLeastTraining) return std::nullopt;
  Familiarity familiarity;
  std::vector<std::size_t> fitted = EvenlyTaken(train.size(), kMostTraining);
  std::vector<std::size_t> held = EvenlyTaken(validation.size(), kMostValidation);
  if (validation.size() < 2) {
    validation = train;
    held.clear();
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < fitted.size(); ++i)
      (i % kHeldOut == 0 ? held : others).push_back(fitted[i]);
    fitted = std::move(others);
  }
  Whiten(ColumnsOf({train, std::move(fitted), family, sides}), familiarity);
  const TakenSamples judged{validation, std::move(held), family, sides};
  for (std::size_t i = 0; i < judged.indices.size(); ++i)
    familiarity.distances.push_back(static_cast<float>(familiarity.DistanceOf(judged.Numbers(i))));
  std::ranges::sort(familiarity.distances);
  return familiarity;
}

}  // namespace doorforge
