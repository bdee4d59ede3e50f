// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/door_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/safetensors.h"

#include "policy_companion.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeightsFile = "heights.safetensors";
constexpr const char* kHeightsSchema = "doorforge.heights";
constexpr internal::CompanionKind kHeightsKind{kHeightsSchema, kHeightsSchemaVersion,
                                               "run the policy's training again with --resume"};
constexpr std::size_t kLeastDoors = 20;
constexpr double kLeftOut = 0.02;  // of the numbers, at either end

// Where the numbers begin and end but for a share at either end.
std::array<double, 2> MostOf(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const auto skipped = static_cast<std::size_t>(kLeftOut * static_cast<double>(numbers.size()));
  return {numbers[skipped], numbers[numbers.size() - 1 - skipped]};
}

}  // namespace

double HeightInView(std::span<const float> door_xyz) {
  Require(door_xyz.size() >= 3, ErrorCode::kInvalidArgument, "a door without a point");
  std::vector<double> z;
  for (std::size_t i = 2; i < door_xyz.size(); i += 3)
    z.push_back(static_cast<double>(door_xyz[i]));
  const auto [low, high] = MostOf(std::move(z));
  return high - low;
}

std::optional<LearnedHeights> FitHeights(std::span<const double> heights_m) {
  if (heights_m.size() < kLeastDoors) return std::nullopt;
  const auto [least, most] = MostOf({heights_m.begin(), heights_m.end()});
  return LearnedHeights{least, most};
}

void WriteHeights(const fs::path& folder, const std::optional<LearnedHeights>& heights,
                  const std::string& dataset_sha256) {
  if (!heights) {
    fs::remove(folder / kHeightsFile);
    return;
  }
  TensorFile file;
  const std::array<float, 2> ends = {static_cast<float>(heights->least_m),
                                     static_cast<float>(heights->most_m)};
  file.tensors["height_m"] = MakeTensor<float>(ends, {ends.size()});
  file.metadata = {{"schema", kHeightsSchema},
                   {"schema_version", std::to_string(kHeightsSchemaVersion)},
                   {"dataset_sha256", dataset_sha256}};
  CommitFile(folder / kHeightsFile, EncodeTensors(file));
}

std::optional<LearnedHeights> ReadHeights(const fs::path& folder) {
  const std::string path = (folder / kHeightsFile).string();
  if (!fs::exists(path)) return std::nullopt;
  const TensorFile file = ReadTensors(path);
  const auto data = file.metadata.find("dataset_sha256");
  internal::RequireCompanion(file, kHeightsKind, data == file.metadata.end() ? "" : data->second,
                             path);
  const auto ends = ValuesOf<float>(TensorNamed(file, "height_m", path), {2}, path + ": height_m");
  const LearnedHeights heights{static_cast<double>(ends[0]), static_cast<double>(ends[1])};
  if (!(heights.least_m > 0 && heights.least_m <= heights.most_m && std::isfinite(heights.most_m)))
    throw Error(ErrorCode::kFormat,
                path + ": height_m: expected two heights above 0, the lesser first");
  return heights;
}

}  // namespace doorforge
