// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collect.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"

#include "dataset_records.h"
#include "encoded_episode.h"
#include "ordered_work.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Place of an episode in the plan.
struct Slot {
  std::size_t shard;
  std::size_t episode;
};

fs::path PartFolder(const CollectRequest& request, const PlannedShard& shard) {
  return request.folder / request.stage / shard.split;
}

fs::path IndexPath(const CollectRequest& request, const PlannedShard& shard) {
  return PartFolder(request, shard) / (ShardStem(shard.number) + ".index.json");
}

// Counts while the work goes on, for the progress line.
class RunningTally {
 public:
  std::string Add(const EncodedEpisode& encoded) {
    ++episodes_;
    if (encoded.failure) ++causes_[encoded.failure->outcome];
    for (const MemberBytes& member : encoded.members) bytes_ += member.bytes.size();
    return Note();
  }

 private:
  std::string Note() const {
    std::uint64_t failed = 0;
    std::vector<std::pair<std::uint64_t, std::string>> causes;
    for (const auto& [cause, count] : causes_) {
      failed += count;
      causes.emplace_back(count, cause);
    }
    std::sort(causes.rbegin(), causes.rend());
    char text[64];
    std::snprintf(text, sizeof text, "success %.1f %%, %.0f MiB",
                  100.0 * static_cast<double>(episodes_ - failed) / static_cast<double>(episodes_),
                  static_cast<double>(bytes_) / (1 << 20));
    std::string note = text;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, causes.size()); ++i)
      note += ", " + causes[i].second + " " + std::to_string(causes[i].first);
    return note;
  }

  std::map<std::string, std::uint64_t> causes_;
  std::uint64_t episodes_ = 0;
  std::uint64_t bytes_ = 0;
};

class Collection {
 public:
  Collection(const CollectionPlan& plan, const EpisodeRunner& runner, const CollectRequest& request)
      : plan_(plan),
        runner_(runner),
        request_(request),
        config_sha256_(Sha256Hex(request.config_text)) {}

  // Finds what is there already and what is to do. Shards whose last episode is there are
  // committed.
  void FindPending(CollectSummary& summary) {
    const auto count = static_cast<std::size_t>(request_.task.count);
    for (auto i = static_cast<std::size_t>(request_.task.number); i < plan_.shards.size();
         i += count) {
      const PlannedShard& shard = plan_.shards[i];
      ++summary.shards;
      if (IsCommitted(shard)) {
        ++summary.kept_shards;
        RemoveShardLeftovers(*request_.files, PartFolder(request_, shard), shard.number);
        continue;
      }
      const std::size_t begun = FindBegun(shard);
      summary.kept_episodes += begun;
      for (std::size_t k = begun; k < shard.episodes.size(); ++k) pending_.push_back({i, k});
    }
  }

  // False if a signal asked to stop.
  bool Run() {
    Progress progress("collect", pending_.size());
    OrderedWork<EncodedEpisode> work(
        [&](std::size_t i) {
          const PlannedEpisode& planned = EpisodeAt(pending_[i]);
          return RunAndEncode(planned, request_.provenance.doors.at(planned.door), runner_);
        },
        [&](std::size_t i, EncodedEpisode encoded) {
          progress.Advance(1, tally_.Add(encoded));
          Write(pending_[i], std::move(encoded));
        },
        [] { return StopRequested() != 0; });
    const std::size_t done = work.Run(pending_.size(), request_.threads);
    writer_.reset();
    return done == pending_.size();
  }

 private:
  bool IsCommitted(const PlannedShard& shard) const {
    const fs::path path = IndexPath(request_, shard);
    if (!fs::exists(path)) return false;
    if (ReadShardIndex(path).header.config_sha256 == config_sha256_) return true;
    throw Error(ErrorCode::kInvalidArgument,
                path.string() + ": written with another config; remove it, or use another --out");
  }

  // Number of episodes that an unfinished shard holds.
  std::size_t FindBegun(const PlannedShard& shard) {
    if (!HasShardLeftovers(PartFolder(request_, shard), shard.number)) return 0;
    const std::unique_ptr<ShardWriter> writer = Open(shard);
    const std::size_t begun = writer->keys().size();
    if (begun == shard.episodes.size()) writer->Commit();
    return begun;
  }

  // Goes on with a shard.
  std::unique_ptr<ShardWriter> Open(const PlannedShard& shard) const {
    const fs::path folder = PartFolder(request_, shard);
    auto writer = std::make_unique<ShardWriter>(
        folder, ShardHeader{shard.number, request_.stage, shard.split, config_sha256_},
        Unfinished::kKeep, *request_.files);
    const std::vector<std::string>& keys = writer->keys();
    const bool is_prefix =
        keys.size() <= shard.episodes.size() &&
        std::equal(keys.begin(), keys.end(), shard.episodes.begin(),
                   [](const std::string& key, const PlannedEpisode& e) { return key == e.key; });
    if (!is_prefix)
      throw Error(ErrorCode::kInvalidArgument,
                  (folder / ("." + ShardStem(shard.number) + ".journal")).string() +
                      ": holds other episodes than planned; remove it and the .partial beside it");
    return writer;
  }

  const PlannedEpisode& EpisodeAt(const Slot& slot) const {
    return plan_.shards[slot.shard].episodes[slot.episode];
  }

  void Write(const Slot& slot, EncodedEpisode encoded) {
    const PlannedShard& shard = plan_.shards[slot.shard];
    if (!writer_) {
      writer_ = Open(shard);
      if (writer_->keys().size() != slot.episode)
        throw Error(ErrorCode::kInvalidArgument,
                    PartFolder(request_, shard).string() +
                        ": another process has written here in the meantime; give the same "
                        "command again");
    }
    if (encoded.failure) {
      writer_->AddFailure(std::move(*encoded.failure));
    } else {
      writer_->Add(EpisodeAt(slot).key, encoded.decisions, std::move(encoded.members));
    }
    if (slot.episode + 1 == shard.episodes.size()) {
      writer_->Commit();
      writer_.reset();
    }
  }

  const CollectionPlan& plan_;
  const EpisodeRunner& runner_;
  const CollectRequest& request_;
  std::string config_sha256_;
  std::vector<Slot> pending_;
  std::unique_ptr<ShardWriter> writer_;
  RunningTally tally_;
};

void CountShards(const CollectionPlan& plan, const CollectRequest& request,
                 CollectSummary& summary) {
  const auto count = static_cast<std::size_t>(request.task.count);
  for (auto i = static_cast<std::size_t>(request.task.number); i < plan.shards.size(); i += count) {
    const PlannedShard& shard = plan.shards[i];
    summary.planned += shard.episodes.size();
    const fs::path path = IndexPath(request, shard);
    if (!fs::exists(path)) continue;
    const ShardIndex index = ReadShardIndex(path);
    summary.written += index.episodes.size();
    summary.bytes += index.tar_bytes;
    for (const FailedEpisode& failure : index.failures) ++summary.failures[failure.outcome];
  }
}

// The doors that could have been drawn and were not are in no episode: a few episodes of ten
// thousand doors are a few doors.
std::vector<DatasetDoor> DrawnDoors(const CollectionPlan& plan,
                                    const std::vector<DatasetDoor>& doors) {
  std::vector<bool> is_drawn(plan.sides.size());
  for (const PlannedShard& shard : plan.shards)
    for (const PlannedEpisode& episode : shard.episodes) is_drawn.at(episode.door) = true;
  std::vector<DatasetDoor> drawn;
  for (std::size_t i = 0; i < plan.sides.size(); ++i) {
    if (!is_drawn[i]) continue;
    drawn.push_back(doors.at(i));
    drawn.back().split = SplitNameOf(plan.sides[i]);
  }
  return drawn;
}

DatasetProvenance ProvenanceOf(const CollectionPlan& plan, const CollectRequest& request) {
  DatasetProvenance provenance = request.provenance;
  provenance.config_sha256 = Sha256Hex(request.config_text);
  provenance.planned = PlannedParts(plan, request.stage);
  provenance.doors = DrawnDoors(plan, request.provenance.doors);
  return provenance;
}

}  // namespace

CollectSummary Collect(const CollectionPlan& plan, const EpisodeRunner& runner,
                       const CollectRequest& request) {
  Require(request.provenance.doors.size() == plan.sides.size(), ErrorCode::kInvalidArgument,
          "collect: plan and provenance name different doors");
  Require(request.task.count >= 1 && request.task.number >= 0 &&
              request.task.number < request.task.count,
          ErrorCode::kInvalidArgument, "collect: no such task");
  BeginDataset(*request.files, request.folder, request.config_text, ProvenanceOf(plan, request));
  RemoveStaleFiles(*request.files, request.folder);
  CollectSummary summary;
  Collection collection(plan, runner, request);
  collection.FindPending(summary);
  const bool is_complete = collection.Run();
  if (is_complete && request.task.count == 1) FinishDataset(*request.files, request.folder);
  CountShards(plan, request, summary);
  summary.stopped_by_signal = is_complete ? 0 : StopRequested();
  return summary;
}

std::vector<PlannedPart> PlannedParts(const CollectionPlan& plan, const std::string& stage) {
  std::vector<PlannedPart> parts;
  for (const PlannedShard& shard : plan.shards) {
    if (parts.empty() || parts.back().split != shard.split)
      parts.push_back({stage, shard.split, 0, 0, shard.episodes.size()});
    ++parts.back().shards;
    parts.back().episodes += shard.episodes.size();
  }
  return parts;
}

}  // namespace doorforge
