// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/regenerate.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/rng.h"

#include "encoded_episode.h"

namespace doorforge {
namespace {

struct Choice {
  const PlannedShard* shard;
  const PlannedEpisode* episode;
};

// In the plan's order.
std::vector<Choice> Choose(const CollectionPlan& plan, double fraction) {
  std::vector<Choice> all;
  for (const PlannedShard& shard : plan.shards) {
    for (const PlannedEpisode& episode : shard.episodes) all.push_back({&shard, &episode});
  }
  const auto count = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(all.size()))), 1,
      all.size());
  Rng rng(0, "regenerate/" + std::to_string(all.size()));
  // one out of each of `count` stretches of the plan
  std::vector<Choice> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * all.size() / count;
    const std::size_t end = (i + 1) * all.size() / count;
    chosen.push_back(all[begin + rng.Index(static_cast<std::uint32_t>(end - begin))]);
  }
  return chosen;
}

class Comparison {
 public:
  explicit Comparison(const ShardReader& reader) : reader_(reader) {}

  // Empty if the dataset holds just this.
  std::vector<DatasetFinding> Compare(const std::string& key, const EncodedEpisode& made) const {
    const std::vector<ShardEpisode>& episodes = reader_.index().episodes;
    const auto episode = std::find_if(episodes.begin(), episodes.end(),
                                      [&](const ShardEpisode& e) { return e.key == key; });
    if (episode == episodes.end()) return CompareFailure(key, made);
    const auto number = static_cast<std::size_t>(episode - episodes.begin());
    if (made.failure)
      return {Finding(reader_.Describe(number, ""),
                      "made again, it fails: " + made.failure->outcome, "the recorded success")};
    return CompareMembers(number, made);
  }

 private:
  static DatasetFinding Finding(const std::string& where, const std::string& measured,
                                const std::string& allowed) {
    return {"DST011", where, measured, allowed,
            "the build, the doors or the processor's instruction set differ, or the data were "
            "changed; collect anew with this build to have what it makes"};
  }

  std::vector<DatasetFinding> CompareFailure(const std::string& key,
                                             const EncodedEpisode& made) const {
    const std::vector<FailedEpisode>& failures = reader_.index().failures;
    const auto failure = std::find_if(failures.begin(), failures.end(),
                                      [&](const FailedEpisode& f) { return f.key == key; });
    const std::string where = reader_.index().tar + ": " + key;
    if (failure == failures.end())
      return {Finding(where, "neither an episode nor a failure", "every planned episode")};
    if (made.failure && made.failure->outcome == failure->outcome &&
        made.failure->detail == failure->detail &&
        made.failure->peak_hinge_rad == failure->peak_hinge_rad &&
        made.failure->peak_handle_rad == failure->peak_handle_rad)
      return {};
    return {
        Finding(where,
                "made again: " + (made.failure ? made.failure->outcome + ", " + made.failure->detail
                                               : std::string("a success")),
                failure->outcome + ", " + failure->detail)};
  }

  std::vector<DatasetFinding> CompareMembers(std::size_t number, const EncodedEpisode& made) const {
    std::vector<DatasetFinding> findings;
    const std::vector<ShardMember>& there = reader_.index().episodes[number].members;
    if (made.members.size() != there.size())
      findings.push_back(Finding(reader_.Describe(number, ""),
                                 std::to_string(made.members.size()) + " members",
                                 std::to_string(there.size())));
    for (const MemberBytes& member : made.members) {
      const bool is_there = std::any_of(
          there.begin(), there.end(), [&](const ShardMember& m) { return m.name == member.name; });
      const auto bytes =
          is_there ? reader_.Read(number, member.name) : std::span<const std::byte>();
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      if (text == member.bytes) continue;
      const auto [a, b] =
          std::mismatch(text.begin(), text.end(), member.bytes.begin(), member.bytes.end());
      findings.push_back(Finding(reader_.Describe(number, member.name),
                                 "differs from byte " + std::to_string(a - text.begin()) + " on, " +
                                     std::to_string(member.bytes.size()) + " bytes made again",
                                 std::to_string(text.size()) + " bytes as recorded"));
    }
    return findings;
  }

  const ShardReader& reader_;
};

}  // namespace

RegenerateResult RegenerateEpisodes(const CollectionPlan& plan, const EpisodeRunner& runner,
                                    const RegenerateRequest& request) {
  Require(request.fraction > 0 && request.fraction <= 1, ErrorCode::kInvalidArgument,
          "regenerate: the fraction is out of 0..1");
  const std::vector<Choice> chosen = Choose(plan, request.fraction);
  std::vector<std::vector<DatasetFinding>> found(chosen.size());
  Progress progress("regenerate", chosen.size());
  ParallelFor(chosen.size(), request.threads, [&](std::size_t i) {
    const auto& [shard, episode] = chosen[i];
    const ShardReader reader(request.folder / request.stage / shard->split /
                             (ShardStem(shard->number) + ".index.json"));
    const EncodedEpisode made = RunAndEncode(*episode, DatasetDoor{}, runner);
    found[i] = Comparison(reader).Compare(episode->key, made);
    reader.RequireWhole();
    progress.Advance();
  });
  RegenerateResult result;
  result.episodes = chosen.size();
  for (std::vector<DatasetFinding>& findings : found)
    std::move(findings.begin(), findings.end(), std::back_inserter(result.findings));
  return result;
}

double ParseFraction(const std::string& text) {
  const bool is_percent = text.ends_with('%');
  const char* const end = text.data() + text.size() - (is_percent ? 1 : 0);
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), end, value);
  if (is_percent) value /= 100;
  Require(error == std::errc{} && after == end && value > 0 && value <= 1,
          ErrorCode::kInvalidArgument,
          "\"" + text + "\": expected a share of the episodes such as 1% or 0.01, up to 100%");
  return value;
}

}  // namespace doorforge
