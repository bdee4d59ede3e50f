// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "whole_file.h"

#include <array>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/hash.h"
#include "doorforge/networks/network_tensors.h"
#include "doorforge/policy/policy_file.h"

namespace doorforge::internal {
namespace {

struct WholeKind {
  std::string network;
  const char* what;
  const char* made_by;
};
const std::array<WholeKind, 4> kWholeKinds = {
    {{"", "of true states", "`doorforge reinforce`"},
     {kSightNetwork, "that looks", "`doorforge reinforce --teacher`"},
     {kFrozenNetwork, "that acts on features", "`doorforge reinforce --features`"},
     {kTrajectoryNetwork, "that says trajectories", "`doorforge reinforce --trajectories`"}}};

const WholeKind& KindOf(const WholeFile& file, const std::string& network) {
  for (const WholeKind& kind : kWholeKinds)
    if (kind.network == network) return kind;
  throw Error(ErrorCode::kFormat, file.Path("network") + ": found \"" + network +
                                      "\", expected \"" + kSightNetwork + "\", \"" +
                                      kFrozenNetwork + "\" or \"" + kTrajectoryNetwork + '"');
}

}  // namespace

WholeFile ReadWholeFile(const std::filesystem::path& folder) {
  WholeFile file{(folder / kWholeRecord).string(), {}, ""};
  file.json = ReadJsonFile(file.path);
  RequireSchema(file.json, "doorforge.policy", kPolicySchemaVersion, file.path);
  const auto stage = ValueOf<std::string>(file.json, "stage", file.path);
  if (stage != kWholeStage)
    throw Error(ErrorCode::kFormat, file.path + ": a policy of the stage \"" + stage +
                                        "\", where one that does the whole episode is needed: "
                                        "`doorforge reinforce` makes such");
  if (file.json.contains("network"))
    file.network = ValueOf<std::string>(file.json, "network", file.path);
  KindOf(file, file.network);
  return file;
}

void RequireNetwork(const WholeFile& file, const std::string& network) {
  if (file.network == network) return;
  const WholeKind& needed = KindOf(file, network);
  throw Error(ErrorCode::kFormat, file.path + ": a policy " + KindOf(file, file.network).what +
                                      ", where one " + needed.what +
                                      " is needed: " + needed.made_by + " makes such");
}

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

TensorFile ReadWholeWeights(const std::filesystem::path& folder, const WholeFile& file) {
  const std::string path = (folder / kWholeWeights).string();
  const std::string weights = ReadFile(path);
  if (Sha256Hex(weights) != ValueOf<std::string>(file.json, "weights_sha256", file.path))
    throw Error(ErrorCode::kFormat, path + ": its SHA-256 is not the one in " + file.path +
                                        "; run the training again with --resume");
  return DecodeTensors(weights, path);
}

nlohmann::ordered_json WriteWholeWeights(const std::filesystem::path& folder,
                                         std::initializer_list<NamedParameters> networks) {
  TensorFile file;
  for (const NamedParameters& network : networks)
    AddParameters(network.layout, NetworkPrefix(network.name), network.parameters,
                  doorforge::MakeTensor<float>, file);
  const std::string weights = EncodeTensors(file);
  CommitFile(folder / kWholeWeights, weights);
  return {{"schema", "doorforge.policy"},
          {"schema_version", kPolicySchemaVersion},
          {"stage", kWholeStage},
          {"weights", kWholeWeights},
          {"weights_sha256", Sha256Hex(weights)}};
}

void WriteWholeRecord(const std::filesystem::path& folder, const nlohmann::ordered_json& json) {
  WriteJsonFile(folder / kWholeRecord, json);
}

}  // namespace doorforge::internal
