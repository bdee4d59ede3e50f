// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/schemas/safetensors.h"

namespace doorforge {
namespace {

constexpr const char* kHandWeights = "policy.safetensors";
constexpr const char* kHandRecord = "policy.json";
constexpr int kMostHidden = 4096;

nlohmann::ordered_json HandProvenanceToJson(const HandProvenance& provenance) {
  return {{"method", provenance.method},
          {"config", ParseJson(provenance.config, "config")},
          {"code_version", provenance.code_version},
          {"decisions", provenance.decisions},
          {"trained_on", SeenPartsToJson(provenance.trained_on)}};
}

HandProvenance HandProvenanceFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  HandProvenance provenance;
  provenance.method = ValueOf<std::string>(json, "method", path);
  provenance.config = JsonText(MemberOf(json, "config", path));
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.decisions = ValueOf<std::uint64_t>(json, "decisions", path);
  provenance.trained_on =
      SeenPartsFromJson(MemberOf(json, "trained_on", path), path + ".trained_on");
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

HandTaskConfig HandTaskFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  HandTaskConfig task;
  try {
    Assign(json, task, path);
    CheckHandTask(task, path);
  } catch (const Error& error) {
    throw Error(ErrorCode::kFormat, error.what());
  }
  return task;
}

}  // namespace

void WriteHandPolicy(const std::filesystem::path& folder, const HandPolicyRecord& record) {
  TensorFile file;
  internal::AddParameters(MlpLayout(record.shape), internal::NetworkPrefix("actor"),
                          record.parameters, MakeTensor<float>, file);
  const std::string weights = EncodeTensors(file);
  CommitFile(folder / kHandWeights, weights);
  WriteJsonFile(folder / kHandRecord, {{"schema", "doorforge.policy"},
                                       {"schema_version", kPolicySchemaVersion},
                                       {"stage", kWholeStage},
                                       {"weights", kHandWeights},
                                       {"weights_sha256", Sha256Hex(weights)},
                                       {"sizes",
                                        {{"inputs", record.shape.inputs},
                                         {"hidden", record.shape.hidden},
                                         {"outputs", record.shape.outputs}}},
                                       {"task", ToJson(record.task)},
                                       {"provenance", HandProvenanceToJson(record.provenance)}});
}

HandPolicyRecord ReadHandPolicy(const std::filesystem::path& folder) {
  const std::string path = (folder / kHandRecord).string();
  const nlohmann::ordered_json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.policy", kPolicySchemaVersion, path);
  const auto stage = ValueOf<std::string>(json, "stage", path);
  if (stage != kWholeStage)
    throw Error(ErrorCode::kFormat, path + ": a policy of the stage \"" + stage +
                                        "\", where one that does the whole episode is needed: "
                                        "`doorforge reinforce` makes such");
  HandPolicyRecord record;
  record.weights_sha256 = ValueOf<std::string>(json, "weights_sha256", path);
  record.shape = HandShapeFromJson(MemberOf(json, "sizes", path), path + ".sizes");
  record.task = HandTaskFromJson(MemberOf(json, "task", path), path + ".task");
  record.provenance =
      HandProvenanceFromJson(MemberOf(json, "provenance", path), path + ".provenance");
  const std::string weights_path = (folder / kHandWeights).string();
  const std::string weights = ReadFile(weights_path);
  if (Sha256Hex(weights) != record.weights_sha256)
    throw Error(ErrorCode::kFormat, weights_path + ": its SHA-256 is not the one in " + path +
                                        "; run the training again with --resume");
  record.parameters =
      internal::ReadParameters(MlpLayout(record.shape), internal::NetworkPrefix("actor"),
                               DecodeTensors(weights, weights_path), weights_path);
  return record;
}

}  // namespace doorforge
