// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/hand_sight.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/policy/frozen_sight.h"
#include "doorforge/policy/whole_policy.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

HandState SeenState() {
  HandState state;
  state.world_from_tcp = Translation({0.4, 0.1, 1});
  state.tcp_m_s = {0.1, 0, -0.02};
  state.tcp_rad_s = {0, 0.5, 0};
  state.finger_m = {0.04, 0.03};
  state.finger_m_s = {-0.05, -0.05};
  state.closes_fingers = true;
  return state;
}

LabelledCloud FiveParts() {
  LabelledCloud cloud;
  for (std::uint8_t part = 0; part < kPointLabelCount; ++part) {
    cloud.xyz.insert(cloud.xyz.end(), {0.4F, 0.2F, 0.9F + 0.1F * static_cast<float>(part)});
    cloud.label.push_back(part);
  }
  return cloud;
}

// Their places as the header lists them.
TEST(HandSight, IsWhatTheHeaderSays) {
  const HandSight sight = HandSightOf(SeenState(), FiveParts());
  const std::vector<float> own = {0.4F,  0.1F,  1, 0.5F, 0, -0.1F, 0, 0.5F, 0, 1,
                                  0.75F, -0.5F, 1, 0,    0, 1,     0, 1,    0};
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(sight.own.at(i), own[i], 1e-6) << i;
  std::vector<float> numbers;
  AppendSightPoints(sight.xyz, sight.label, numbers);
  ASSERT_EQ(numbers.size(), std::size_t{5} * kSightPoint);
  const auto expect = [&](PointLabel part, std::vector<float> masks) {
    const auto row = static_cast<std::size_t>(part) * kSightPoint;
    EXPECT_NEAR(numbers[row], 0, 1e-5);
    EXPECT_NEAR(numbers[row + 1], 1, 1e-5);  // a tenth of a metre
    EXPECT_NEAR(numbers[row + 2], static_cast<float>(part) - 1, 1e-5);
    EXPECT_EQ(std::vector<float>(numbers.begin() + static_cast<std::ptrdiff_t>(row) + 3,
                                 numbers.begin() + static_cast<std::ptrdiff_t>(row) + 7),
              masks);
  };
  expect(PointLabel::kHandle, {1, 0, 0, 0});
  expect(PointLabel::kBody, {0, 1, 0, 0});
  expect(PointLabel::kFrame, {0, 0, 1, 0});
  expect(PointLabel::kRobot, {0, 0, 0, 1});
  expect(PointLabel::kOther, {0, 0, 0, 0});
}

// Where nothing is seen there is a point of no part.
TEST(HandSight, OfNothingIsOnePoint) {
  const HandSight sight = HandSightOf(SeenState(), {});
  std::vector<float> numbers;
  AppendSightPoints(sight.xyz, sight.label, numbers);
  EXPECT_EQ(numbers, std::vector<float>(kSightPoint));
}

// What a robot would not know changes nothing of it.
TEST(HandSight, KnowsNothingOfTheDoorsJoints) {
  HandState other = SeenState();
  other.hinge_rad = other.handle_rad = other.hinge_rad_s = other.handle_rad_s = 0.3;
  other.locked = true;
  other.handle_done_rad = 1;
  other.world_from_grasp = Translation({1, 2, 3});
  other.hinge_origin_m = other.handle_origin_m = {3, 2, 1};
  const HandSight one = HandSightOf(SeenState(), FiveParts());
  const HandSight two = HandSightOf(other, FiveParts());
  EXPECT_EQ(one.own, two.own);
  EXPECT_EQ(one.xyz, two.xyz);
}

class SightPolicyFileTest : public testing::Test {
 protected:
  SightPolicyFileTest()
      : folder_(fs::temp_directory_path() / ("sight_policy_test_" + std::to_string(::getpid()))) {
    record_.shape = SightShape({.point_hidden = 8,
                                .point_features = 32,
                                .cloud_hidden = 8,
                                .cloud_features = 8,
                                .hidden = 8,
                                .last_hidden = 8});
    record_.parameters = PointNetInitialisation(record_.shape, 3, "test.");
    record_.task.max_actions = 77;
    record_.look.points = 64;
    record_.provenance = {"dagger", "0.0", R"({"dagger":{"seed":7}})", 4096, {}, "abc"};
    WriteSightPolicy(folder_, record_);
  }
  ~SightPolicyFileTest() override { fs::remove_all(folder_); }

  void ExpectSightRefused(const std::string& word) const {
    try {
      ReadSightPolicy(folder_);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  void ReplaceInRecord(const std::string& from, const std::string& to) const {
    std::ifstream in(folder_ / "policy.json");
    std::string text(std::istreambuf_iterator<char>(in), {});
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(folder_ / "policy.json") << text.replace(at, from.size(), to);
  }

  fs::path folder_;
  SightPolicyRecord record_;
};

TEST_F(SightPolicyFileTest, ComesBackAndActsTheSame) {
  const SightPolicyRecord read = ReadSightPolicy(folder_);
  EXPECT_EQ(read.parameters, record_.parameters);
  EXPECT_EQ(read.shape, record_.shape);
  EXPECT_EQ(read.task, record_.task);
  EXPECT_EQ(read.look, record_.look);
  EXPECT_EQ(read.provenance.teacher_sha256, "abc");
  const WholePolicy whole = ReadWholePolicy(folder_);
  EXPECT_EQ(whole.weights_sha256, read.weights_sha256);
  EXPECT_EQ(whole.hand->look(), record_.look);
  ASSERT_EQ(whole.privileges.size(), 2U);
  EXPECT_NE(whole.privileges[0].find("of which part each point is"), std::string::npos);
  const HandCommand a = HandSightPolicy(record_).Act(SeenState(), FiveParts());
  const HandCommand b = whole.hand->Act(SeenState(), FiveParts());
  EXPECT_EQ(a.move_m, b.move_m);
  EXPECT_EQ(a.turn_rad, b.turn_rad);
}

TEST_F(SightPolicyFileTest, RefusesWhatIsDamagedOrOfAnotherKind) {
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& word) {
    ReplaceInRecord(from, to);
    ExpectSightRefused(word);
    ReplaceInRecord(to, from);
  };
  refused("\"points\": 64", "\"points\": -4", "points");
  refused("\"max_actions\": 77", "\"max_actions\": -1", "max_actions");
  refused("\"own\": 19", "\"own\": 18", "point, own and outputs");
  refused("\"point_features\": 32", "\"point_features\": 33", "a multiple of 32");
  refused("\"hidden\": 8,", "\"hidden\": 100000,", "hidden: 100000");
  refused("\"hidden\": 8,", "\"hidden\": 9,", "actor.head.0.weight");
  refused("\"network\": \"point_net\"", "\"network\": \"other\"", "expected \"point_net\"");
  refused("\"stage\": \"whole\"", "\"stage\": \"open\"", "a policy of the stage \"open\"");
  std::ofstream(folder_ / "policy.safetensors", std::ios::app) << "x";
  ExpectSightRefused("its SHA-256");
  fs::remove(folder_ / "policy.safetensors");
  ExpectSightRefused("policy.safetensors");
}

TEST_F(SightPolicyFileTest, IsToldFromAPolicyOfStates) {
  try {
    ReadHandPolicy(folder_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a policy that looks"), std::string::npos);
  }
  HandPolicyRecord states;
  states.parameters = MlpInitialisation(states.shape, 3, "test.", 1);
  states.provenance = {"ppo", "0.0", "{}", 1, {}};
  WriteHandPolicy(folder_, states);
  ExpectSightRefused("a policy of true states");
  const WholePolicy whole = ReadWholePolicy(folder_);
  EXPECT_FALSE(whole.hand->look());
  EXPECT_NE(whole.privileges.at(0).find("true states"), std::string::npos);
}

// ---- acting on features -------------------------------------------------------------------------

FrozenPolicyRecord FrozenFrom(const SightPolicyRecord& sees) {
  FrozenPolicyRecord record;
  record.sight_shape = sees.shape;
  record.sight = sees.parameters;
  record.look = sees.look;
  record.shape = {sees.shape.cloud_features + kSightOwn, 8, kHandActions};
  record.parameters = MlpInitialisation(record.shape, 4, "test.", 1);
  record.task.max_actions = 55;
  record.provenance = {"ppo", "0.0", "{}", 9, {}, "sees"};
  return record;
}

// The features are what the whole network goes on from.
TEST_F(SightPolicyFileTest, FrozenItIsItsNetworkUpToTheLayersBehindTheCloud) {
  const FrozenSight sight(record_.shape, record_.parameters, record_.look);
  const std::vector<float> numbers = sight.NumbersOf(SeenState(), FiveParts());
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(sight.size()));
  ASSERT_EQ(sight.size(), 8 + kSightOwn);
  const HandSight seen = HandSightOf(SeenState(), FiveParts());
  std::vector<float> points;
  AppendSightPoints(seen.xyz, seen.label, points);
  const PointNet network(record_.shape, record_.parameters);
  EXPECT_EQ(network.Outputs(std::span(numbers).first(8), std::span(numbers).subspan(8)),
            network(points, seen.own));
}

TEST_F(SightPolicyFileTest, APolicyOfFeaturesComesBackAndIsToldFromOthers) {
  EXPECT_THROW(ReadFrozenPolicy(folder_), Error);
  const FrozenPolicyRecord frozen = FrozenFrom(record_);
  WriteFrozenPolicy(folder_, frozen);
  ExpectSightRefused("a policy that acts on features");
  const FrozenPolicyRecord read = ReadFrozenPolicy(folder_);
  EXPECT_EQ(read.sight, frozen.sight);
  EXPECT_EQ(read.sight_shape, frozen.sight_shape);
  EXPECT_EQ(read.parameters, frozen.parameters);
  EXPECT_EQ(read.look, frozen.look);
  EXPECT_EQ(read.task, frozen.task);
  EXPECT_EQ(read.provenance.teacher_sha256, "sees");
  const WholePolicy whole = ReadWholePolicy(folder_);
  EXPECT_EQ(whole.hand->look(), record_.look);
  EXPECT_NE(whole.privileges.at(0).find("of which part each point is"), std::string::npos);
  const HandCommand command = whole.hand->Act(SeenState(), FiveParts());
  const Mlp actor(frozen.shape, frozen.parameters);
  const FrozenSight sight(record_.shape, record_.parameters, record_.look);
  const HandCommand expected =
      HandCommandOf(actor(sight.NumbersOf(SeenState(), FiveParts())), SeenState(), frozen.task);
  EXPECT_EQ(command.move_m, expected.move_m);
  ReplaceInRecord("\"cloud_features\": 8", "\"cloud_features\": 9");
  EXPECT_THROW(ReadFrozenPolicy(folder_), Error);
}

}  // namespace
}  // namespace doorforge
