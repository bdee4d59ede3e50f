// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "film.h"

namespace doorforge::internal {

/// Collects the episodes of a page; a door of several is there once.
class EpisodeWriter {
 public:
  /// At most `points` points of each cloud are kept; 0: no clouds.
  EpisodeWriter(const RobotModel& robot, int points);

  /// `door_key` is equal for films of one door alone.
  void Add(const DoorAsset& door, const std::string& door_key, const Film& film);

  std::size_t size() const { return content_.document["episodes"].size(); }
  const PageContent& content() const { return content_; }
  PageContent& content() { return content_; }

 private:
  int points_;
  PageContent content_;
  std::map<std::string, std::size_t> door_numbers_;
};

}  // namespace doorforge::internal
