// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/run_trials.h"

#include <limits>
#include <mutex>
#include <set>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/evaluate/take_pictures.h"
#include "doorforge/report/success_statistics.h"
#include "doorforge/rollout/opening_expert.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// Opens by the expert's rules, but stops after some actions; how many it has taken must be
// forgotten at Reset().
class TiringPolicy : public Policy {
 public:
  void Reset() override {
    expert_.Reset();
    actions_ = 0;
  }
  Action Act(const Observation& observation) override {
    Action action = expert_.Act(observation);
    if (++actions_ > 4) action.position_delta_m.setZero();
    return action;
  }

 private:
  OpeningExpert expert_;
  int actions_ = 0;
};

std::vector<DoorAsset> Doors() {
  std::vector<DoorAsset> doors;
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    PrimitiveDoor door;
    door.mechanism = mechanism;
    doors.push_back(MakePrimitiveDoor(door));
    doors.back().id = std::string(NameOf(mechanism));
  }
  return doors;
}

TrialPlan PlanFor(const std::vector<DoorAsset>& doors, const EvaluationConfig& config) {
  const auto give = [doors](std::size_t door) {
    return IdentifiedDoor{std::make_shared<const DoorAsset>(doors.at(door)),
                          ContentHash(doors.at(door))};
  };
  return {give, doors.size(), config};
}

TrialPolicies Tiring() {
  return {[] { return PolicySet{std::make_unique<TiringPolicy>()}; }};
}

TEST(RunTrials, EveryDoorIsTriedInEverySeed) {
  EvaluationConfig config;
  config.seeds = 2;
  config.first_seed = 40;
  config.episodes_per_door = 3;
  const auto doors = Doors();
  const TrialPlan trials = PlanFor(doors, config);
  ASSERT_EQ(trials.size(), doors.size() * 2 * 3);
  std::set<std::tuple<std::string, std::uint64_t, std::uint64_t>> different;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto [door, scene, gone] = trials.At(i);
    EXPECT_EQ(door->id, doors[i / 6].id) << "ordered by door, seed and episode";
    EXPECT_EQ(trials.DoorOf(i), i / 6);
    EXPECT_EQ(scene.door_id, door->id);
    EXPECT_EQ(scene.seed, 40 + i / 3 % 2);
    EXPECT_EQ(scene.episode, i % 3);
    different.insert({scene.door_id, scene.seed, scene.episode});
  }
  EXPECT_EQ(different.size(), trials.size());
}

TEST(RunTrials, SettingsOutOfRangeAreRefused) {
  EvaluationConfig config;
  config.seeds = 0;
  EXPECT_THROW(PlanFor(Doors(), config), Error);
  config.seeds = std::numeric_limits<int>::max();  // rows that no memory holds
  EXPECT_THROW(PlanFor(Doors(), config), Error);
  config.seeds = 1;
  config.episodes_per_door = -1;
  EXPECT_THROW(PlanFor(Doors(), config), Error);
}

TEST(RunTrials, RowsDoNotDependOnTheNumberOfThreads) {
  EvaluationConfig config;
  config.seeds = 2;
  const auto doors = Doors();
  const TrialPlan trials = PlanFor(doors, config);
  const auto one = RunTrials(trials, Tiring(), {.threads = 1, .done = nullptr});
  std::mutex mutex;
  std::size_t told = 0;
  const auto three =
      RunTrials(trials, Tiring(), {.threads = 3, .done = [&](const EvaluatedEpisode&) {
                                     const std::scoped_lock lock(mutex);
                                     ++told;
                                   }});
  EXPECT_EQ(told, trials.size());
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].state_sha256, three[i].state_sha256) << one[i].door_id;
    EXPECT_EQ(one[i].detail, three[i].detail);
    EXPECT_EQ(one[i].door_id, doors[trials.DoorOf(i)].id) << "rows are in the trials' order";
  }
}

TEST(RunTrials, TheExpertOpensWhatAPolicyThatStopsDoesNot) {
  EvaluationConfig config;
  config.seeds = 1;
  const auto doors = Doors();
  const TrialPlan trials = PlanFor(doors, config);
  const TrialPolicies expert{[] { return PolicySet{std::make_unique<OpeningExpert>()}; }};
  const auto good = Summarise(RunTrials(trials, expert));
  const auto bad = Summarise(RunTrials(trials, Tiring()));
  EXPECT_EQ(good.opened.successes, 3);
  EXPECT_EQ(bad.opened.successes, 0);
  EXPECT_EQ(bad.outcomes[static_cast<int>(EpisodeOutcome::kDoorStuck)], 3);
  EXPECT_EQ(bad.handle_turned.successes, 3) << "the same rule turns the handle";
  // two fingers that squeeze with 80 N each, and never a crash into the door
  EXPECT_GT(good.median_force_n, 80);
  EXPECT_LT(good.peak_force_n, 2000);
}

TEST(TakePictures, GivesEveryDoorAFilmOfEachOutcomeAndTheCamerasView) {
  EvaluationConfig config;
  config.seeds = 1;
  const std::vector<DoorAsset> doors = {Doors().front()};
  const TrialPlan trials = PlanFor(doors, config);
  const auto rows = RunTrials(trials, Tiring());
  const ReportPictures pictures = TakePictures({trials, rows}, Tiring(), 2);
  EXPECT_EQ(pictures.doors.size(), doors.size());
  std::set<EpisodeOutcome> outcomes;
  for (const EvaluatedEpisode& row : rows) outcomes.insert(row.outcome);
  ASSERT_EQ(pictures.episodes.size(), outcomes.size());
  for (const auto& [outcome, film] : pictures.episodes) {
    EXPECT_TRUE(outcomes.contains(outcome));
    EXPECT_GE(film.frames.size(), 4U) << "start, grasped, (unlocked), opening, end";
    EXPECT_NE(film.frames.front().png, film.frames.back().png) << "something moved";
  }
  for (const ReportPicture* picture : {&pictures.scene, &pictures.depth, &pictures.cloud})
    EXPECT_EQ(picture->png.substr(1, 3), "PNG");
}

// the two rooms must agree on how a record says it
TEST(RunTrials, AGrasperWithoutAHandleInViewIsACauseOfItsOwn) {
  class Blind : public GraspPolicy {
   public:
    std::optional<GraspAction> Choose(const GraspObservation&) override { return std::nullopt; }
  };
  EvaluationConfig config;
  config.seeds = 1;
  const std::vector<DoorAsset> doors = {Doors().front()};
  const TrialPolicies blind{[] {
    PolicySet set{std::make_unique<TiringPolicy>()};
    set.grasp = std::make_unique<Blind>();
    return set;
  }};
  const TrialPlan trials = PlanFor(doors, config);
  const auto rows = RunTrials(trials, blind);
  EXPECT_EQ(rows.at(0).outcome, EpisodeOutcome::kNotReached);
  EXPECT_EQ(CauseOf(rows.at(0)), kNoGraspInView);
  EXPECT_TRUE(TakePictures({trials, rows}, blind).episodes.empty()) << "nothing moves";
}

// What happens to a folder of doors while hours of evaluation read from it.
TEST(RunTrials, ADoorThatIsGoneIsACauseAndTheOthersGoOn) {
  EvaluationConfig config;
  config.seeds = 2;
  const auto doors = Doors();
  const auto give = [&doors](std::size_t door) -> IdentifiedDoor {
    if (door == 1)
      throw Error(ErrorCode::kMissing, "doors/round: no such folder; compose it again");
    return {std::make_shared<const DoorAsset>(doors.at(door)), ContentHash(doors.at(door))};
  };
  const TrialPlan trials(give, doors.size(), config);
  std::vector<DoorIdentity> who;
  for (const DoorAsset& door : doors) who.push_back(IdentityOf(door));
  const auto rows = RunTrials(trials, Tiring(), {.threads = 2, .done = nullptr, .doors = who});
  const auto sound = RunTrials(PlanFor(doors, config), Tiring());
  ASSERT_EQ(rows.size(), 6U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].door_id, sound[i].door_id);
    EXPECT_EQ(rows[i].seed, sound[i].seed);
    EXPECT_EQ(rows[i].mechanism, sound[i].mechanism);
    const bool gone = trials.DoorOf(i) == 1;
    EXPECT_EQ(CauseOf(rows[i]), gone ? kDoorGone : CauseOf(sound[i]));
    EXPECT_EQ(rows[i].state_sha256, gone ? "" : sound[i].state_sha256);
  }
  EXPECT_EQ(rows[2].detail, "the door is gone: doors/round: no such folder; compose it again");
  const ReportPictures pictures = TakePictures({trials, rows}, Tiring());
  EXPECT_EQ(pictures.doors.size(), 2U);
  EXPECT_FALSE(pictures.episodes.contains(EpisodeOutcome::kNotReached));
  EXPECT_EQ(TakeFilms({trials, rows}, Tiring()).size(), 4U);
  EXPECT_THROW(RunTrials(trials, Tiring()), Error) << "nobody says who they were";
}

TEST(TakePictures, ShowsTheGraspOfADoorThatOpenedAndOfOneThatDidNotInEachCategory) {
  EvaluationConfig config;
  config.seeds = 1;
  std::vector<DoorAsset> doors = Doors();
  doors.back().category = Category::kSafe;
  const TrialPlan trials = PlanFor(doors, config);
  std::vector<EvaluatedEpisode> rows;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EvaluatedEpisode& row = rows.emplace_back();
    row.door_id = doors[trials.DoorOf(i)].id;
    row.category = doors[trials.DoorOf(i)].category;
    row.outcome = EpisodeOutcome::kHandleSlipped;
  }
  rows.front().outcome = EpisodeOutcome::kOpened;
  // takes hold where the handle is, and sees none on the safe
  class Explaining : public GraspPolicy {
   public:
    bool Explains() const override { return true; }
    std::optional<GraspAction> Choose(const GraspObservation& seen) override {
      if (seen.episode.starts_with("none/")) return std::nullopt;
      GraspAction action;
      action.contact_m = seen.privileged.world_from_tcp.translation();
      action.world_from_hand_rotation = seen.privileged.world_from_tcp.linear();
      GraspExplanation& explanation = action.explanation.emplace();
      for (const double coordinate : action.contact_m)
        explanation.point_xyz.push_back(static_cast<float>(coordinate));
      explanation.affordance_rad = {0.5F};
      return action;
    }
  };
  const TrialPolicies explaining{[] {
    PolicySet set{std::make_unique<TiringPolicy>()};
    set.grasp = std::make_unique<Explaining>();
    return set;
  }};
  const auto grasps = TakeGraspPictures({trials, rows}, explaining, 2);
  ASSERT_EQ(grasps.size(), 2U);
  EXPECT_TRUE(grasps[0].opened);
  EXPECT_FALSE(grasps[1].opened);
  EXPECT_NE(grasps[0].picture.caption.find(doors[0].id), std::string::npos);
  EXPECT_NE(grasps[1].picture.caption.find(doors[1].id), std::string::npos);
  for (const ReportGrasp& grasp : grasps) {
    EXPECT_EQ(grasp.category, Category::kInterior);
    EXPECT_EQ(grasp.picture.png.substr(1, 3), "PNG");
  }
  EXPECT_TRUE(TakeGraspPictures({trials, rows}, Tiring()).empty());
}

TEST(TakePictures, RefusesRowsOfAnotherPolicy) {
  EvaluationConfig config;
  config.seeds = 1;
  const std::vector<DoorAsset> doors = {Doors().front()};
  const TrialPlan trials = PlanFor(doors, config);
  const auto rows = RunTrials(trials, Tiring());
  const TrialPolicies expert{[] { return PolicySet{std::make_unique<OpeningExpert>()}; }};
  EXPECT_THROW(TakePictures({trials, rows}, expert), Error);
}

}  // namespace
}  // namespace doorforge
