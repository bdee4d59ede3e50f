// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/trained_policy.h"

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/networks/instruction_set.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/schemas/stage_content.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Policies that do not say so have none.
int CloudPointsOf(const nlohmann::ordered_json& json, const std::string& path) {
  if (!json.contains("sizes") || !json["sizes"].contains("cloud_points")) return 0;
  return ValueOf<int>(json["sizes"], "cloud_points", path + ".sizes");
}

// Policies of the stage "handle" may remember; their record says what.
RememberedViewConfig RememberedOf(const nlohmann::ordered_json& json, const std::string& path) {
  RememberedViewConfig remembered{.resolution_scale = 0};
  if (!json.contains("normalisation") || !json["normalisation"].contains("remembered_finer"))
    return remembered;
  const nlohmann::ordered_json& view = json["normalisation"];
  remembered.resolution_scale = ValueOf<int>(view, "remembered_finer", path + ".normalisation");
  remembered.crop_radius_m = ValueOf<double>(view, "cloud_within_m", path + ".normalisation");
  CheckRememberedView(remembered);
  return remembered;
}

}  // namespace

TrainedPolicy ReadTrainedPolicy(const fs::path& folder, Stage stage, const std::string& role) {
  const fs::path path = folder / "policy.json";
  if (!fs::is_regular_file(path))
    throw Error(ErrorCode::kMissing, folder.string() + ": no policy here (no policy.json); --" +
                                         role + " takes the folder that `doorforge train " +
                                         std::string(NameOf(stage)) + "` wrote");
  const nlohmann::ordered_json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.policy", kPolicySchemaVersion, path.string());
  const auto found = ValueOf<std::string>(json, "stage", path.string());
  if (!ActsAt(found, NameOf(stage)))
    throw Error(ErrorCode::kInvalidArgument, path.string() + ": a policy of the stage \"" + found +
                                                 "\"; --" + role + " takes one of the stage \"" +
                                                 std::string(NameOf(stage)) + '"');
  TrainedPolicy policy{stage,
                       folder,
                       {found, Sha256OfFile(path), {}, {}, {}},
                       role,
                       CloudPointsOf(json, path.string()),
                       RememberedOf(json, path.string())};
  DatasetPolicy& identity = policy.identity;
  identity.weights_sha256 = ValueOf<std::string>(json, "weights_sha256", path.string());
  const fs::path weights = folder / IdOf(json, "weights", path.string());
  if (Sha256OfFile(weights) != identity.weights_sha256)
    throw Error(ErrorCode::kFormat,
                weights.string() + ": its SHA-256 is not the one in " + path.string() +
                    "; the training was not finished or the file has changed, train it again");
  const nlohmann::ordered_json& provenance = MemberOf(json, "provenance", path.string());
  const std::string where = path.string() + ".provenance";
  identity.dataset_sha256 = ValueOf<std::string>(provenance, "dataset_sha256", where);
  identity.code_version = ValueOf<std::string>(provenance, "code_version", where);
  return policy;
}

std::string TrainedPolicyText(const TrainedPolicy& policy) {
  return policy.role + ": policy.json sha256 " + policy.identity.policy_sha256;
}

std::string InferenceKernelName() { return std::string(NameOf(BestInstructionSet())); }

}  // namespace doorforge
