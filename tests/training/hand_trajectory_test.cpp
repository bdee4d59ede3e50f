// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Trajectories, how one is chosen and how it is carried out.

#include "doorforge/policy/hand_trajectory.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/policy/trajectory_policy.h"
#include "doorforge/policy/whole_policy.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr double kExactly = 1e-12;

RigidTransform HandAt(const Eigen::Vector3d& place, double yaw) {
  RigidTransform hand = Translation(place);
  hand.linear() = RotationAbout(Eigen::Vector3d::UnitZ(), yaw).linear();
  return hand;
}

TEST(EvenWaypoints, DivideAStraightWayEvenlyWhereverItsPosesAre) {
  const std::vector<RigidTransform> way = {HandAt({1, 0, 0}, 0.3), HandAt({1, 0.01, 0}, 0.3),
                                           HandAt({1, 0.01, 0}, 0.3), HandAt({1, 0.4, 0}, 0.3)};
  const auto waypoints = EvenWaypoints(way, 5);
  ASSERT_EQ(waypoints.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR((waypoints[i].offset_m - Eigen::Vector3d(0, 0.08 * (i + 1.0), 0)).norm(), 0,
                kExactly);
    EXPECT_NEAR(waypoints[i].turn_rad.norm(), 0, kExactly);
  }
}

// A quarter of a circle about the origin, in small steps.
TEST(EvenWaypoints, FollowAnArc) {
  std::vector<RigidTransform> way;
  for (int i = 0; i <= 900; ++i) {
    const double angle = i * (std::numbers::pi / 1800);
    way.push_back(HandAt({0.6 * std::cos(angle), 0.6 * std::sin(angle), 1}, angle));
  }
  const auto waypoints = EvenWaypoints(way, 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const double angle = (i + 1.0) * (std::numbers::pi / 12);
    const Eigen::Vector3d offset(0.6 * std::cos(angle) - 0.6, 0.6 * std::sin(angle), 0);
    EXPECT_NEAR((waypoints[i].offset_m - offset).norm(), 0, 1e-5);
    EXPECT_NEAR((waypoints[i].turn_rad - Eigen::Vector3d(0, 0, angle)).norm(), 0, 1e-5);
  }
}

// A hand that turns on the spot and then moves: 1 rad counts as 0.15 m.
TEST(EvenWaypoints, CountATurnAsAWay) {
  const auto waypoints =
      EvenWaypoints({HandAt({0, 0, 0}, 0), HandAt({0, 0, 0}, 1), HandAt({0.15, 0, 0}, 1)}, 4);
  EXPECT_NEAR(waypoints[0].turn_rad.z(), 0.5, kExactly);
  EXPECT_NEAR(waypoints[1].turn_rad.z(), 1, kExactly);
  EXPECT_NEAR(waypoints[1].offset_m.norm(), 0, kExactly);
  EXPECT_NEAR(waypoints[2].offset_m.x(), 0.075, kExactly);
  EXPECT_NEAR(waypoints[3].offset_m.x(), 0.15, kExactly);
}

TEST(EvenWaypoints, OfAHandThatStaysAreWhereItIs) {
  for (const auto& way : {std::vector<RigidTransform>{HandAt({1, 2, 3}, 1)},
                          std::vector<RigidTransform>(4, HandAt({1, 2, 3}, 1))})
    for (const HandWaypoint& waypoint : EvenWaypoints(way, 3)) {
      EXPECT_NEAR(waypoint.offset_m.norm(), 0, kExactly);
      EXPECT_NEAR(waypoint.turn_rad.norm(), 0, kExactly);
    }
}

HandTrajectory SomeTrajectory(int waypoints) {
  HandTrajectory trajectory;
  trajectory.world_from_hand_rotation = HandAt({0, 0, 0}, 0.7).linear();
  for (int i = 1; i <= waypoints; ++i)
    trajectory.waypoints.push_back({{0.1 * i, 0, -0.05 * i}, {0, 0, 0.25 * i}});
  return trajectory;
}

TEST(HandTrajectory, ComesBackFromItsNumbers) {
  const HandTrajectory trajectory = SomeTrajectory(3);
  const auto numbers = ToNumbers(trajectory);
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(TrajectoryNumbers(3)));
  EXPECT_FLOAT_EQ(numbers[6], 1);  // 0.1 m
  const HandTrajectory back = TrajectoryFromNumbers(numbers);
  EXPECT_TRUE(back.world_from_hand_rotation.isApprox(trajectory.world_from_hand_rotation, 1e-6));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(back.waypoints[i].offset_m.isApprox(trajectory.waypoints[i].offset_m, 1e-6));
    EXPECT_TRUE(back.waypoints[i].turn_rad.isApprox(trajectory.waypoints[i].turn_rad, 1e-6));
  }
  std::vector<float> bad = numbers;
  bad[8] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(TrajectoryFromNumbers(bad), Error);
  bad.resize(8);
  EXPECT_THROW(TrajectoryFromNumbers(bad), Error);
  EXPECT_THROW(TrajectoryFromNumbers({}), Error);
}

// ---- carrying out -------------------------------------------------------------------------------

// The hand's quaternion, xyzw, follows its place at the end of the 32 numbers.
Observation ObservedAt(const RigidTransform& hand) {
  Observation observation;
  const Eigen::Quaterniond turned(hand.linear());
  for (int i = 0; i < 3; ++i)
    observation.proprioception.at(static_cast<std::size_t>(25 + i)) =
        static_cast<float>(hand.translation()[i]);
  for (int i = 0; i < 4; ++i)
    observation.proprioception.at(static_cast<std::size_t>(28 + i)) =
        static_cast<float>(turned.coeffs()[i]);
  return observation;
}

TEST(TrajectoryReplay, LeadsTheHandAlongItsWaypointsAndLeavesItAtTheLast) {
  TrajectoryReplay replay(2);
  EXPECT_THROW(replay.Act({}), Error);
  EXPECT_THROW(replay.Begin({}), Error);
  replay.Begin(SomeTrajectory(3));
  EXPECT_FALSE(replay.UsesPointCloud());
  const RigidTransform start = HandAt({0.5, 0.25, 1}, 0.4);
  for (int action = 1; action <= 8; ++action) {
    // wherever the hand has come to in the meantime
    const Eigen::Vector3d strayed =
        action == 1 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(0.01 * action, -0.02, 0);
    const RigidTransform hand = HandAt(start.translation() + strayed, 0.4 + 0.1 * (action - 1));
    const Action told = replay.Act(ObservedAt(hand));
    const double steps = std::min(action / 2.0, 3.0);
    const Eigen::Vector3d place =
        start.translation() + Eigen::Vector3d(0.1 * steps, 0, -0.05 * steps);
    EXPECT_NEAR((hand.translation() + told.position_delta_m - place).norm(), 0, 1e-6);
    const Eigen::Matrix3d turned = HandAt({0, 0, 0}, 0.4 + 0.25 * steps).linear();
    EXPECT_TRUE(told.world_from_hand_rotation.isApprox(turned, 1e-6)) << action;
    if (action == 3) replay.Reset();  // a stage of the episode ends
  }
  replay.Begin(SomeTrajectory(1));
  EXPECT_NEAR(replay.Act(ObservedAt(start)).position_delta_m.x(), 0.05, 1e-6);
}

// ---- choosing -----------------------------------------------------------------------------------

const TrajectoryLook kSmallLook{.near_points = 12, .far_points = 10, .near_m = 0.2, .finer = 1};
const TrajectoryShape kSmallNetworks{.waypoints = 2,
                                     .latent = 3,
                                     .point_hidden = 16,
                                     .point_features = 32,
                                     .cloud_hidden = 16,
                                     .cloud_features = 8,
                                     .hidden = 16,
                                     .last_hidden = 8};

// A handle of a few points on a leaf.
GraspObservation SomeDoor() {
  GraspObservation seen;
  Rng rng(4, "door");
  for (int i = 0; i < 30; ++i) {
    const bool is_handle = i % 3 == 0;
    const double spread = is_handle ? 0.05 : 0.4;
    for (const double middle : {is_handle ? 0.06 : 0.0, 0.3, 1.0})
      seen.visible.xyz.push_back(static_cast<float>(middle + spread * rng.Normal()));
    seen.visible.label.push_back(
        static_cast<std::uint8_t>(is_handle ? PointLabel::kHandle : PointLabel::kBody));
  }
  const LabelledCloud all = seen.visible;
  seen.sample = [all](const Eigen::Vector3d&, double) { return all; };
  seen.seed = 9;
  seen.episode = "door/0";
  return seen;
}

TrajectoryNetworks SomeTrajectoryNetworks() {
  TrajectoryNetworks networks = InitialTrajectoryNetworks(kSmallNetworks, 5);
  Rng rng(6, "weights");
  for (std::vector<float>* vector : {&networks.proposer, &networks.critic, &networks.affordance})
    for (float& x : *vector) x += static_cast<float>(0.1 * rng.Normal());
  networks.posterior.clear();
  return networks;
}

TEST(ChooseTrajectory, TakesTheBestOfWhatItRates) {
  const TrajectoryRater rater(SomeTrajectoryNetworks());
  const TrajectoryChoice choice{.contacts = 100, .proposals = 20, .opening_rad = 0.9, .actions = 1};
  const GraspObservation seen = SomeDoor();
  const auto chosen = ChooseTrajectory(rater, seen, kSmallLook, choice);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->sight.label.size(), 22U);
  EXPECT_EQ(chosen->affordance.size(), 10U);  // all of the handle
  float best = 0;
  for (std::size_t i = 0; i < 30; i += 3) {
    const Eigen::Vector3f contact(seen.visible.xyz[3 * i], seen.visible.xyz[3 * i + 1],
                                  seen.visible.xyz[3 * i + 2]);
    const float rated = rater.Affordance(chosen->sight, {contact, 0.9F});
    best = std::max(best, rated);
  }
  EXPECT_EQ(best, rater.Affordance(chosen->sight, chosen->target));
  EXPECT_EQ(best, *std::ranges::max_element(chosen->affordance));
  const auto again = ChooseTrajectory(rater, seen, kSmallLook, choice);
  EXPECT_EQ(ToNumbers(again->trajectory), ToNumbers(chosen->trajectory));
  // more proposals are no worse to the critic
  const auto few = ChooseTrajectory(rater, seen, kSmallLook,
                                    {.contacts = 100, .proposals = 1, .opening_rad = 0.9});
  EXPECT_GE(chosen->probability, few->probability);
  EXPECT_EQ(chosen->trajectory.waypoints.size(), 2U);
}

TEST(ChooseTrajectory, TakesAnotherPlaceTheNextTime) {
  const TrajectoryRater rater(SomeTrajectoryNetworks());
  GraspObservation seen = SomeDoor();
  const auto first = ChooseTrajectory(rater, seen, kSmallLook, {});
  seen.tried.push_back({first->target.contact_m.cast<double>(), Eigen::Matrix3d::Identity()});
  const auto second = ChooseTrajectory(rater, seen, kSmallLook, {});
  EXPECT_GT((first->target.contact_m - second->target.contact_m).norm(), 0.02F);
  for (std::uint8_t& label : seen.visible.label)
    label = static_cast<std::uint8_t>(PointLabel::kBody);
  EXPECT_FALSE(ChooseTrajectory(rater, seen, kSmallLook, {}));
}

// One head, several rows: as one by one.
TEST(TrajectoryRater, RatesProposalsAsTheNetworksDo) {
  const TrajectoryNetworks networks = SomeTrajectoryNetworks();
  const TrajectoryRater rater(networks);
  const auto sight = *DoorSightOf(SomeDoor(), kSmallLook);
  const TrajectoryTarget target{{0.1F, 0.3F, 1}, 0.7F};
  Rng rng(2, "proposals");
  const auto proposals = rater.Propose(sight, target, 3, rng);
  std::vector<float> points;
  AppendDoorPoints(sight, target.contact_m, points);
  const PointNet proposer(ProposerShape(kSmallNetworks), networks.proposer);
  const PointNet critic(CriticShape(kSmallNetworks), networks.critic);
  Rng same(2, "proposals");
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<float> own;
    AppendTarget(target, own);
    for (int k = 0; k < 3; ++k) own.push_back(static_cast<float>(same.Normal()));
    const auto said = ToNumbers(TrajectoryFromNumbers(proposer(points, own)));
    EXPECT_EQ(proposals.numbers[i], said);
    own.clear();
    AppendTarget(target, own);
    own.insert(own.end(), said.begin(), said.end());
    EXPECT_FLOAT_EQ(proposals.probability[i], 1 / (1 + std::exp(-critic(points, own)[0])));
  }
}

TEST(MeanOfBest, IsOfFive) {
  EXPECT_FLOAT_EQ(MeanOfBest({0.1F, 0.9F, 0.5F, 0.7F, 0.3F, 0.2F, 0.0F}), 0.52F);
  EXPECT_FLOAT_EQ(MeanOfBest({0.1F, 0.9F}), 0.5F);
}

// Points far from a contact are told apart as well as those at it, in units that suit both.
TEST(DoorPoints, AreToldFinelyNearTheContactAndCoarselyFarFromIt) {
  const DoorSight sight{{1.025F, 2, 3, 1, 2, 4.5F},
                        {static_cast<std::uint8_t>(PointLabel::kHandle),
                         static_cast<std::uint8_t>(PointLabel::kFrame)}};
  std::vector<float> numbers;
  AppendDoorPoints(sight, {1, 2, 3}, numbers);
  const std::vector<float> expected = {0.5F, 0, 0, 0.05F, 0, 0, 1, 0, 0, 0, 0, 3, 0, 0, 3, 0, 0, 1};
  ASSERT_EQ(numbers.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-5) << i;
}

// ---- files --------------------------------------------------------------------------------------

class TrajectoryPolicyFile : public ::testing::Test {
 protected:
  TrajectoryPolicyFile()
      : folder_(fs::temp_directory_path() / ("trajectory_policy_" + std::to_string(::getpid()))),
        record_{SomeTrajectoryNetworks(),
                kSmallLook,
                {.contacts = 3},
                {"trajectories", "0.0", "{}", 7}} {
    WriteTrajectoryPolicy(folder_, record_);
  }
  ~TrajectoryPolicyFile() override { fs::remove_all(folder_); }

  void ExpectRefused(ErrorCode code, const std::string& word) const {
    try {
      ReadWholePolicy(folder_);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  // Replaces a word of the record.
  void Edit(const std::string& from, const std::string& to) const {
    std::string text = ReadFile(folder_ / "policy.json");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(folder_ / "policy.json") << text.replace(at, from.size(), to);
  }

  fs::path folder_;
  TrajectoryPolicyRecord record_;
};

TEST_F(TrajectoryPolicyFile, ComesBack) {
  const TrajectoryPolicyRecord back = ReadTrajectoryPolicy(folder_);
  EXPECT_EQ(back.networks.proposer, record_.networks.proposer);
  EXPECT_EQ(back.networks.critic, record_.networks.critic);
  EXPECT_EQ(back.networks.affordance, record_.networks.affordance);
  EXPECT_EQ(back.networks.shape, record_.networks.shape);
  EXPECT_EQ(back.look, record_.look);
  EXPECT_EQ(back.choice, record_.choice);
  EXPECT_EQ(back.provenance.decisions, 7U);
  const WholePolicy whole = ReadWholePolicy(folder_);
  EXPECT_EQ(whole.hand, nullptr);
  ASSERT_TRUE(whole.stages);
  EXPECT_EQ(whole.privileges.size(), 1U);
  EXPECT_EQ(whole.weights_sha256, back.weights_sha256);
}

TEST_F(TrajectoryPolicyFile, RefusesWhatIsDamagedOrOfAnotherKind) {
  EXPECT_THROW(ReadHandPolicy(folder_), Error);
  Edit("\"waypoints\": 2", "\"waypoints\": 3");
  ExpectRefused(ErrorCode::kFormat, "proposer.head.3");
  Edit("\"waypoints\": 3", "\"waypoints\": 0");
  ExpectRefused(ErrorCode::kFormat, "sizes.waypoints");
  Edit("\"waypoints\": 0", "\"waypoints\": 2");
  Edit("\"contacts\": 3", "\"contacts\": 0");
  ExpectRefused(ErrorCode::kFormat, "choice.contacts");
  Edit("\"contacts\": 0", "\"contacts\": 3");
  Edit("\"network\": \"trajectories\"", "\"network\": \"else\"");
  ExpectRefused(ErrorCode::kFormat, "found \"else\"");
  Edit("\"network\": \"else\"", "\"network\": \"trajectories\"");
  ReadWholePolicy(folder_);
  std::ofstream(folder_ / "policy.safetensors", std::ios::app) << "x";
  ExpectRefused(ErrorCode::kFormat, "its SHA-256");
}

// The policies of the set share what the grasp decided.
TEST_F(TrajectoryPolicyFile, ActsAtAllStages) {
  TrajectoryPolicies policies = MakeTrajectoryPolicies(record_);
  EXPECT_EQ(policies.resolution_scale, 1);
  EXPECT_THROW(policies.open->Act(ObservedAt(HandAt({0, 0, 0}, 0))), Error);
  const auto grasp = policies.grasp->Choose(SomeDoor());
  ASSERT_TRUE(grasp && grasp->explanation);
  EXPECT_EQ(grasp->explanation->affordance_rad.size(), 3U);
  const auto chosen =
      *ChooseTrajectory(TrajectoryRater(record_.networks), SomeDoor(), kSmallLook, record_.choice);
  EXPECT_TRUE(grasp->contact_m.isApprox(chosen.target.contact_m.cast<double>()));
  const RigidTransform start = HandAt({0.5, 0, 1}, 0);
  const HandWaypoint& first = chosen.trajectory.waypoints[0];
  policies.handle->Act(ObservedAt(start));
  const Action told = policies.open->Act(ObservedAt(start));  // the second of two
  EXPECT_NEAR((told.position_delta_m - first.offset_m).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace doorforge
