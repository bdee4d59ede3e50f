// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/policy/door_belief.h"
#include "doorforge/policy/mirroring_policy.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// How a trained policy chooses its action.
struct PolicyOptions {
  /// 1: the action decoded from the latent 0. k > 1: that one and k - 1 from latents drawn from
  /// N(0, I); the critic's highest score is taken (the first of equals).
  int candidates = 1;
  std::uint64_t seed = 1;  ///< The draws begin with it anew at every Reset().
  FeelConfig feel = {};    ///< How what is not told is found out by trying.
  ToldOfDoor told = {};    ///< With kAuto the next grasp of an episode tries something else.
  /// From this probability on, in (0, 1), a handle policy is believed that the handle is turned.
  double switch_probability = 0.5;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("candidates", self.candidates);
    visit("seed", self.seed);
    visit("side", self.told.side);
    visit("stall", self.feel.stall);
    visit("following", self.feel.following);
    visit("turning", self.told.turning);
    visit("opening", self.told.opening);
    visit("switch_probability", self.switch_probability);
  }
};

/// What a policy of the stages "handle" or "open" has learned.
struct MotionNetworks {
  MotionNetworks(StageNetworks learned, Stage of_stage = Stage::kOpen)  // NOLINT(*-explicit-*)
      : networks(std::move(learned)), stage(of_stage) {}

  StageNetworks networks;
  Stage stage;
  std::optional<StageNetworks> pushed = {};  ///< At kOpen: of doors that are pushed.

  bool KnowsBothWays() const;
};

/// An opener's folder may hold another opener's, `pushed`, which has learned doors that are pushed:
/// its path, or nothing.
std::optional<std::filesystem::path> PushedPolicyIn(const std::filesystem::path& opener);

/// Those of a folder that `doorforge train` wrote, and of PushedPolicyIn() it.
///
/// @throws Error as ReadPolicy().
MotionNetworks ReadMotionNetworks(const std::filesystem::path& folder, Stage stage);

/// The policy of a folder that `doorforge train` wrote, of the stage "open" unless said otherwise.
///
/// One instance serves one episode at a time and uses one thread; several threads each load their
/// own. Act() reads the cloud and the proprioception only, and throws Error(kInvalidArgument) if
/// they are not finite or the cloud does not hold 4096 points.
///
/// @param belief Shared by the policies of a set. Null: the policy has one for itself.
/// @throws Error(kMissing or kFormat) as ReadPolicy(), Error(kInvalidConfig) on bad options.
std::unique_ptr<Policy> LoadPolicy(const std::filesystem::path& folder,
                                   const PolicyOptions& options = {}, Stage stage = Stage::kOpen,
                                   std::shared_ptr<DoorBelief> belief = nullptr);

/// Makes one of networks in memory.
std::unique_ptr<Policy> MakePolicy(MotionNetworks learned, const PolicyOptions& options = {},
                                   std::shared_ptr<DoorBelief> belief = nullptr);

/// What policies of a set share of an episode's door. Of the opener's folder it reads
/// `side.safetensors`, where there is one. Pushing is found out where the opener has learned it.
///
/// @param opener A folder that `doorforge train open` wrote; empty: none.
/// @throws Error as ReadPolicy() and ReadSideClassifier().
std::shared_ptr<DoorBelief> LoadDoorBelief(const std::filesystem::path& opener,
                                           const PolicyOptions& options = {});

}  // namespace doorforge
