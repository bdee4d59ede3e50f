// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode_writer.h"

#include "doorforge/core/program.h"

#include "record_view.h"

namespace doorforge::internal {

using Json = PageContent::Json;

EpisodeWriter::EpisodeWriter(const RobotModel& robot, int points) : points_(points) {
  content_.document["kind"] = "episodes";
  content_.document["version"] = CodeVersion();
  content_.document["robot"] = RobotForView(robot, content_);
  content_.document["records"] = Json::array();
  content_.document["episodes"] = Json::array();
}

void EpisodeWriter::Add(const DoorAsset& door, const std::string& door_key, const Film& film) {
  const auto [entry, is_new] =
      door_numbers_.try_emplace(door_key, content_.document["records"].size());
  if (is_new)
    content_.document["records"].push_back(DoorForView(door, AllMeshes(content_), content_));
  Json shown = FilmForView(film, points_, content_);
  shown["record"] = entry->second;
  content_.document["episodes"].push_back(std::move(shown));
}

}  // namespace doorforge::internal
