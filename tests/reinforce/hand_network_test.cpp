// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/hand_network.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/policy/policy_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

HandState SomeState() {
  HandState state;
  state.world_from_tcp = Translation({0.4, 0.1, 1});
  state.world_from_grasp =
      Translation({0.35, 0.12, 1.01}) * RotationAbout(Eigen::Vector3d::UnitY(), 0.2);
  state.tcp_m_s = {0.1, 0, -0.02};
  state.finger_m = {0.04, 0.03};
  state.hinge_rad = 0.25;
  state.handle_rad = 0.1;
  state.handle_done_rad = 0.6;
  state.locked = true;
  state.hinge_origin_m = {0.3, -0.6, 0.5};
  state.handle_origin_m = {0.35, 0.05, 1};
  return state;
}

// Their places as the header lists them.
TEST(HandFeatures, AreWhatTheHeaderSays) {
  const HandFeatures features = HandFeaturesOf(SomeState());
  const auto expect = [&](std::size_t at, std::vector<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(features.at(at + i), values[i], 1e-5) << at + i;
  };
  expect(0, {-0.5, 0.2, 0.1});   // to the grasp, in tenths of a metre
  expect(3, {0, 0.4, 0});        // its turn, in halves of a radian
  expect(6, {0.5, 0, -0.1});     // velocity
  expect(12, {1, 0.75, 0, -1});  // fingers
  expect(16, {0.5, 0, 0.2, 0, 1, 1});
  expect(22, {0.2, 1.4, 0, 0, 0, 1});  // arm from the hinge, which is upright
  expect(28, {0, 0.5, 0, 1, 0, 0});    // arm from the handle's axis, which is x
  expect(34, {0, 0, 1, 0, 1, 0});      // z and y of the tool
}

TEST(HandFeatures, AreClipped) {
  HandState state = SomeState();
  state.hinge_rad_s = 1e6;
  EXPECT_EQ(HandFeaturesOf(state).at(17), 5);
}

TEST(HandCommand, IsTheActionInTheTasksUnits) {
  HandState state = SomeState();
  const HandTaskConfig task;
  const HandCommand command =
      HandCommandOf(std::vector<float>{0.5F, -2, 0, 1, 0, -0.25F, 0.6F}, state, task);
  EXPECT_TRUE(command.move_m.isApprox(task.move_m * Eigen::Vector3d(0.5, -1, 0)));
  EXPECT_TRUE(command.turn_rad.isApprox(task.turn_rad * Eigen::Vector3d(1, 0, -0.25)));
  EXPECT_THROW(HandCommandOf(std::vector<float>(6), state, task), Error);
  // between the two thresholds the fingers go on as they were told
  for (const bool closes : {false, true}) {
    state.closes_fingers = closes;
    const auto says = [&](float finger) {
      return HandCommandOf(std::vector<float>{0, 0, 0, 0, 0, 0, finger}, state, task).close_fingers;
    };
    EXPECT_TRUE(says(0.6F));
    EXPECT_FALSE(says(-0.6F));
    EXPECT_EQ(says(0.4F), closes);
    EXPECT_EQ(says(-0.4F), closes);
  }
}

class HandPolicyFileTest : public testing::Test {
 protected:
  HandPolicyFileTest()
      : folder_(fs::temp_directory_path() / ("hand_policy_test_" + std::to_string(::getpid()))) {
    record_.shape.hidden = 8;
    record_.parameters = MlpInitialisation(record_.shape, 3, "test.", 1);
    record_.task.max_actions = 77;
    record_.provenance = {"ppo", "0.0", R"({"ppo":{"seed":7}})", 4096, {}};
    WriteHandPolicy(folder_, record_);
  }
  ~HandPolicyFileTest() override { fs::remove_all(folder_); }

  void ExpectRefused(const std::string& word) const {
    try {
      ReadHandPolicy(folder_);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  void Replace(const std::string& from, const std::string& to) const {
    std::ifstream in(folder_ / "policy.json");
    std::string text(std::istreambuf_iterator<char>(in), {});
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(folder_ / "policy.json") << text.replace(at, from.size(), to);
  }

  fs::path folder_;
  HandPolicyRecord record_;
};

TEST_F(HandPolicyFileTest, ComesBackAndActsTheSame) {
  const HandPolicyRecord read = ReadHandPolicy(folder_);
  EXPECT_EQ(read.parameters, record_.parameters);
  EXPECT_EQ(read.task, record_.task);
  EXPECT_EQ(read.provenance.decisions, 4096U);
  EXPECT_EQ(read.provenance.config, record_.provenance.config);
  const HandCommand a = HandNetworkPolicy(record_).Act(SomeState(), {});
  const HandCommand b = HandNetworkPolicy(read).Act(SomeState(), {});
  EXPECT_EQ(a.move_m, b.move_m);
  EXPECT_EQ(a.turn_rad, b.turn_rad);
}

TEST_F(HandPolicyFileTest, RefusesWhatIsDamagedOrOfAnotherKind) {
  Replace("\"max_actions\": 77", "\"max_actions\": -1");
  ExpectRefused("max_actions");
  Replace("\"max_actions\": -1", "\"max_actions\": 77");
  Replace("\"inputs\": 40", "\"inputs\": 41");
  ExpectRefused("inputs, hidden and outputs");
  Replace("\"inputs\": 41", "\"inputs\": 40");
  Replace("\"stage\": \"whole\"", "\"stage\": \"open\"");
  ExpectRefused("a policy of the stage \"open\"");
  Replace("\"stage\": \"open\"", "\"stage\": \"whole\"");
  std::ofstream(folder_ / "policy.safetensors", std::ios::app) << "x";
  ExpectRefused("its SHA-256");
  fs::remove(folder_ / "policy.safetensors");
  ExpectRefused("policy.safetensors");
  fs::remove(folder_ / "policy.json");
  ExpectRefused("policy.json");
}

TEST_F(HandPolicyFileTest, IsNoPolicyOfAStage) {
  try {
    ReadPolicy(folder_, "open");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a policy of the stage \"whole\""), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace doorforge
