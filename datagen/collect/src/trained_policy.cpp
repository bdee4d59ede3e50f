// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/trained_policy.h"

#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/networks/instruction_set.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Of policies that say so.
int CloudPointsOf(const nlohmann::ordered_json& json, const std::string& path) {
  if (!json.contains("sizes") || !json["sizes"].contains("cloud_points")) return 0;
  return ValueOf<int>(json["sizes"], "cloud_points", path + ".sizes");
}

// Of policies of the stage "handle" that remember.
RememberedViewConfig RememberedOf(const nlohmann::ordered_json& json, const std::string& path) {
  RememberedViewConfig remembered{.finer = 0};
  if (!json.contains("normalisation") || !json["normalisation"].contains("remembered_finer"))
    return remembered;
  const nlohmann::ordered_json& view = json["normalisation"];
  remembered.finer = ValueOf<int>(view, "remembered_finer", path + ".normalisation");
  remembered.within_m = ValueOf<double>(view, "cloud_within_m", path + ".normalisation");
  CheckRememberedView(remembered);
  return remembered;
}

class TrainedLearnedGrasp : public LearnedGrasp {
 public:
  explicit TrainedLearnedGrasp(std::unique_ptr<GraspPolicy> policy) : policy_(std::move(policy)) {}

  std::optional<ChosenGrasp> Choose(const ClosedDoor& door, const CloudExtent& extent) override {
    GraspView view;
    view.visible = door.visible;
    view.approach = door.approach;
    view.sample = [&](const Eigen::Vector3d& start, double within_m) {
      return SampleCloud(door.visible, start, {extent.point_count, within_m}).cloud;
    };
    view.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
      return door.clearance.Fits(door.visible, contact_m, rotation);
    };
    const std::optional<GraspChoice> choice = policy_->Choose(view);
    if (!choice) return std::nullopt;
    return ChosenGrasp{SampleCloud(door.visible, choice->contact_m, extent).cloud,
                       choice->contact_m, choice->world_from_hand_rotation};
  }

 private:
  std::unique_ptr<GraspPolicy> policy_;
};

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
  if (found != NameOf(stage))
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

std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy) {
  return LoadPolicy(policy.folder, {}, NameOf(policy.stage));
}

std::unique_ptr<LearnedGrasp> LoadLearnedGrasp(const TrainedPolicy& policy) {
  return std::make_unique<TrainedLearnedGrasp>(LoadGraspPolicy(policy.folder));
}

std::string PolicyArithmetic() { return std::string(NameOf(BestInstructionSet())); }

}  // namespace doorforge
