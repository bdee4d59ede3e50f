// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/side_classifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/schemas/mirror.h"
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
constexpr double kLeastScale = 0.05;  // so that what hardly varies is not blown up

LabelledCloud NearestFirst(std::span<const float> xyz, const Eigen::Vector3f& hand_m) {
  LabelledCloud cloud;
  cloud.xyz.assign(xyz.begin(), xyz.end());
  std::size_t nearest = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const float distance = (Eigen::Vector3f(xyz[i], xyz[i + 1], xyz[i + 2]) - hand_m).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) std::swap(cloud.xyz[k], cloud.xyz[nearest + k]);
  return cloud;
}

SightNumbers SightFrom(const LabelledCloud& cloud, const Eigen::Vector3f& hand_m) {
  Proprioception proprioception{};
  std::copy(hand_m.begin(), hand_m.end(), proprioception.begin() + 25);
  return SightNumbersOf({cloud.xyz, {}}, proprioception, NetworkFamily::kMotion);
}

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
  const LabelledCloud seen = NearestFirst(door_xyz, hand_m);
  SideNumbers numbers = SightFrom(seen, hand_m);
  const SightNumbers mirrored =
      SightFrom(MirroredSideways(seen), hand_m.cwiseProduct(Eigen::Vector3f(1, -1, 1)));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] -= mirrored[i];
  return numbers;
}

double SideClassifier::LogOddsOfLeft(const SideNumbers& numbers) const {
  Require(numbers.size() == weight.size(), ErrorCode::kInvalidArgument,
          std::to_string(numbers.size()) + " numbers about a door's side, expected " +
              std::to_string(weight.size()));
  double sum = 0;
  for (std::size_t i = 0; i < weight.size(); ++i)
    sum += static_cast<double>(weight[i]) * static_cast<double>(numbers[i]);
  return sum;
}

std::optional<SideClassifier> FitSideClassifier(std::span<const SideExample> examples) {
  if (examples.size() < kLeastExamples) return std::nullopt;
  const auto size = static_cast<Eigen::Index>(examples.front().numbers.size());
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
  return SideClassifier{{weights.begin(), weights.end()}};
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
  SideClassifier classifier{ValuesOf<float>(
      TensorNamed(file, "weight", path), {SightSize(NetworkFamily::kMotion)}, path + ": weight")};
  if (!std::ranges::all_of(classifier.weight, [](float one) { return std::isfinite(one); }))
    throw Error(ErrorCode::kFormat, path + ": weight holds a number that is not finite");
  return classifier;
}

}  // namespace doorforge
