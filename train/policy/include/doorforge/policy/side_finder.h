// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "doorforge/core/named_enum.h"
#include "doorforge/policy/side_classifier.h"
#include "doorforge/schemas/episode_memory.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// Where a policy takes the hinge to be.
enum class SideChoice {
  kAuto,  ///< The picture says; where that leads nowhere, on the other side.
  kLeft,
  kRight,
};
inline constexpr NamedValue<SideChoice> kSideChoices[] = {
    {SideChoice::kAuto, "auto"}, {SideChoice::kLeft, "left"}, {SideChoice::kRight, "right"}};
constexpr std::span<const NamedValue<SideChoice>> ValuesOf(SideChoice) { return kSideChoices; }

constexpr HingeSide Opposite(HingeSide side) {
  return side == HingeSide::kLeft ? HingeSide::kRight : HingeSide::kLeft;
}

/// On which side of an episode's door the hinge is, as far as its policies know: at first right
/// where the picture from before the robot came leaves no doubt of it, else left; then what they
/// have found out.
class SideFinder : public EpisodeMemory {
 public:
  SideFinder(SideChoice choice, std::optional<SideClassifier> classifier)
      : choice_(choice), classifier_(std::move(classifier)) {}

  bool WantsPicture() const override { return classifier_ && choice_ == SideChoice::kAuto; }
  void Begin(std::optional<LabelledCloud> before) override;

  /// Counts episodes from 1 on; 0 before the first.
  std::uint64_t episode() const { return episode_; }
  /// The next grasp of the episode: unless the picture was clear about it, it begins with the other
  /// side than the one before.
  void GoOver();
  /// What to begin with for who holds the handle with the hand here.
  HingeSide SideFor(const Eigen::Vector3f& hand_m);
  /// Whether the other side may be tried.
  bool MayChange() const { return choice_ == SideChoice::kAuto; }
  /// Whether the picture or the door's motion has left no doubt.
  bool IsClear() const { return is_clear_; }
  /// The side is this one, as a policy has found.
  void Found(HingeSide side) { side_ = side; }
  /// It is this one beyond doubt: the door has moved.
  void Confirm(HingeSide side);

 private:
  HingeSide SideFromPicture(const Eigen::Vector3f& hand_m);

  SideChoice choice_;
  std::optional<SideClassifier> classifier_;
  std::optional<LabelledCloud> before_;
  std::optional<HingeSide> side_;
  HingeSide first_ = HingeSide::kLeft;  // of the present grasp
  bool is_clear_ = false;
  std::uint64_t episode_ = 0;
};

}  // namespace doorforge
