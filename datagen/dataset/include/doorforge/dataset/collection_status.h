// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

enum class ShardState {
  kDone,          ///< Its index is there.
  kBeingWritten,  ///< Begun, and its last episode is not long ago.
  kBegun,         ///< Begun, and nothing came for longer than its episodes take.
  kOpen,          ///< Not begun.
};

/// "done", "being_written", "begun", "open"
std::string_view NameOf(ShardState state);

/// A planned shard and how far it is.
struct ShardStatus {
  std::string name;       ///< "open/train/shard-000003"
  std::size_t place = 0;  ///< In the plan: shard k belongs to task k mod N.
  ShardState state = ShardState::kOpen;
  std::uint64_t planned = 0;  ///< Episodes, failed ones included.
  std::uint64_t kept = 0;     ///< Episodes that are in it.
  std::uint64_t failed = 0;
  std::uint64_t bytes = 0;
  double begin_s = 0;  ///< When its tar was made, since 1970; 0: not begun, or not known.
  double end_s = 0;    ///< When its last episode came, since 1970; 0: not begun.
};

/// A share of the shards that one of N processes writes.
struct TaskStatus {
  int number = 0;
  std::uint64_t shards = 0;
  std::uint64_t done_shards = 0;
  std::uint64_t planned = 0;  ///< Episodes.
  std::uint64_t run = 0;      ///< Episodes, failed ones included.
};

/// How far a collection is.
struct CollectionStatus {
  std::string folder;
  std::string stage;
  bool is_complete = false;  ///< dataset.json is there, and every planned shard.
  std::vector<ShardStatus> shards;
  std::map<std::string, std::uint64_t> failures;  ///< Outcome to count.
  /// It is measured over the last hour in which episodes came, all tasks together; nothing while
  /// too few came to tell.
  std::optional<double> episodes_per_s;
  std::vector<TaskStatus> tasks;  ///< If their number was given.

  std::uint64_t Count(ShardState state) const;
  std::uint64_t Planned() const;  ///< Episodes.
  std::uint64_t Kept() const;     ///< Episodes.
  std::uint64_t Failed() const;   ///< Episodes.
  /// Share of the episodes that were run and opened the door; nothing where none was run, and at
  /// the stage "grasp", whose failed episodes are kept as data.
  std::optional<double> SuccessRate() const;
  /// Nothing where nobody writes or the rate is not known.
  std::optional<double> SecondsLeft() const;
  /// The shard that is begun and will be done last at its own pace; null if none is begun.
  const ShardStatus* Slowest() const;
  /// The one with the smallest share of its episodes run; null if all are done or none are known.
  const TaskStatus* SlowestTask() const;
};

struct StatusRequest {
  /// The dataset's folder, and those of tasks that wrote into others.
  std::vector<std::filesystem::path> folders;
  int tasks = 0;     ///< N of `datagen --task i/N`; 0: not known.
  double now_s = 0;  ///< Since 1970.
};

/// Looks at a collection, running or not: records, indices, journals and their times. Takes no lock
/// and writes nothing, so that writers never notice.
///
/// @throws Error(kMissing) if no folder holds a collection, Error(kFormat) on a damaged record,
///     Error(kInvalidArgument) if the dataset is of an early build that noted no plan.
CollectionStatus StatusOfCollection(const StatusRequest& request);

/// Shows a look at a collection; the second argument is when it was taken, in seconds since 1970.
using ShowStatus = std::function<void(const CollectionStatus&, double)>;

/// Looks as StatusOfCollection() does, now, whatever `request.now_s` says, and shows what it saw.
CollectionStatus LookAtCollection(StatusRequest request, const ShowStatus& show);

/// Looks again and again, so long apart, until all shards are there: what is left to do then is no
/// matter of waiting. Returns the last look; nothing if a signal asked to stop.
std::optional<CollectionStatus> WatchCollection(const StatusRequest& request,
                                                std::chrono::duration<double> every,
                                                const ShowStatus& show);

/// {"schema": "doorforge.collection_status", ...}
nlohmann::ordered_json StatusToJson(const CollectionStatus& status, double now_s);

/// Says it for people; the last line says what to do next.
std::string StatusText(const CollectionStatus& status, double now_s);

}  // namespace doorforge
