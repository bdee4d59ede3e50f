// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/opening_expert.h"

namespace doorforge {

struct SimulateConfig {
  SceneConfig scene;
  OpeningExpertConfig expert;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scene", self.scene);
    visit("expert", self.expert);
  }
};

struct SimulateOptions {
  std::vector<std::filesystem::path> doors;  ///< Folders with a door.json, or folders of them.
  std::uint64_t seed = 1;
  int seeds = 1;     ///< Seeds seed, seed + 1, ...
  int episodes = 1;  ///< Of each door in each seed.
  int threads = 0;
  bool json = false;
  std::filesystem::path film;  ///< Empty: no pictures.
  bool overwrite = false;      ///< Of pictures that are there.
  SimulateConfig config;
};

/// Lets the expert open every door and prints outcome and cause of each episode, then a summary.
/// Returns 0 if all were opened, otherwise 1.
int Simulate(const SimulateOptions& options);

}  // namespace doorforge
