// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/schemas/safetensors.h"

#include "policy_companion.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "familiar.safetensors";
constexpr const char* kSchema = "doorforge.familiar";
constexpr internal::CompanionKind kKind{kSchema, kFamiliarSchemaVersion,
                                        "run the policy's training again with --resume"};
constexpr std::uint64_t kMostDistances = 1U << 20U;

std::vector<float> NumbersOf(const TensorFile& file, const std::string& name,
                             const std::vector<std::uint64_t>& shape, const std::string& path) {
  std::vector<float> numbers =
      ValuesOf<float>(TensorNamed(file, name, path), shape, path + ": " + name);
  if (!std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); }))
    throw Error(ErrorCode::kFormat, path + ": " + name + " holds a number that is not finite");
  return numbers;
}

std::vector<float> DistancesOf(const TensorFile& file, const std::string& path) {
  const Tensor& tensor = TensorNamed(file, "distances", path);
  const std::uint64_t count = tensor.shape.empty() ? 0 : tensor.shape[0];
  std::vector<float> distances = NumbersOf(file, "distances", {count}, path);
  if (count < 2 || count > kMostDistances || distances.front() < 0 ||
      !std::ranges::is_sorted(distances))
    throw Error(ErrorCode::kFormat,
                path + ": distances: expected at least two that ascend, none of them negative");
  return distances;
}

}  // namespace

void WriteFamiliarity(const fs::path& folder, const std::optional<Familiarity>& familiarity,
                      const std::string& dataset_sha256) {
  if (!familiarity) {
    fs::remove(folder / kFile);
    return;
  }
  const std::uint64_t size = familiarity->mean.size();
  TensorFile file;
  file.tensors["mean"] = MakeTensor<float>(familiarity->mean, {size});
  file.tensors["whitening"] = MakeTensor<float>(familiarity->whitening, {size, size});
  file.tensors["distances"] =
      MakeTensor<float>(familiarity->distances, {familiarity->distances.size()});
  file.metadata = {{"schema", kSchema},
                   {"schema_version", std::to_string(kFamiliarSchemaVersion)},
                   {"dataset_sha256", dataset_sha256}};
  CommitFile(folder / kFile, EncodeTensors(file));
}

std::optional<Familiarity> ReadFamiliarity(const fs::path& folder,
                                           const std::string& dataset_sha256,
                                           NetworkFamily family) {
  const std::string path = (folder / kFile).string();
  if (!fs::exists(path)) return std::nullopt;
  const TensorFile file = ReadTensors(path);
  internal::RequireCompanion(file, kKind, dataset_sha256, path);
  const std::uint64_t size = SightSize(family);
  Familiarity familiarity;
  familiarity.mean = NumbersOf(file, "mean", {size}, path);
  familiarity.whitening = NumbersOf(file, "whitening", {size, size}, path);
  familiarity.distances = DistancesOf(file, path);
  return familiarity;
}

}  // namespace doorforge
