// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/rng.h"
#include "doorforge/schemas/episode_arrays.h"

namespace doorforge::fixture {

/// An episode with made-up but reproducible numbers.
inline Episode MakeEpisode(std::uint64_t number, int decisions = 3, int points = 40) {
  Rng rng(number, "fixture");
  Episode episode;
  episode.outcome = EpisodeOutcome::kOpened;
  episode.scene.door_id = "door_" + std::to_string(number % 4);
  episode.scene.seed = 5;
  episode.scene.episode = number;
  episode.peak_hinge_rad = 0.8;
  episode.state_sha256 = std::string(64, '0');
  for (int t = 0; t < decisions; ++t) {
    Decision& decision = episode.decisions.emplace_back();
    for (int i = 0; i < 3 * points; ++i)
      decision.cloud.xyz.push_back(static_cast<float>(rng.Uniform(-1, 1)));
    for (int i = 0; i < points; ++i)
      decision.cloud.label.push_back(static_cast<std::uint8_t>(rng.Index(kPointLabelCount)));
    for (float& value : decision.proprioception) value = static_cast<float>(rng.Uniform(-1, 1));
    for (float& value : decision.action) value = static_cast<float>(rng.Uniform(-1, 1));
    for (double& value : decision.state) value = rng.Uniform(-1, 1);
    decision.time_s = t / 6.0;
    decision.hinge_rad = 0.1 * t;
    decision.handle_rad = 0.5;
    decision.angle_gain_rad = 0.1;
  }
  return episode;
}

inline std::vector<MemberBytes> MembersOf(const Episode& episode) {
  return EncodeEpisode(episode, EpisodeMetaToJson(episode), "");
}

/// A folder of its own, removed afterwards.
class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("doorforge_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

inline std::string Slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void Spill(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

inline void FlipBit(const std::filesystem::path& path, std::uint64_t byte) {
  std::string content = Slurp(path);
  content.at(byte) = static_cast<char>(content.at(byte) ^ 0x10);
  Spill(path, content);
}

}  // namespace doorforge::fixture
