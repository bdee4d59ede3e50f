// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/policy/side_finder.h"
#include "doorforge/policy/trying_policy.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// How a trained policy chooses its action.
struct PolicyOptions {
  /// 1: the action decoded from the latent 0. k > 1: that one and k - 1 from latents drawn from
  /// N(0, I); the critic's highest score is taken (the first of equals).
  int candidates = 1;
  std::uint64_t seed = 1;  ///< The draws begin with it anew at every Reset().
  StallConfig stall = {};  ///< When the other way or side is tried.
  /// kAuto is not the default: a pull without a latch turns neither way, and a policy that tries
  /// the other side lets go of it (docs/design/notes/2026-11-25-both-sides.md).
  SideChoice side = SideChoice::kLeft;
  /// From this probability on, in (0, 1), a handle policy is believed that the handle is turned.
  double switch_probability = 0.5;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("candidates", self.candidates);
    visit("seed", self.seed);
    visit("stall", self.stall);
    visit("side", self.side);
    visit("switch_probability", self.switch_probability);
  }
};

/// The policy of a folder that `doorforge train` wrote, of the stage "open" unless said otherwise:
/// the policy that turns the handle ("handle") has the same networks.
///
/// One instance serves one episode at a time and uses one thread; several threads each load their
/// own. Act() reads the cloud and the proprioception only, and throws Error(kInvalidArgument) if
/// they are not finite or the cloud does not hold 4096 points.
///
/// @param finder Shared by the policies of a set. Null: doors are hinged on the left, or as
///     `options.side` says.
/// @throws Error(kMissing or kFormat) as ReadPolicy(), Error(kInvalidConfig) on bad options.
std::unique_ptr<Policy> LoadPolicy(const std::filesystem::path& folder,
                                   const PolicyOptions& options = {},
                                   std::string_view stage = "open",
                                   std::shared_ptr<SideFinder> finder = nullptr);

/// Makes one of networks in memory.
std::unique_ptr<Policy> MakePolicy(StageNetworks networks, const PolicyOptions& options = {},
                                   std::shared_ptr<SideFinder> finder = nullptr);

/// What policies of a set share of an episode's door. Of the opener's folder it reads
/// `side.safetensors`, where there is one.
///
/// @param opener A folder that `doorforge train open` wrote; empty: none.
/// @throws Error as ReadPolicy() and ReadSideClassifier().
std::shared_ptr<SideFinder> LoadSideFinder(const std::filesystem::path& opener,
                                           const PolicyOptions& options = {});

}  // namespace doorforge
