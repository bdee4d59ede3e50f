// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

/// Angles in bins of 5 degrees from 0 on; the last bin holds what is beyond, the first one what is
/// below 0.
struct AngleHistogram {
  static constexpr int kBins = 25;
  static constexpr double kBinWidth_rad = 0.08726646259971647;

  std::array<std::uint64_t, kBins> counts{};

  void Add(double angle_rad);
};

/// Episodes of one kind, planned ones that failed included.
struct EpisodeGroup {
  std::uint64_t episodes = 0;
  std::uint64_t succeeded = 0;
  std::map<std::string, std::uint64_t> causes;  ///< They count those that did not, by outcome.
  AngleHistogram hinge;                         ///< Largest hinge angle of each episode.
  AngleHistogram handle;                        ///< Largest handle angle of each episode.
};

/// The episodes of one stage, grouped in several ways.
struct StageEpisodes {
  std::string stage;
  EpisodeGroup all = {};
  std::map<std::string, EpisodeGroup> by_category = {};
  std::map<std::string, EpisodeGroup> by_mechanism = {};
  std::map<std::string, EpisodeGroup> by_split = {};
  std::map<std::uint64_t, std::uint64_t> decisions = {};  ///< Decisions an episode to episodes.
};

/// An episode that is shown, with its preview.
struct ExampleEpisode {
  std::string part;  ///< "open/train"
  std::string key;
  std::string door_id;
  std::string category;
  std::string detail;
  std::string png;
};

/// A planned episode that failed and was not written.
struct UnwrittenEpisode {
  std::string part;  ///< "open/train"
  std::string key;
  std::string door_id;
  std::string outcome;
  std::string detail;
};

struct EpisodeDescription {
  std::vector<StageEpisodes> stages;  ///< Sorted by name.
  std::vector<ExampleEpisode>
      examples;  ///< They are the first of every category that have a preview.
  std::vector<UnwrittenEpisode> unwritten;  ///< They are in the order of parts and shards.
};

/// Reads the indices and every episode's meta.json. Does not depend on the number of threads.
///
/// @param examples Number of episodes to show of each stage and category.
/// @throws Error(kMissing or kFormat).
EpisodeDescription DescribeEpisodes(const std::filesystem::path& folder, int examples,
                                    int threads = 0);

/// The stages as JSON, to be added to DescribeDataset() under "stages"; examples left out.
nlohmann::ordered_json StagesToJson(const EpisodeDescription& description);

/// Success by category and by mechanism as a table for people.
std::string StagesText(const EpisodeDescription& description);

/// One HTML page without any reference to hosts or, but for the films, to other files: counts,
/// success, angles, causes, pictures, every failure. Well-formed XML.
///
/// @param dataset DescribeDataset().
/// @param films Address of a page of films, relative to where the page will be, to which every
///     failure is linked; empty: there is none.
std::string DatasetPage(const nlohmann::ordered_json& dataset,
                        const EpisodeDescription& description, const std::string& films = {});

}  // namespace doorforge
