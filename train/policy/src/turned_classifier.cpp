// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/turned_classifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/safetensors.h"

#include "logistic_regression.h"
#include "policy_companion.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kClassifierFile = "turned.safetensors";
constexpr const char* kClassifierSchema = "doorforge.turned";
constexpr internal::CompanionKind kClassifierKind{kClassifierSchema, kTurnedSchemaVersion,
                                                  "train the policy again with this build"};
constexpr double kRidge = 1;
constexpr double kLeastFeatureDeviation = 1e-3;  // so that what hardly varied is not blown up
constexpr Eigen::Index kUnknowns = kTurnedInputs + 1;

using Inputs = std::array<double, kTurnedInputs>;

// The motion, the magnitudes of its numbers, the lengths of its vectors.
Inputs InputsOf(const HandMotion& motion) {
  Inputs inputs{};
  for (std::size_t i = 0; i < motion.size(); ++i) {
    inputs.at(i) = motion.at(i);
    inputs.at(motion.size() + i) = std::fabs(motion.at(i));
  }
  for (std::size_t v = 0; v < 4; ++v) {
    const double x = motion.at(3 * v);
    const double y = motion.at(3 * v + 1);
    const double z = motion.at(3 * v + 2);
    inputs.at(2 * motion.size() + v) = std::sqrt(x * x + y * y + z * z);
  }
  return inputs;
}

void MeasureInputs(std::span<const TurnedExample> examples, TurnedClassifier& classifier) {
  const auto count = static_cast<double>(examples.size());
  Inputs sum{};
  Inputs squares{};
  for (const TurnedExample& example : examples) {
    const Inputs inputs = InputsOf(example.motion);
    for (std::size_t i = 0; i < kTurnedInputs; ++i) {
      sum[i] += inputs[i];
      squares[i] += inputs[i] * inputs[i];
    }
  }
  for (std::size_t i = 0; i < kTurnedInputs; ++i) {
    const double mean = sum[i] / count;
    const double variance = std::max(0.0, squares[i] / count - mean * mean);
    classifier.mean[i] = static_cast<float>(mean);
    classifier.deviation[i] =
        static_cast<float>(std::max(kLeastFeatureDeviation, std::sqrt(variance)));
  }
}

// Normalised inputs, and a 1 for the bias.
Eigen::VectorXd RowOf(const TurnedClassifier& classifier, const HandMotion& motion) {
  const Inputs inputs = InputsOf(motion);
  Eigen::VectorXd row(kUnknowns);
  for (std::size_t i = 0; i < kTurnedInputs; ++i)
    row[static_cast<Eigen::Index>(i)] =
        (inputs[i] - static_cast<double>(classifier.mean[i])) / classifier.deviation[i];
  row[kUnknowns - 1] = 1;
  return row;
}

std::array<float, kTurnedInputs> ArrayOf(const TensorFile& file, const std::string& name,
                                         const std::string& path) {
  const auto values =
      ValuesOf<float>(TensorNamed(file, name, path), {kTurnedInputs}, path + ": " + name);
  std::array<float, kTurnedInputs> array{};
  std::copy(values.begin(), values.end(), array.begin());
  return array;
}

void CheckNumbers(const TurnedClassifier& classifier, const std::string& path) {
  bool good = std::isfinite(classifier.bias);
  for (std::size_t i = 0; i < kTurnedInputs; ++i)
    good = good && std::isfinite(classifier.mean[i]) && std::isfinite(classifier.weight[i]) &&
           std::isfinite(classifier.deviation[i]) && classifier.deviation[i] > 0;
  if (!good)
    throw Error(ErrorCode::kFormat, path +
                                        ": holds a number that is not finite, or a deviation "
                                        "that is not positive");
}

}  // namespace

HandMotion HandMotionOf(const Proprioception& first, const Proprioception& now,
                        const ActionVector& action) {
  const Eigen::Matrix3d before = HandRotationOf(first).transpose();
  const Action target = FromVector(action);
  const Eigen::Vector3d way = (HandPositionOf(now) - HandPositionOf(first)).cast<double>();
  const std::array<Eigen::Vector3d, 4> vectors = {
      RotationVector(HandRotationOf(now) * before),
      RotationVector(target.world_from_hand_rotation * before), way, way + target.position_delta_m};
  HandMotion motion{};
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k)
      motion.at(3 * v + k) = static_cast<float>(vectors.at(v)[static_cast<Eigen::Index>(k)]);
  }
  return motion;
}

double TurnedClassifier::Probability(const HandMotion& motion) const {
  const Eigen::VectorXd row = RowOf(*this, motion);
  double score = bias;
  for (std::size_t i = 0; i < kTurnedInputs; ++i)
    score += weight[i] * row[static_cast<Eigen::Index>(i)];
  return internal::Logistic(score);
}

// A turn is mirrored as its axis is, which keeps y and turns x and z around; a way the other way
// about.
HandMotion MirroredSideways(const HandMotion& motion) {
  HandMotion mirrored = motion;
  for (const std::size_t odd : {0U, 2U, 3U, 5U, 7U, 10U}) mirrored.at(odd) = -mirrored.at(odd);
  return mirrored;
}

// As an axis, which keeps z, and as a way.
HandMotion MirroredUpright(const HandMotion& motion) {
  HandMotion mirrored = motion;
  for (const std::size_t odd : {0U, 1U, 3U, 4U, 8U, 11U}) mirrored.at(odd) = -mirrored.at(odd);
  return mirrored;
}

std::optional<TurnedClassifier> FitTurnedClassifier(std::span<const TurnedExample> examples) {
  const auto turned =
      std::ranges::count_if(examples, [](const TurnedExample& one) { return one.turned; });
  if (turned == 0 || std::cmp_equal(turned, examples.size())) return std::nullopt;
  TurnedClassifier classifier;
  MeasureInputs(examples, classifier);
  internal::LogisticProblem problem;
  for (const TurnedExample& example : examples) {
    problem.rows.push_back(RowOf(classifier, example.motion));
    problem.yes.push_back(example.turned);
  }
  problem.ridge = Eigen::VectorXd::Constant(kUnknowns, kRidge);
  problem.ridge[kUnknowns - 1] = 1e-9;  // the bias is free
  const Eigen::VectorXd found = internal::FitLogistic(problem);
  for (std::size_t i = 0; i < kTurnedInputs; ++i)
    classifier.weight[i] = static_cast<float>(found[static_cast<Eigen::Index>(i)]);
  classifier.bias = static_cast<float>(found[kUnknowns - 1]);
  return classifier;
}

TurnedAccuracy MeasureTurned(const TurnedClassifier& classifier,
                             std::span<const TurnedExample> examples) {
  TurnedAccuracy accuracy;
  for (const TurnedExample& example : examples) {
    const bool called = classifier.Probability(example.motion) >= 0.5;
    accuracy.called += called ? 1 : 0;
    accuracy.turned += example.turned ? 1 : 0;
    accuracy.correct += called && example.turned ? 1 : 0;
  }
  return accuracy;
}

void WriteTurnedClassifier(const fs::path& folder,
                           const std::optional<TurnedClassifier>& classifier,
                           const std::string& dataset_sha256) {
  if (!classifier) {
    fs::remove(folder / kClassifierFile);
    return;
  }
  TensorFile file;
  file.tensors["mean"] = MakeTensor<float>(classifier->mean, {kTurnedInputs});
  file.tensors["deviation"] = MakeTensor<float>(classifier->deviation, {kTurnedInputs});
  file.tensors["weight"] = MakeTensor<float>(classifier->weight, {kTurnedInputs});
  file.tensors["bias"] = MakeTensor<float>(std::span(&classifier->bias, 1), {1});
  file.metadata = {{"schema", kClassifierSchema},
                   {"schema_version", std::to_string(kTurnedSchemaVersion)},
                   {"dataset_sha256", dataset_sha256}};
  CommitFile(folder / kClassifierFile, EncodeTensors(file));
}

std::optional<TurnedClassifier> ReadTurnedClassifier(const fs::path& folder,
                                                     const std::string& dataset_sha256) {
  const std::string path = (folder / kClassifierFile).string();
  if (!fs::exists(path)) return std::nullopt;
  const TensorFile file = ReadTensors(path);
  internal::RequireCompanion(file, kClassifierKind, dataset_sha256, path);
  TurnedClassifier classifier;
  classifier.mean = ArrayOf(file, "mean", path);
  classifier.deviation = ArrayOf(file, "deviation", path);
  classifier.weight = ArrayOf(file, "weight", path);
  classifier.bias = ValuesOf<float>(TensorNamed(file, "bias", path), {1}, path + ": bias")[0];
  CheckNumbers(classifier, path);
  return classifier;
}

}  // namespace doorforge
