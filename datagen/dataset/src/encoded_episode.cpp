// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "encoded_episode.h"

#include <string>

#include "doorforge/core/error.h"
#include "doorforge/schemas/episode_arrays.h"

namespace doorforge {
namespace {

FailedEpisode FailureOf(const PlannedEpisode& planned, const DatasetDoor& door,
                        const Episode& episode) {
  const bool opened = episode.outcome == EpisodeOutcome::kOpened;
  return {planned.key,
          door.id,
          std::string(opened ? "no_decisions" : NameOf(episode.outcome)),
          episode.detail,
          episode.peak_hinge_rad,
          episode.peak_handle_rad};
}

// Whether it is not this episode's: files that may be there at another try, and settings, which no
// episode of the run can follow.
bool EndsTheRun(const Error& error) {
  return error.code() == ErrorCode::kMissing || error.code() == ErrorCode::kIo ||
         error.code() == ErrorCode::kFormat || error.code() == ErrorCode::kInvalidConfig;
}

}  // namespace

std::vector<MemberBytes> MembersOf(const CollectedEpisode& collected) {
  std::vector<MemberBytes> members =
      EncodeEpisode(collected.episode, collected.meta, collected.preview_png);
  members.insert(members.end(), collected.pictures.begin(), collected.pictures.end());
  return members;
}

bool IsData(const CollectedEpisode& collected) {
  const Episode& episode = collected.episode;
  if (episode.decisions.empty()) return false;
  if (episode.outcome == EpisodeOutcome::kOpened) return true;
  return collected.keep_failed && episode.outcome != EpisodeOutcome::kDiverged;
}

EncodedEpisode RunAndEncode(const PlannedEpisode& planned, const DatasetDoor& door,
                            const EpisodeRunner& runner) {
  EncodedEpisode encoded;
  try {
    const CollectedEpisode collected = runner(planned);
    if (IsData(collected)) {
      encoded.members = MembersOf(collected);
      encoded.decisions = collected.episode.decisions.size();
    } else {
      encoded.failure = FailureOf(planned, door, collected.episode);
    }
  } catch (const Error& error) {
    if (EndsTheRun(error)) throw;
    encoded.failure = FailedEpisode{planned.key, door.id, "error", error.what(), 0, 0};
  }
  return encoded;
}

}  // namespace doorforge
