// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/hand_sight.h"

#include "whole_file.h"

namespace doorforge {
namespace {

using internal::WholeFile;

constexpr int kMostHidden = 4096;

// The numbers that the network reads and says are this build's.
MlpShape HandShapeFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  const MlpShape shape{ValueOf<int>(json, "inputs", path), ValueOf<int>(json, "hidden", path),
                       ValueOf<int>(json, "outputs", path)};
  const bool fits = shape.inputs == kHandFeatures && shape.outputs == kHandActions &&
                    shape.hidden >= 1 && shape.hidden <= kMostHidden;
  if (!fits)
    throw Error(ErrorCode::kFormat, path + ": inputs, hidden and outputs must be " +
                                        std::to_string(kHandFeatures) + ", 1 to " +
                                        std::to_string(kMostHidden) + " and " +
                                        std::to_string(kHandActions));
  return shape;
}

template <class Shape>
struct ShapeField {
  const char* name;
  int Shape::*value;
  int most;
};
constexpr ShapeField<PointNetShape> kSightSizes[] = {
    {"point", &PointNetShape::point, kMostHidden},
    {"point_hidden", &PointNetShape::point_hidden, 256},
    {"point_features", &PointNetShape::point_features, kMostHidden},
    {"cloud_hidden", &PointNetShape::cloud_hidden, kMostHidden},
    {"cloud_features", &PointNetShape::cloud_features, kMostHidden},
    {"own", &PointNetShape::own, kMostHidden},
    {"hidden", &PointNetShape::hidden, kMostHidden},
    {"last_hidden", &PointNetShape::last_hidden, kMostHidden},
    {"outputs", &PointNetShape::outputs, kMostHidden}};

PointNetShape SightShapeFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  PointNetShape shape;
  for (const auto& field : kSightSizes) {
    shape.*field.value = ValueOf<int>(json, field.name, path);
    if (shape.*field.value < 1 || shape.*field.value > field.most)
      throw Error(ErrorCode::kFormat, path + "." + field.name + ": " +
                                          std::to_string(shape.*field.value) + ", expected 1 to " +
                                          std::to_string(field.most));
  }
  if (shape != SightShape(shape) || shape.point_features % 32 != 0)
    throw Error(ErrorCode::kFormat,
                path + ": point, own and outputs must be " + std::to_string(kSightPoint) + ", " +
                    std::to_string(kSightOwn) + " and " + std::to_string(kHandActions) +
                    ", and point_features a multiple of 32");
  return shape;
}

// Task, provenance and weights; the record's shape must be known.
template <class Record>
void FinishRecord(const std::filesystem::path& folder, const WholeFile& file,
                  const ParameterLayout& layout, Record& record) {
  record.weights_sha256 = ValueOf<std::string>(file.json, "weights_sha256", file.path);
  record.task = internal::SettingsOfRecord<HandTaskConfig>(file, "task", CheckHandTask);
  record.provenance =
      internal::HandProvenanceFromJson(file.Member("provenance"), file.Path("provenance"));
  record.parameters = internal::ReadParameters(layout, internal::NetworkPrefix("actor"),
                                               internal::ReadWholeWeights(folder, file),
                                               (folder / internal::kWholeWeights).string());
}

}  // namespace

void WriteHandPolicy(const std::filesystem::path& folder, const HandPolicyRecord& record) {
  nlohmann::ordered_json json =
      internal::WriteWholeWeights(folder, {{"actor", MlpLayout(record.shape), record.parameters}});
  json["sizes"] = {{"inputs", record.shape.inputs},
                   {"hidden", record.shape.hidden},
                   {"outputs", record.shape.outputs}};
  json["task"] = ToJson(record.task);
  json["provenance"] = internal::HandProvenanceToJson(record.provenance);
  internal::WriteWholeRecord(folder, json);
}

HandPolicyRecord ReadHandPolicy(const std::filesystem::path& folder) {
  const WholeFile file = internal::ReadWholeFile(folder);
  internal::RequireNetwork(file, "");
  HandPolicyRecord record;
  record.shape = HandShapeFromJson(file.Member("sizes"), file.Path("sizes"));
  FinishRecord(folder, file, MlpLayout(record.shape), record);
  return record;
}

void WriteSightPolicy(const std::filesystem::path& folder, const SightPolicyRecord& record) {
  nlohmann::ordered_json json = internal::WriteWholeWeights(
      folder, {{"actor", PointNetLayout(record.shape), record.parameters}});
  json["network"] = internal::kSightNetwork;
  for (const auto& field : kSightSizes) json["sizes"][field.name] = record.shape.*field.value;
  json["task"] = ToJson(record.task);
  json["look"] = ToJson(record.look);
  json["provenance"] = internal::HandProvenanceToJson(record.provenance);
  internal::WriteWholeRecord(folder, json);
}

SightPolicyRecord ReadSightPolicy(const std::filesystem::path& folder) {
  const WholeFile file = internal::ReadWholeFile(folder);
  internal::RequireNetwork(file, internal::kSightNetwork);
  SightPolicyRecord record;
  record.shape = SightShapeFromJson(file.Member("sizes"), file.Path("sizes"));
  record.look = internal::SettingsOfRecord<HandLook>(file, "look", CheckHandLook);
  FinishRecord(folder, file, PointNetLayout(record.shape), record);
  return record;
}

}  // namespace doorforge
