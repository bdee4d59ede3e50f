// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/hash.h"
#include "doorforge/core/rng.h"
#include "doorforge/dataset/collect.h"

// Episodes that no simulator made: cheap, reproducible, valid for every check.

namespace doorforge::synthetic {

inline PartIdentity PartNamed(const std::string& id) { return {id, "hash of " + id, {}}; }

inline std::vector<DoorParts> Doors(int count) {
  std::vector<DoorParts> doors;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    doors.push_back({"door" + n, i % 2 == 0 ? "interior" : "safe", "lever", PartNamed("body" + n),
                     PartNamed("handle" + n)});
  }
  return doors;
}

inline DatasetProvenance ProvenanceOf(const std::vector<DoorParts>& doors) {
  DatasetProvenance provenance;
  provenance.code_version = "0.1.0+test";
  provenance.compiler = "test";
  provenance.seed = 11;
  for (const DoorParts& door : doors)
    provenance.doors.push_back({door.door_id, "hash of " + door.door_id, door.category,
                                door.mechanism, door.body, door.handle, "CC0-1.0", ""});
  return provenance;
}

inline void FillDecision(Decision& decision, Rng& rng) {
  constexpr int kPoints = 50;
  for (int i = 0; i < 3 * kPoints; ++i)
    decision.cloud.xyz.push_back(static_cast<float>(rng.Uniform(-1, 1)));
  for (int i = 0; i < kPoints; ++i)
    decision.cloud.label.push_back(static_cast<std::uint8_t>(rng.Index(kPointLabelCount)));
  for (float& value : decision.proprioception) value = static_cast<float>(rng.Uniform(-1, 1));
  for (std::size_t i = 28; i < 32; ++i) decision.proprioception[i] = i == 31 ? 1.0F : 0.0F;
  decision.action = {0.01F, 0, 0, 1, 0, 0, 0, 1, 0};
  decision.executed = decision.action;
  decision.angle_gain_rad = rng.Uniform(0, 0.1);
}

/// Fails every seventh episode.
inline CollectedEpisode RunSynthetic(const PlannedEpisode& planned,
                                     const std::vector<DoorParts>& doors) {
  Rng rng(5, "synthetic/" + planned.key);
  CollectedEpisode collected;
  Episode& episode = collected.episode;
  episode.scene.door_id = doors.at(planned.door).door_id;
  episode.scene.episode = planned.number;
  episode.outcome = planned.number % 7 == 3 ? EpisodeOutcome::kGripLost : EpisodeOutcome::kOpened;
  episode.detail = "synthetic " + planned.key;
  episode.state_sha256 = Sha256Hex(planned.key);
  for (int t = 0; t < 4; ++t) FillDecision(episode.decisions.emplace_back(), rng);
  collected.meta = EpisodeMetaToJson(episode);
  return collected;
}

/// Relative path to SHA-256 of every file below a folder.
inline std::map<std::string, std::string> HashesBelow(const std::filesystem::path& folder) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      hashes[std::filesystem::relative(entry.path(), folder).string()] = Sha256OfFile(entry.path());
  }
  return hashes;
}

class CollectionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("doorforge_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    doors_ = Doors(10);
    plan_ = MakePlan(doors_, 40, 11, {.episodes_per_shard = 8, .val_fraction = 0.2});
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  CollectRequest RequestFor(const std::filesystem::path& folder, int threads) const {
    CollectRequest request;
    request.folder = folder;
    request.config_text = "{\"seed\": 11}\n";
    request.provenance = ProvenanceOf(doors_);
    request.threads = threads;
    return request;
  }

  CollectSummary CollectInto(const std::filesystem::path& folder, int threads = 2) const {
    return Collect(
        plan_, [this](const PlannedEpisode& planned) { return RunSynthetic(planned, doors_); },
        RequestFor(folder, threads));
  }

  std::filesystem::path folder_;
  std::vector<DoorParts> doors_;
  CollectionPlan plan_;
};

}  // namespace doorforge::synthetic
