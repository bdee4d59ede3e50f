// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/hand_sight.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/schemas/safetensors.h"

namespace doorforge {
namespace {

constexpr const char* kHandWeights = "policy.safetensors";
constexpr const char* kHandRecord = "policy.json";
constexpr int kMostHidden = 4096;
constexpr const char* kSightNetwork = "point_net";

nlohmann::ordered_json HandProvenanceToJson(const HandProvenance& provenance) {
  nlohmann::ordered_json json = {{"method", provenance.method},
                                 {"config", ParseJson(provenance.config, "config")},
                                 {"code_version", provenance.code_version},
                                 {"decisions", provenance.decisions},
                                 {"trained_on", SeenPartsToJson(provenance.trained_on)}};
  if (!provenance.teacher_sha256.empty()) json["teacher_sha256"] = provenance.teacher_sha256;
  return json;
}

HandProvenance HandProvenanceFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  HandProvenance provenance;
  provenance.method = ValueOf<std::string>(json, "method", path);
  provenance.config = JsonText(MemberOf(json, "config", path));
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.decisions = ValueOf<std::uint64_t>(json, "decisions", path);
  provenance.trained_on =
      SeenPartsFromJson(MemberOf(json, "trained_on", path), path + ".trained_on");
  if (json.contains("teacher_sha256"))
    provenance.teacher_sha256 = ValueOf<std::string>(json, "teacher_sha256", path);
  return provenance;
}

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

// Settings of a record, checked.
template <class Settings>
Settings SettingsFromJson(const nlohmann::ordered_json& json, const std::string& path,
                          void (*check)(const Settings&, const std::string&)) {
  Settings settings;
  try {
    Assign(json, settings, path);
    check(settings, path);
  } catch (const Error& error) {
    throw Error(ErrorCode::kFormat, error.what());
  }
  return settings;
}

// What both kinds of record have in common.
struct WholeFile {
  std::string path;
  nlohmann::ordered_json json;

  nlohmann::ordered_json Member(const char* name) const { return MemberOf(json, name, path); }
  std::string Path(const char* name) const { return path + "." + name; }
  bool Looks() const { return json.contains("network"); }
};

WholeFile ReadWholeFile(const std::filesystem::path& folder) {
  WholeFile file{(folder / kHandRecord).string(), {}};
  file.json = ReadJsonFile(file.path);
  RequireSchema(file.json, "doorforge.policy", kPolicySchemaVersion, file.path);
  const auto stage = ValueOf<std::string>(file.json, "stage", file.path);
  if (stage != kWholeStage)
    throw Error(ErrorCode::kFormat, file.path + ": a policy of the stage \"" + stage +
                                        "\", where one that does the whole episode is needed: "
                                        "`doorforge reinforce` makes such");
  if (file.Looks() && ValueOf<std::string>(file.json, "network", file.path) != kSightNetwork)
    throw Error(ErrorCode::kFormat, file.Path("network") + ": expected \"" + kSightNetwork + '"');
  return file;
}

// The weights that belong to a record.
std::vector<float> ReadWholeWeights(const std::filesystem::path& folder, const WholeFile& file,
                                    const std::string& sha256, const ParameterLayout& layout) {
  const std::string path = (folder / kHandWeights).string();
  const std::string weights = ReadFile(path);
  if (Sha256Hex(weights) != sha256)
    throw Error(ErrorCode::kFormat, path + ": its SHA-256 is not the one in " + file.path +
                                        "; run the training again with --resume");
  return internal::ReadParameters(layout, internal::NetworkPrefix("actor"),
                                  DecodeTensors(weights, path), path);
}

// Task, provenance and weights; the record's shape must be known.
template <class Record>
void FinishRecord(const std::filesystem::path& folder, const WholeFile& file,
                  const ParameterLayout& layout, Record& record) {
  record.weights_sha256 = ValueOf<std::string>(file.json, "weights_sha256", file.path);
  record.task =
      SettingsFromJson<HandTaskConfig>(file.Member("task"), file.Path("task"), CheckHandTask);
  record.provenance = HandProvenanceFromJson(file.Member("provenance"), file.Path("provenance"));
  record.parameters = ReadWholeWeights(folder, file, record.weights_sha256, layout);
}

// Writes the weights, and begins the record with what says so.
nlohmann::ordered_json WriteWholeWeights(const std::filesystem::path& folder,
                                         const ParameterLayout& layout,
                                         const std::vector<float>& parameters) {
  TensorFile file;
  internal::AddParameters(layout, internal::NetworkPrefix("actor"), parameters, MakeTensor<float>,
                          file);
  const std::string weights = EncodeTensors(file);
  CommitFile(folder / kHandWeights, weights);
  return {{"schema", "doorforge.policy"},
          {"schema_version", kPolicySchemaVersion},
          {"stage", kWholeStage},
          {"weights", kHandWeights},
          {"weights_sha256", Sha256Hex(weights)}};
}

// Begins so near to the handle, whoever acts.
std::string StartPrivilege(const HandTaskConfig& task) {
  char text[96];
  std::snprintf(text, sizeof text, "begins %.2g m before the handle's true grasp",
                task.start_distance_m);
  return text;
}

}  // namespace

void WriteHandPolicy(const std::filesystem::path& folder, const HandPolicyRecord& record) {
  nlohmann::ordered_json json =
      WriteWholeWeights(folder, MlpLayout(record.shape), record.parameters);
  json["sizes"] = {{"inputs", record.shape.inputs},
                   {"hidden", record.shape.hidden},
                   {"outputs", record.shape.outputs}};
  json["task"] = ToJson(record.task);
  json["provenance"] = HandProvenanceToJson(record.provenance);
  WriteJsonFile(folder / kHandRecord, json);
}

HandPolicyRecord ReadHandPolicy(const std::filesystem::path& folder) {
  const WholeFile file = ReadWholeFile(folder);
  if (file.Looks())
    throw Error(ErrorCode::kFormat,
                file.path +
                    ": a policy that looks, where one of true states is needed: "
                    "`doorforge reinforce` without --teacher makes such");
  HandPolicyRecord record;
  record.shape = HandShapeFromJson(file.Member("sizes"), file.Path("sizes"));
  FinishRecord(folder, file, MlpLayout(record.shape), record);
  return record;
}

void WriteSightPolicy(const std::filesystem::path& folder, const SightPolicyRecord& record) {
  nlohmann::ordered_json json =
      WriteWholeWeights(folder, PointNetLayout(record.shape), record.parameters);
  json["network"] = kSightNetwork;
  for (const auto& field : kSightSizes) json["sizes"][field.name] = record.shape.*field.value;
  json["task"] = ToJson(record.task);
  json["look"] = ToJson(record.look);
  json["provenance"] = HandProvenanceToJson(record.provenance);
  WriteJsonFile(folder / kHandRecord, json);
}

SightPolicyRecord ReadSightPolicy(const std::filesystem::path& folder) {
  const WholeFile file = ReadWholeFile(folder);
  if (!file.Looks())
    throw Error(ErrorCode::kFormat,
                file.path +
                    ": a policy of true states, where one that looks is needed: "
                    "`doorforge reinforce --teacher` makes such");
  SightPolicyRecord record;
  record.shape = SightShapeFromJson(file.Member("sizes"), file.Path("sizes"));
  record.look = SettingsFromJson<HandLook>(file.Member("look"), file.Path("look"), CheckHandLook);
  FinishRecord(folder, file, PointNetLayout(record.shape), record);
  return record;
}

WholePolicy ReadWholePolicy(const std::filesystem::path& folder) {
  const auto whole = [](const auto& record, std::unique_ptr<HandPolicy> policy,
                        const char* privilege) {
    return WholePolicy{std::move(policy),
                       record.weights_sha256,
                       record.provenance,
                       {privilege, StartPrivilege(record.task)}};
  };
  if (ReadWholeFile(folder).Looks()) {
    const SightPolicyRecord record = ReadSightPolicy(folder);
    return whole(record, std::make_unique<HandSightPolicy>(record),
                 "is told of which part each point is: handle, leaf, frame or robot");
  }
  const HandPolicyRecord record = ReadHandPolicy(folder);
  return whole(record, std::make_unique<HandNetworkPolicy>(record),
               "is told the true states of hinge, handle and latch, and where the grasp is");
}

}  // namespace doorforge
