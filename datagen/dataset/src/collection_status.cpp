// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/collection_status.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/shard_progress.h"

#include "dataset_records.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr double kRateWindow = 3600;      // [s]
constexpr double kLeastPatience = 60;     // [s] until a shard without news counts as left
constexpr double kPatienceEpisodes = 10;  // or so many of its episodes
constexpr double kFirstPatience = 600;    // [s] while its episodes' time is not known

// Times of a file; 0: not known.
struct FileTimes {
  double made_s = 0;
  double changed_s = 0;
};

FileTimes TimesOf(const fs::path& path) {
  const auto seconds = [](const struct statx_timestamp& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  struct statx status {};
  if (::statx(AT_FDCWD, path.c_str(), 0, STATX_BTIME | STATX_MTIME, &status) != 0) return {};
  FileTimes times;
  if ((status.stx_mask & STATX_BTIME) != 0) times.made_s = seconds(status.stx_btime);
  if ((status.stx_mask & STATX_MTIME) != 0) times.changed_s = seconds(status.stx_mtime);
  return times;
}

// Where the shard's index is, of all folders; empty if in none.
fs::path IndexIn(const std::vector<fs::path>& folders, const ExpectedShard& shard) {
  for (const fs::path& folder : folders) {
    const fs::path path = folder / (shard.Name() + ".index.json");
    if (fs::exists(path)) return path;
  }
  return {};
}

void CountFailures(const std::vector<FailedEpisode>& failures, CollectionStatus& status) {
  for (const FailedEpisode& failure : failures) ++status.failures[failure.outcome];
}

double PatienceWith(const ShardStatus& shard) {
  const double intervals = static_cast<double>(shard.kept + shard.failed) - 1;
  if (intervals < 1 || shard.begin_s == 0) return kFirstPatience;
  return std::max(kLeastPatience, kPatienceEpisodes * (shard.end_s - shard.begin_s) / intervals);
}

class StatusReading {
 public:
  explicit StatusReading(const StatusRequest& request) : request_(request) {
    status_.folder = request.folders.front().string();
  }

  CollectionStatus Take() {
    const fs::path home = FolderWithPlan();
    // without SHA256SUMS, which a task that begins at this moment is still writing
    const fs::path path = home / kProvenanceRecord;
    const DatasetProvenance provenance = ProvenanceFromJson(ReadJsonFile(path), path.string());
    Require(!provenance.planned.empty(), ErrorCode::kInvalidArgument,
            path.string() +
                ": names no plan, as datasets of early builds; `doorforge dataset info " +
                home.string() + "` says what is there");
    status_.stage = provenance.planned.front().stage;
    for (const ExpectedShard& shard : ExpectedShards(provenance)) AddShard(shard);
    status_.is_complete = fs::exists(request_.folders.front() / kDatasetRecord) &&
                          status_.Count(ShardState::kDone) == status_.shards.size();
    status_.episodes_per_s = Rate(TimesOf(path).changed_s);
    AddTasks();
    return std::move(status_);
  }

 private:
  fs::path FolderWithPlan() const {
    for (const fs::path& folder : request_.folders)
      if (fs::exists(folder / kProvenanceRecord)) return folder;
    throw Error(ErrorCode::kMissing, request_.folders.front().string() +
                                         ": holds no collection (no " + kProvenanceRecord +
                                         "); `doorforge datagen --out` begins one");
  }

  void AddShard(const ExpectedShard& expected) {
    ShardStatus shard;
    shard.name = expected.Name();
    shard.place = status_.shards.size();
    shard.planned = expected.episodes;
    // a shard may be committed between the looks at its index and at its journal
    if (!FindDone(expected, shard) && !FindBegun(expected, shard)) FindDone(expected, shard);
    status_.shards.push_back(std::move(shard));
  }

  bool FindDone(const ExpectedShard& expected, ShardStatus& shard) {
    const fs::path path = IndexIn(request_.folders, expected);
    if (path.empty()) return false;
    const ShardIndex index = ReadShardIndex(path);
    shard.state = ShardState::kDone;
    shard.kept = index.episodes.size();
    shard.failed = index.failures.size();
    shard.bytes = index.tar_bytes;
    shard.begin_s = TimesOf(path.parent_path() / index.tar).made_s;
    shard.end_s = TimesOf(path).changed_s;
    CountFailures(index.failures, status_);
    return true;
  }

  bool FindBegun(const ExpectedShard& expected, ShardStatus& shard) {
    for (const fs::path& folder : request_.folders) {
      const fs::path part = folder / expected.stage / expected.split;
      const std::optional<ShardProgress> progress = ReadShardProgress(part, expected.number);
      if (!progress) continue;
      const FileTimes times = TimesOf(ShardJournalPath(part, expected.number));
      shard.kept = progress->episodes;
      shard.failed = progress->failures.size();
      shard.bytes = progress->tar_bytes;
      shard.begin_s = times.made_s;
      shard.end_s = times.changed_s;
      const bool is_news = request_.now_s - shard.end_s <= PatienceWith(shard);
      shard.state = is_news ? ShardState::kBeingWritten : ShardState::kBegun;
      CountFailures(progress->failures, status_);
      return true;
    }
    return false;
  }

  // Episodes of each shard count as if they had come evenly from its begin to its end; `start_s`
  // stands in for a begin that the file system does not know.
  std::optional<double> Rate(double start_s) const {
    double latest = 0;
    double earliest = INFINITY;
    for (const ShardStatus& shard : status_.shards) {
      if (shard.end_s == 0) continue;
      latest = std::max(latest, shard.end_s);
      earliest = std::min(earliest, shard.begin_s > 0 ? shard.begin_s : start_s);
    }
    const double from = std::max(earliest, latest - kRateWindow);
    double episodes = 0;
    for (const ShardStatus& shard : status_.shards) {
      if (shard.end_s < from) continue;
      const double begin = shard.begin_s > 0 ? shard.begin_s : start_s;
      const double length = shard.end_s - begin;
      const double share = length > 0 ? (shard.end_s - std::max(begin, from)) / length : 1;
      episodes += share * static_cast<double>(shard.kept + shard.failed);
    }
    if (!(latest > from) || episodes < 2) return std::nullopt;
    return episodes / (latest - from);
  }

  void AddTasks() {
    for (int i = 0; i < request_.tasks; ++i) status_.tasks.push_back({i, 0, 0, 0, 0});
    if (status_.tasks.empty()) return;
    for (const ShardStatus& shard : status_.shards) {
      TaskStatus& task = status_.tasks[shard.place % status_.tasks.size()];
      ++task.shards;
      task.done_shards += shard.state == ShardState::kDone ? 1 : 0;
      task.planned += shard.planned;
      task.run += shard.kept + shard.failed;
    }
  }

  const StatusRequest& request_;
  CollectionStatus status_;
};

// Until it is done at its own pace, or endless.
double SecondsLeftOf(const ShardStatus& shard) {
  const auto run = static_cast<double>(shard.kept + shard.failed);
  const double pace = (shard.end_s - shard.begin_s) / run;
  if (run == 0 || shard.begin_s == 0 || !(pace > 0)) return INFINITY;
  return pace * (static_cast<double>(shard.planned) - run);
}

// False if a signal asked to stop.
bool PausedFor(std::chrono::duration<double> pause) {
  constexpr std::chrono::milliseconds kStep(100);
  const auto end = std::chrono::steady_clock::now() + pause;
  while (StopRequested() == 0 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(kStep);
  return StopRequested() == 0;
}

}  // namespace

std::string_view NameOf(ShardState state) {
  switch (state) {
    case ShardState::kDone:
      return "done";
    case ShardState::kBeingWritten:
      return "being_written";
    case ShardState::kBegun:
      return "begun";
    case ShardState::kOpen:
      break;
  }
  return "open";
}

std::uint64_t CollectionStatus::Count(ShardState state) const {
  return static_cast<std::uint64_t>(
      std::count_if(shards.begin(), shards.end(),
                    [&](const ShardStatus& shard) { return shard.state == state; }));
}

std::uint64_t CollectionStatus::Planned() const {
  std::uint64_t sum = 0;
  for (const ShardStatus& shard : shards) sum += shard.planned;
  return sum;
}

std::uint64_t CollectionStatus::Kept() const {
  std::uint64_t sum = 0;
  for (const ShardStatus& shard : shards) sum += shard.kept;
  return sum;
}

std::uint64_t CollectionStatus::Failed() const {
  std::uint64_t sum = 0;
  for (const ShardStatus& shard : shards) sum += shard.failed;
  return sum;
}

std::optional<double> CollectionStatus::SuccessRate() const {
  const std::uint64_t run = Kept() + Failed();
  if (run == 0 || stage == NameOf(Stage::kGrasp)) return std::nullopt;
  return static_cast<double>(Kept()) / static_cast<double>(run);
}

std::optional<double> CollectionStatus::SecondsLeft() const {
  if (Count(ShardState::kBeingWritten) == 0 || !episodes_per_s) return std::nullopt;
  return static_cast<double>(Planned() - Kept() - Failed()) / *episodes_per_s;
}

const ShardStatus* CollectionStatus::Slowest() const {
  const ShardStatus* slowest = nullptr;
  for (const ShardStatus& shard : shards) {
    if (shard.state != ShardState::kBeingWritten && shard.state != ShardState::kBegun) continue;
    if (slowest == nullptr || SecondsLeftOf(shard) > SecondsLeftOf(*slowest)) slowest = &shard;
  }
  return slowest;
}

const TaskStatus* CollectionStatus::SlowestTask() const {
  const auto share = [](const TaskStatus& task) {
    return static_cast<double>(task.run) / static_cast<double>(task.planned);
  };
  const TaskStatus* slowest = nullptr;
  for (const TaskStatus& task : tasks) {
    if (task.done_shards == task.shards) continue;
    if (slowest == nullptr || share(task) < share(*slowest)) slowest = &task;
  }
  return slowest;
}

CollectionStatus StatusOfCollection(const StatusRequest& request) {
  Require(!request.folders.empty(), ErrorCode::kInvalidArgument, "status: no folder");
  return StatusReading(request).Take();
}

CollectionStatus LookAtCollection(StatusRequest request, const ShowStatus& show) {
  using Seconds = std::chrono::duration<double>;
  request.now_s = Seconds(std::chrono::system_clock::now().time_since_epoch()).count();
  CollectionStatus status = StatusOfCollection(request);
  show(status, request.now_s);
  return status;
}

std::optional<CollectionStatus> WatchCollection(const StatusRequest& request,
                                                std::chrono::duration<double> every,
                                                const ShowStatus& show) {
  CollectionStatus status = LookAtCollection(request, show);
  while (status.Count(ShardState::kDone) < status.shards.size()) {
    if (!PausedFor(every)) return std::nullopt;
    status = LookAtCollection(request, show);
  }
  return status;
}

}  // namespace doorforge
