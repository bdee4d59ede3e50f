// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/training_curves.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/json_numbers.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCurvesFile = "losses.json";
constexpr const char* kCurvesSchema = "doorforge.losses";

}  // namespace

void WriteTrainingCurves(const fs::path& folder, const std::vector<TrainingCurve>& curves) {
  Json array = Json::array();
  for (const TrainingCurve& curve : curves)
    array.push_back({{"name", curve.name},
                     {"epoch", NumbersToJson(curve.epoch)},
                     {"train", NumbersToJson(curve.train)},
                     {"validation", NumbersToJson(curve.validation)}});
  WriteJsonFile(
      folder / kCurvesFile,
      {{"schema", kCurvesSchema}, {"schema_version", kLossesSchemaVersion}, {"curves", array}});
}

std::vector<TrainingCurve> ReadTrainingCurves(const fs::path& folder) {
  const std::string path = (folder / kCurvesFile).string();
  const Json json = ReadJsonFile(path);
  RequireSchema(json, kCurvesSchema, kLossesSchemaVersion, path);
  const Json& array = MemberOf(json, "curves", path);
  if (!array.is_array()) throw Error(ErrorCode::kFormat, path + ".curves: expected an array");
  std::vector<TrainingCurve> curves;
  for (const Json& entry : array) {
    TrainingCurve curve;
    curve.name = ValueOf<std::string>(entry, "name", path);
    curve.epoch = NumbersFromJson(MemberOf(entry, "epoch", path), path);
    curve.train = NumbersFromJson(MemberOf(entry, "train", path), path);
    curve.validation = NumbersFromJson(MemberOf(entry, "validation", path), path);
    if (curve.train.size() != curve.epoch.size() || curve.validation.size() != curve.epoch.size())
      throw Error(ErrorCode::kFormat, path + ": the columns of a curve differ in length");
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace doorforge
