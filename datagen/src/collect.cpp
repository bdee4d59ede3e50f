// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/datagen/collect.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <signal.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"

#include "ordered_work.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// An episode as it goes into its shard: members, or the cause why there are none.
struct EncodedEpisode {
  std::vector<MemberBytes> members;
  std::uint64_t decisions = 0;
  std::optional<FailedEpisode> failure;
};

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

// The first line in which two texts differ, for a message.
std::string FirstDifference(const std::string& there, const std::string& here) {
  std::istringstream a(there);
  std::istringstream b(here);
  std::string line_a;
  std::string line_b;
  while (line_a == line_b && (a || b)) {
    if (!std::getline(a, line_a)) line_a = "(end)";
    if (!std::getline(b, line_b)) line_b = "(end)";
  }
  return "there: " + line_a + "\nnow:   " + line_b;
}

void CommitConfig(const CollectRequest& request) {
  const fs::path path = request.folder / "config.yaml";
  if (fs::exists(path)) {
    const std::string there = ReadFile(path);
    if (there == request.config_text) return;
    throw Error(ErrorCode::kInvalidArgument,
                path.string() +
                    ": the folder holds episodes of another config; give the same "
                    "settings to go on, or another --out\n" +
                    FirstDifference(there, request.config_text));
  }
  CommitFile(path, request.config_text, Existing::kRefuse);
}

FailedEpisode FailureOf(const PlannedEpisode& planned, const DatasetDoor& door,
                        const Episode& episode) {
  return {planned.key,
          door.id,
          std::string(NameOf(episode.outcome)),
          episode.detail,
          episode.peak_hinge_rad,
          episode.peak_handle_rad};
}

EncodedEpisode Encode(const PlannedEpisode& planned, const DatasetDoor& door,
                      const EpisodeRunner& runner) {
  EncodedEpisode encoded;
  try {
    const CollectedEpisode collected = runner(planned);
    if (collected.episode.outcome == EpisodeOutcome::kOpened) {
      encoded.members = EncodeEpisode(collected.episode, collected.meta, collected.preview_png);
      encoded.decisions = collected.episode.decisions.size();
    } else {
      encoded.failure = FailureOf(planned, door, collected.episode);
    }
  } catch (const Error& error) {
    encoded.failure = FailedEpisode{planned.key, door.id, "error", error.what(), 0, 0};
  }
  return encoded;
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

  // Returns the number of shards that were there already.
  std::uint64_t FindPending() {
    std::uint64_t kept = 0;
    for (std::size_t i = 0; i < plan_.shards.size(); ++i) {
      if (IsCommitted(plan_.shards[i])) {
        ++kept;
        continue;
      }
      for (std::size_t k = 0; k < plan_.shards[i].episodes.size(); ++k) pending_.push_back({i, k});
    }
    return kept;
  }

  // False if a signal asked to stop.
  bool Run() {
    Progress progress("collect", pending_.size());
    OrderedWork<EncodedEpisode> work(
        [&](std::size_t i) {
          const PlannedEpisode& planned = EpisodeAt(pending_[i]);
          return Encode(planned, request_.provenance.doors.at(planned.door), runner_);
        },
        [&](std::size_t i, EncodedEpisode encoded) {
          progress.Advance(1, tally_.Add(encoded));
          Write(pending_[i], std::move(encoded));
        },
        [] { return StopRequested() != 0; });
    const std::size_t done = work.Run(pending_.size(), request_.threads);
    writer_.reset();  // a shard that is not complete leaves nothing behind
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

  const PlannedEpisode& EpisodeAt(const Slot& slot) const {
    return plan_.shards[slot.shard].episodes[slot.episode];
  }

  void Write(const Slot& slot, EncodedEpisode encoded) {
    const PlannedShard& shard = plan_.shards[slot.shard];
    if (slot.episode == 0) {
      const ShardHeader header{shard.number, request_.stage, shard.split, config_sha256_};
      writer_ = std::make_unique<ShardWriter>(PartFolder(request_, shard), header);
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

CollectSummary SummaryOf(const CollectionPlan& plan, const CollectRequest& request) {
  CollectSummary summary;
  for (const PlannedShard& shard : plan.shards) {
    summary.planned += shard.episodes.size();
    const fs::path path = IndexPath(request, shard);
    if (!fs::exists(path)) continue;
    const ShardIndex index = ReadShardIndex(path);
    summary.written += index.episodes.size();
    summary.bytes += index.tar_bytes;
    for (const FailedEpisode& failure : index.failures) ++summary.failures[failure.outcome];
  }
  return summary;
}

std::string FailureLines(const CollectionPlan& plan, const CollectRequest& request) {
  std::string lines;
  for (const PlannedShard& shard : plan.shards) {
    const DatasetPart part{request.stage, shard.split, 0, 0, 0, 0, 0};
    for (const FailedEpisode& failure : ReadShardIndex(IndexPath(request, shard)).failures)
      lines += FailureLine(failure, part) + "\n";
  }
  return lines;
}

// Ids of the doors on one side, sorted, one a line.
std::string SplitLines(const CollectionPlan& plan, const DatasetProvenance& provenance,
                       DoorSide side) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < plan.sides.size(); ++i) {
    if (plan.sides[i] == side) ids.insert(provenance.doors.at(i).id);
  }
  std::string lines;
  for (const std::string& id : ids) lines += id + "\n";
  return lines;
}

void WriteRecords(const CollectionPlan& plan, const CollectRequest& request) {
  DatasetProvenance provenance = request.provenance;
  provenance.config_sha256 = Sha256Hex(request.config_text);
  for (std::size_t i = 0; i < plan.sides.size(); ++i)
    provenance.doors.at(i).split = SplitNameOf(plan.sides[i]);
  const DatasetRecord record = SummarizeShards(request.folder);
  for (const DoorSide side : {DoorSide::kTrain, DoorSide::kVal})
    CommitFile(request.folder / "splits" / (std::string(SplitNameOf(side)) + ".txt"),
               SplitLines(plan, provenance, side));
  CommitFile(request.folder / "failures.jsonl", FailureLines(plan, request));
  WriteJsonFile(request.folder / "provenance.json", ProvenanceToJson(provenance));
  CommitFile(request.folder / "README.md", DatasetCard(record, provenance));
  // last: its presence says that the dataset is complete
  WriteJsonFile(request.folder / "dataset.json", DatasetToJson(record));
}

// The process id in ".name.tmp-<pid>-<count>", if the name is such.
std::optional<pid_t> WriterOf(const std::string& name) {
  const std::size_t at = name.rfind(".tmp-");
  if (!name.starts_with('.') || at == std::string::npos) return std::nullopt;
  pid_t process = 0;
  const char* begin = name.data() + at + 5;
  const auto [end, error] = std::from_chars(begin, name.data() + name.size(), process);
  if (error != std::errc{} || process <= 0 || end == name.data() + name.size() || *end != '-')
    return std::nullopt;
  return process;
}

}  // namespace

CollectSummary Collect(const CollectionPlan& plan, const EpisodeRunner& runner,
                       const CollectRequest& request) {
  Require(request.provenance.doors.size() == plan.sides.size(), ErrorCode::kInvalidArgument,
          "collect: plan and provenance name different doors");
  CommitConfig(request);
  RemoveStaleFiles(request.folder);
  Collection collection(plan, runner, request);
  const std::uint64_t kept = collection.FindPending();
  const bool is_complete = collection.Run();
  if (is_complete) WriteRecords(plan, request);
  CollectSummary summary = SummaryOf(plan, request);
  summary.kept_shards = kept;
  summary.stopped_by_signal = is_complete ? 0 : StopRequested();
  return summary;
}

void RemoveStaleFiles(const fs::path& folder) {
  std::vector<fs::path> stale;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::optional<pid_t> process = WriterOf(entry.path().filename().string());
    if (process && entry.is_regular_file() && ::kill(*process, 0) != 0 && errno == ESRCH)
      stale.push_back(entry.path());
  }
  for (const fs::path& path : stale) fs::remove(path);
}

}  // namespace doorforge
