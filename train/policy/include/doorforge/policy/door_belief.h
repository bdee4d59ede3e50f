// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "doorforge/core/named_enum.h"
#include "doorforge/policy/door_height.h"
#include "doorforge/policy/side_classifier.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/episode_memory.h"
#include "doorforge/schemas/motion_way.h"
#include "doorforge/schemas/names.h"

namespace doorforge {

/// What a policy takes a door to be where its shape need not say it.
struct DoorGuess {
  HingeSide side = HingeSide::kLeft;      ///< Of the hinge.
  MotionWay turning = MotionWay::kUsual;  ///< Of the handle.
  MotionWay opening = MotionWay::kUsual;  ///< kUsual: it is pulled, kOther: pushed.

  friend bool operator==(const DoorGuess&, const DoorGuess&) = default;
};

/// What a policy is told of the hinge's side.
enum class SideChoice { kAuto, kLeft, kRight };
inline constexpr NamedValue<SideChoice> kSideChoices[] = {
    {SideChoice::kAuto, "auto"}, {SideChoice::kLeft, "left"}, {SideChoice::kRight, "right"}};
constexpr std::span<const NamedValue<SideChoice>> ValuesOf(SideChoice) { return kSideChoices; }

/// What it is told of the sense in which the handle unlocks, see MotionWay.
enum class TurningChoice { kAuto, kUsual, kReversed };
inline constexpr NamedValue<TurningChoice> kTurningChoices[] = {
    {TurningChoice::kAuto, "auto"},
    {TurningChoice::kUsual, "usual"},
    {TurningChoice::kReversed, "reversed"}};
constexpr std::span<const NamedValue<TurningChoice>> ValuesOf(TurningChoice) {
  return kTurningChoices;
}

/// What it is told of the way in which the door opens.
enum class OpeningChoice { kAuto, kPull, kPush };
inline constexpr NamedValue<OpeningChoice> kOpeningChoices[] = {
    {OpeningChoice::kAuto, "auto"}, {OpeningChoice::kPull, "pull"}, {OpeningChoice::kPush, "push"}};
constexpr std::span<const NamedValue<OpeningChoice>> ValuesOf(OpeningChoice) {
  return kOpeningChoices;
}

/// kAuto: the policy finds out.
struct ToldOfDoor {
  SideChoice side = SideChoice::kLeft;
  TurningChoice turning = TurningChoice::kUsual;
  OpeningChoice opening = OpeningChoice::kPull;

  bool LeavesOpen() const {
    return side == SideChoice::kAuto || turning == TurningChoice::kAuto ||
           opening == OpeningChoice::kAuto;
  }
};

/// What pictures of closed doors have taught.
struct DoorKnowledge {
  std::optional<SideClassifier> side = {};    ///< Where hinges are.
  std::optional<LearnedHeights> pushed = {};  ///< Of doors of which pushing was learned.
};

/// What the policies of a set believe of an episode's door: a probability for each guess that what
/// they are told leaves open. It begins with the picture of the closed door for the side, and for
/// whether it may be pushed at all, and with how common handles and doors are that go the other
/// way. A grasp goes by one guess from its first to its last action, the likeliest; one that led
/// nowhere makes all guesses by which the hand would have done the same unlikelier (Bayes' rule,
/// with the chance that a right guess fails). So the next grasp goes by another guess, or by the
/// same where there is no other worth a try.
class DoorBelief : public EpisodeMemory {
 public:
  DoorBelief(const ToldOfDoor& told, const DoorKnowledge& knowledge)
      : told_(told), knowledge_(knowledge) {}

  bool WantsPicture() const override {
    return (knowledge_.side && told_.side == SideChoice::kAuto) ||
           (knowledge_.pushed && told_.opening == OpeningChoice::kAuto);
  }
  void Begin(std::optional<LabelledCloud> before) override;

  /// For who chooses where to take hold [m]: the guess by which the coming grasp goes.
  const DoorGuess& ForGrasp(const Eigen::Vector3f& contact_m);
  /// For the policy of a stage, kHandle or kOpen, at its first action. A stage that begins again,
  /// or before its turn, belongs to the next grasp.
  const DoorGuess& ForStage(Stage stage, const Eigen::Vector3f& hand_m);
  /// The hand does not do what the stage's policy asks for. At kHandle the door may have no latch,
  /// so opening is tried next; where that stalls as well, the grasp is given up.
  void NoteStall(Stage stage);
  /// At kOpen the leaf came with the hand some way. So it is not held by a latch and opens the way
  /// that was guessed; that the grasp led nowhere is then for the side, or for a handle that went
  /// back since it turns the other way.
  void NoteLeafFollows() { leaf_follows_ = true; }
  bool GivesUp() const override { return gives_up_; }
  /// Whether there is something to find out by trying.
  bool LeavesOpen() const { return told_.LeavesOpen(); }

 private:
  struct Weighed {
    DoorGuess guess;
    double weight = 0;
  };
  void Weigh(const Eigen::Vector3f& hand_m);
  double LeftShare(const Eigen::Vector3f& hand_m) const;
  double PushedShare() const;
  double ReversedShare() const;
  bool IsSeen() const { return before_ && !before_->xyz.empty(); }
  double ChanceOfFailure(const DoorGuess& truth) const;
  double ChanceThatItFollowed(const DoorGuess& truth) const;
  void NextGrasp();

  ToldOfDoor told_;
  DoorKnowledge knowledge_;
  std::optional<LabelledCloud> before_;
  std::array<Weighed, 8> weighed_;
  bool is_weighed_ = false;
  std::optional<Stage> reached_;  // of the present grasp, as the following
  bool handle_stalled_ = false;
  bool leaf_follows_ = false;
  bool gives_up_ = false;
  DoorGuess guess_;
};

}  // namespace doorforge
