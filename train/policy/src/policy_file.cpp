// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/policy_file.h"

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/network_tensors.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/schemas/safetensors.h"
#include "doorforge/schemas/stage_content.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kWeightsFile = "policy.safetensors";
constexpr const char* kRecordFile = "policy.json";

Json ProvenanceToJson(const PolicyProvenance& provenance) {
  Json json = {{"config", ToJson(provenance.config)},
               {"config_sha256", ConfigHash(provenance.config)},
               {"dataset_sha256", provenance.dataset_sha256},
               {"code_version", provenance.code_version},
               {"seed", provenance.config.seed},
               {"step", provenance.step}};
  if (!provenance.from_weights_sha256.empty())
    json["from_weights_sha256"] = provenance.from_weights_sha256;
  if (provenance.best != BestEpochs{}) {
    const NetworkNames names = NamesOf(provenance.config.family);
    json["best_epoch"] = {{names.actor, provenance.best.actor},
                          {names.critic, provenance.best.critic}};
  }
  json["trained_on"] = SeenPartsToJson(provenance.trained_on);
  return json;
}

PolicyProvenance ProvenanceFromJson(const Json& json, NetworkFamily family,
                                    const std::string& path) {
  PolicyProvenance provenance;
  provenance.config.family = family;
  try {
    Assign(MemberOf(json, "config", path), provenance.config, path + ".config");
  } catch (const Error& error) {
    throw Error(ErrorCode::kFormat, error.what());
  }
  provenance.dataset_sha256 = ValueOf<std::string>(json, "dataset_sha256", path);
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.step = ValueOf<std::uint64_t>(json, "step", path);
  if (json.contains("from_weights_sha256"))
    provenance.from_weights_sha256 = ValueOf<std::string>(json, "from_weights_sha256", path);
  if (json.contains("best_epoch")) {
    const NetworkNames names = NamesOf(family);
    const Json& best = json["best_epoch"];
    provenance.best = {ValueOf<int>(best, names.actor, path + ".best_epoch"),
                       ValueOf<int>(best, names.critic, path + ".best_epoch")};
  }
  if (json.contains("trained_on"))
    provenance.trained_on =
        SeenPartsFromJson(MemberOf(json, "trained_on", path), path + ".trained_on");
  return provenance;
}

}  // namespace

std::string ConfigHash(const TrainConfig& config) { return Sha256Hex(JsonText(ToJson(config))); }

void WritePolicy(const fs::path& folder, const StageNetworks& networks,
                 const PolicyProvenance& provenance) {
  Require(networks.norm == EncoderNorm::kNone, ErrorCode::kInvalidArgument,
          "a policy's normalised layers must be folded, see PolicyOf()");
  const std::string weights = EncodeTensors(internal::WeightsOf(networks, MakeHalfTensor));
  CommitFile(folder / kWeightsFile, weights);
  Json json = {{"schema", "doorforge.policy"},
               {"schema_version", kPolicySchemaVersion},
               {"stage", provenance.stage},
               {"weights", kWeightsFile},
               {"weights_sha256", Sha256Hex(weights)},
               {"sizes",
                {{"cloud_points", kCloudPoints},
                 {"feature", kFeatureSize},
                 {"state", 18},
                 {"action", 9},
                 {"latent", kLatentSize}}},
               {"linear_branches", networks.linear_branches},
               {"normalisation", NormalisationToJson(networks.normalisation)},
               {"provenance", ProvenanceToJson(provenance)}};
  WriteJsonFile(folder / kRecordFile, json);
}

PolicyRecord ReadPolicy(const fs::path& folder, std::string_view stage) {
  const std::string path = (folder / kRecordFile).string();
  const Json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.policy", kPolicySchemaVersion, path);
  const auto found = ValueOf<std::string>(json, "stage", path);
  if (!ActsAt(found, stage))
    throw Error(ErrorCode::kFormat, path + ": a policy of the stage \"" + found +
                                        "\", where one of the stage \"" + std::string(stage) +
                                        "\" is needed");
  PolicyRecord record;
  record.weights_sha256 = ValueOf<std::string>(json, "weights_sha256", path);
  record.networks.family = FamilyOf(found);
  record.networks.linear_branches = ValueOf<bool>(json, "linear_branches", path);
  record.networks.normalisation =
      NormalisationFromJson(MemberOf(json, "normalisation", path), path + ".normalisation");
  record.provenance = ProvenanceFromJson(MemberOf(json, "provenance", path), record.networks.family,
                                         path + ".provenance");
  record.provenance.stage = found;

  const std::string weights_path = (folder / kWeightsFile).string();
  const std::string weights = ReadFile(weights_path);
  if (Sha256Hex(weights) != record.weights_sha256)
    throw Error(ErrorCode::kFormat, weights_path + ": its SHA-256 is not the one in " + path +
                                        "; run the training again with --resume");
  TensorFile file = DecodeTensors(weights, weights_path);
  internal::AddMissingPosterior(record.networks, file);
  internal::ReadWeights(file, weights_path, record.networks);
  return record;
}

}  // namespace doorforge
