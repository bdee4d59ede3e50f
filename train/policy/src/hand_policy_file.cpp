// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/frozen_sight.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/hand_sight.h"

#include "whole_file.h"

namespace doorforge {
namespace {

using internal::WholeFile;

constexpr int kMostHidden = 4096;

// The numbers that the network reads and says are this build's, or the features of its sight.
MlpShape HandShapeFromJson(const nlohmann::ordered_json& json, const std::string& path,
                           int inputs = kHandFeatures) {
  const MlpShape shape{ValueOf<int>(json, "inputs", path), ValueOf<int>(json, "hidden", path),
                       ValueOf<int>(json, "outputs", path)};
  const bool fits = shape.inputs == inputs && shape.outputs == kHandActions && shape.hidden >= 1 &&
                    shape.hidden <= kMostHidden;
  if (!fits)
    throw Error(ErrorCode::kFormat, path + ": inputs, hidden and outputs must be " +
                                        std::to_string(inputs) + ", 1 to " +
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

nlohmann::ordered_json HandShapeToJson(const MlpShape& shape) {
  return {{"inputs", shape.inputs}, {"hidden", shape.hidden}, {"outputs", shape.outputs}};
}

nlohmann::ordered_json SightShapeToJson(const PointNetShape& shape) {
  nlohmann::ordered_json json;
  for (const auto& field : kSightSizes) json[field.name] = shape.*field.value;
  return json;
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
  json["sizes"] = HandShapeToJson(record.shape);
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
  json["sizes"] = SightShapeToJson(record.shape);
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

void WriteFrozenPolicy(const std::filesystem::path& folder, const FrozenPolicyRecord& record) {
  nlohmann::ordered_json json = internal::WriteWholeWeights(
      folder, {{"sight", PointNetLayout(record.sight_shape), record.sight},
               {"actor", MlpLayout(record.shape), record.parameters}});
  json["network"] = internal::kFrozenNetwork;
  json["sizes"] = HandShapeToJson(record.shape);
  json["sight_sizes"] = SightShapeToJson(record.sight_shape);
  json["task"] = ToJson(record.task);
  json["look"] = ToJson(record.look);
  json["provenance"] = internal::HandProvenanceToJson(record.provenance);
  internal::WriteWholeRecord(folder, json);
}

FrozenPolicyRecord ReadFrozenPolicy(const std::filesystem::path& folder) {
  const WholeFile file = internal::ReadWholeFile(folder);
  internal::RequireNetwork(file, internal::kFrozenNetwork);
  FrozenPolicyRecord record;
  record.sight_shape = SightShapeFromJson(file.Member("sight_sizes"), file.Path("sight_sizes"));
  record.shape = HandShapeFromJson(file.Member("sizes"), file.Path("sizes"),
                                   record.sight_shape.cloud_features + kSightOwn);
  record.look = internal::SettingsOfRecord<HandLook>(file, "look", CheckHandLook);
  FinishRecord(folder, file, MlpLayout(record.shape), record);
  record.sight = internal::ReadParameters(
      PointNetLayout(record.sight_shape), internal::NetworkPrefix("sight"),
      internal::ReadWholeWeights(folder, file), (folder / internal::kWholeWeights).string());
  return record;
}

}  // namespace doorforge
