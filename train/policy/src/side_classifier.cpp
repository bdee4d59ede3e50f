// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/side_classifier.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/safetensors.h"

#include "logistic_regression.h"
#include "policy_companion.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSideFile = "side.safetensors";
constexpr const char* kSideSchema = "doorforge.side";
constexpr internal::CompanionKind kSideKind{kSideSchema, kSideSchemaVersion,
                                            "run the policy's training again with --resume"};
constexpr std::size_t kLeastExamples = 20;
constexpr double kSideRidge = 1;
constexpr std::array<float, 3> kSideRadii = {0.12F, 0.3F, 0.8F};  // [m]
constexpr double kLeastScale = 0.05;  // so that what hardly varies is not blown up

Eigen::VectorXd ScalesOf(std::span<const SideExample> examples, Eigen::Index size) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(size);
  for (const SideExample& example : examples)
    squares +=
        Eigen::Map<const Eigen::VectorXf>(example.numbers.data(), size).cast<double>().cwiseAbs2();
  return (squares / static_cast<double>(examples.size())).cwiseSqrt().cwiseMax(kLeastScale);
}

}  // namespace

SideNumbers SideNumbersOf(std::span<const float> door_xyz, const Eigen::Vector3f& hand_m) {
  Require(door_xyz.size() >= 3, ErrorCode::kInvalidArgument, "a door without a point");
  SideNumbers numbers{};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const float within_m = kSideRadii.at(k);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i + 2 < door_xyz.size(); i += 3) {
      const Eigen::Vector3f point(door_xyz[i], door_xyz[i + 1], door_xyz[i + 2]);
      const Eigen::Vector3f from_hand = point - hand_m;
      if (from_hand.squaredNorm() >= within_m * within_m) continue;
      sum += static_cast<double>(from_hand.y());
      ++count;
    }
    numbers.at(k) = static_cast<float>(sum / std::max(1, count)) / within_m;
  }
  return numbers;
}

double SideClassifier::LogOddsOfLeft(const SideNumbers& numbers) const {
  double sum = 0;
  for (std::size_t i = 0; i < weight.size(); ++i)
    sum += static_cast<double>(weight.at(i)) * static_cast<double>(numbers.at(i));
  return sum;
}

std::optional<SideClassifier> FitSideClassifier(std::span<const SideExample> examples) {
  if (examples.size() < kLeastExamples) return std::nullopt;
  constexpr Eigen::Index size = std::tuple_size_v<SideNumbers>;
  const Eigen::VectorXd scales = ScalesOf(examples, size);
  internal::LogisticProblem problem;
  problem.ridge = Eigen::VectorXd::Constant(size, kSideRidge);
  for (const SideExample& example : examples) {
    problem.rows.emplace_back(Eigen::Map<const Eigen::VectorXf>(example.numbers.data(), size)
                                  .cast<double>()
                                  .cwiseQuotient(scales));
    problem.yes.push_back(example.side == HingeSide::kLeft);
  }
  const Eigen::VectorXf weights =
      internal::FitLogistic(problem).cwiseQuotient(scales).cast<float>();
  SideClassifier classifier;
  std::copy(weights.begin(), weights.end(), classifier.weight.begin());
  return classifier;
}

void WriteSideClassifier(const fs::path& folder, const std::optional<SideClassifier>& classifier,
                         const std::string& dataset_sha256) {
  if (!classifier) {
    fs::remove(folder / kSideFile);
    return;
  }
  TensorFile file;
  file.tensors["weight"] = MakeTensor<float>(classifier->weight, {classifier->weight.size()});
  file.metadata = {{"schema", kSideSchema},
                   {"schema_version", std::to_string(kSideSchemaVersion)},
                   {"dataset_sha256", dataset_sha256}};
  CommitFile(folder / kSideFile, EncodeTensors(file));
}

std::optional<SideClassifier> ReadSideClassifier(const fs::path& folder) {
  const std::string path = (folder / kSideFile).string();
  if (!fs::exists(path)) return std::nullopt;
  const TensorFile file = ReadTensors(path);
  const auto data = file.metadata.find("dataset_sha256");
  internal::RequireCompanion(file, kSideKind, data == file.metadata.end() ? "" : data->second,
                             path);
  SideClassifier classifier;
  const auto weight = ValuesOf<float>(TensorNamed(file, "weight", path), {classifier.weight.size()},
                                      path + ": weight");
  std::copy(weight.begin(), weight.end(), classifier.weight.begin());
  if (!std::ranges::all_of(classifier.weight, [](float one) { return std::isfinite(one); }))
    throw Error(ErrorCode::kFormat, path + ": weight holds a number that is not finite");
  return classifier;
}

}  // namespace doorforge
