// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "training_record.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/policy/training_curves.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/door_set.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;

struct LossName {
  std::string_view key;
  std::string_view title;
  std::string_view unit;
};
constexpr std::array<LossName, 4> kLossNames = {{
    {"actor.position_m", "Actor: hand position, mean L1", "m"},
    {"actor.rotation_rad", "Actor: hand rotation, geodesic angle", "rad"},
    {"actor.divergence", "Actor: divergence from N(0, I)", "nat"},
    {"critic.score_rad", "Critic: angle gained, mean L1", "rad"},
}};

std::set<std::string> SomeDoors(const fs::path& data, std::size_t count) {
  const std::vector<DoorIdentity> doors = TrainingDoors(data);
  count = std::min(count, doors.size());
  std::set<std::string> some;
  for (std::size_t i = 0; i < count; ++i) some.insert(doors[i * doors.size() / count].id);
  return some;
}

// takes the previews of wanted doors out of a shard and strikes them off the list
void CollectPreviews(const ShardReader& shard, std::set<std::string>& wanted,
                     std::map<std::string, std::string>& previews) {
  for (std::size_t i = 0; i < shard.index().episodes.size() && !wanted.empty(); ++i) {
    const auto& members = shard.index().episodes[i].members;
    const bool has_preview = std::any_of(members.begin(), members.end(), [](const auto& member) {
      return member.name == "preview.png";
    });
    if (!has_preview) return;  // all keys of a shard have the same members
    const auto meta = ReadEpisodeMeta(shard, i);
    const std::string path = shard.Describe(i, "meta.json");
    const auto door = ValueOf<std::string>(MemberOf(meta, "scene", path), "door_id", path);
    if (wanted.erase(door) == 0) continue;
    const auto bytes = shard.Read(i, "preview.png");
    previews[door].assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    shard.RequireWhole();
  }
}

}  // namespace

std::vector<DoorIdentity> TrainingDoors(const fs::path& data) {
  const fs::path path = data / "provenance.json";
  std::vector<DoorIdentity> doors;
  for (const DatasetDoor& door : ProvenanceFromJson(ReadJsonFile(path), path.string()).doors)
    doors.push_back(IdentityOf(door));
  std::sort(doors.begin(), doors.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return doors;
}

std::map<std::string, std::string> TrainingPreviews(const fs::path& data, std::size_t count) {
  std::set<std::string> wanted = SomeDoors(data, count);
  std::map<std::string, std::string> previews;
  for (const fs::path& index : ShardIndices(data, "open", "train"))
    CollectPreviews(ShardReader(index), wanted, previews);
  return previews;
}

std::vector<LossCurve> TrainingLosses(const fs::path& policy) {
  if (!fs::exists(policy / "losses.json")) return {};
  std::vector<LossCurve> losses;
  for (const TrainingCurve& curve : ReadTrainingCurves(policy)) {
    LossName name{curve.name, curve.name, ""};
    for (const LossName& known : kLossNames) name = known.key == curve.name ? known : name;
    losses.push_back({std::string(name.title), std::string(name.unit), curve.epoch, curve.train,
                      curve.validation});
  }
  return losses;
}

}  // namespace doorforge::internal
