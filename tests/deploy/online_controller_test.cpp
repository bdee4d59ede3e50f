// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/online_controller.h"

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"

#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(DOORFORGE_SOURCE_DIR) / "data";

fs::path SightOf(const std::string& stage) { return kData / "sight" / "lever" / stage; }

DepthImage DepthOf(const std::string& stage) {
  return DecodeDepthPng(ReadFile(SightOf(stage) / "depth.png"), 0.001, "depth");
}

OnlineControllerSetup SetupFor(const std::string& stage) {
  OnlineControllerSetup setup;
  setup.camera = ReadCalibratedCamera(SightOf(stage) / "camera.yaml");
  return setup;
}

nlohmann::json ProgramAnswerOf(const std::string& arguments) {
  return nlohmann::json::parse(
      AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " + arguments + " 2>/dev/null").text);
}

std::string FilesOf(const std::string& stage) {
  const std::string folder = SightOf(stage).string();
  return "--depth " + folder + "/depth.png --camera " + folder + "/camera.yaml";
}

TEST(OnlineController, PicturesInMemoryAreAnsweredAsFilesAreByTheProgram) {
  OnlineControllerSetup setup = SetupFor("open");
  setup.opener = (kData / "policies" / "opener").string();
  OnlineController controller(setup);
  const RobotState state = ReadRobotState(SightOf("open") / "state.yaml", controller.robot());
  const ActAnswer answer = controller.Decide(DepthOf("open"), state);
  const auto program =
      ProgramAnswerOf(FilesOf("open") + " --state " + (SightOf("open") / "state.yaml").string() +
                      " --opener " + setup.opener);
  const RigidTransform hand = TransformFromJson(program["world_from_hand"], "program");
  EXPECT_LT((hand.matrix() - answer.world_from_hand.matrix()).norm(), 1e-9);
  EXPECT_EQ(program["visible_points"], answer.visible_points);
  EXPECT_NEAR(program["expected_gain_rad"].get<double>(), answer.expected_gain_rad, 1e-9);
  EXPECT_EQ(controller.last_seen().depth.depth_m, DepthOf("open").depth_m);
}

TEST(OnlineController, ItTakesHoldOfAHandleInMemoryAsTheProgramDoesOfOneInAFile) {
  OnlineControllerSetup setup = SetupFor("grasp");
  setup.grasper = (kData / "policies" / "grasper").string();
  OnlineController controller(setup);
  const fs::path mask = SightOf("grasp") / "mask.png";
  const ActAnswer answer =
      controller.DecideGrasp(DepthOf("grasp"), DecodeMaskPng(ReadFile(mask), "mask"));
  const auto program = ProgramAnswerOf(FilesOf("grasp") + " --handle-mask " + mask.string() +
                                       " --grasper " + setup.grasper);
  const RigidTransform hand = TransformFromJson(program["world_from_hand"], "program");
  EXPECT_LT((hand.matrix() - answer.world_from_hand.matrix()).norm(), 1e-9);
  EXPECT_EQ(program["handle_points"], *answer.handle_points);
}

TEST(OnlineController, WithoutAMaskItTakesHoldOfTheHandleThatAFinderFinds) {
  OnlineControllerSetup setup = SetupFor("grasp");
  setup.grasper = (kData / "policies" / "grasper").string();
  const PixelMask mask = DecodeMaskPng(ReadFile(SightOf("grasp") / "mask.png"), "mask");
  OnlineController told(setup);
  const ActAnswer by_mask = told.DecideGrasp(DepthOf("grasp"), mask);
  EXPECT_THROW(told.DecideGrasp(DepthOf("grasp"), std::nullopt), Error);
  setup.config.grasp.finder = (kData / "policies" / "finder").string();
  OnlineController finds(setup);
  EXPECT_THROW(finds.DecideGrasp(DepthOf("grasp"), mask), Error);
  const ActAnswer found = finds.DecideGrasp(DepthOf("grasp"), std::nullopt);
  EXPECT_LT((*found.contact_m - *by_mask.contact_m).norm(), 0.03);
  EXPECT_GT(found.world_from_hand.linear().col(2).dot(by_mask.world_from_hand.linear().col(2)),
            0.99);
  const auto program = ProgramAnswerOf(FilesOf("grasp") + " --grasper " + setup.grasper +
                                       " --set grasp.finder=" + setup.config.grasp.finder);
  const RigidTransform hand = TransformFromJson(program["world_from_hand"], "program");
  EXPECT_LT((hand.matrix() - found.world_from_hand.matrix()).norm(), 1e-9);
  EXPECT_EQ(program["handle_points"], *found.handle_points);
}

TEST(OnlineController, WhatCannotBeUsedIsCalledByTheNamesThatItsUserGave) {
  OnlineControllerSetup setup = SetupFor("open");
  setup.opener = (kData / "policies" / "opener").string();
  OnlineController controller(setup);
  const RobotState state = ReadRobotState(SightOf("open") / "state.yaml", controller.robot());
  DepthImage small = DepthOf("open");
  small.height /= 2;
  small.depth_m.resize(small.depth_m.size() / 2);
  const auto refusal = [&](const InputNames& names) -> std::string {
    try {
      controller.Decide(small, state, names);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({}).find("the depth picture and the camera: "), 0U) << refusal({});
  EXPECT_EQ(refusal({.depth = "/camera/depth", .camera = "/camera/info"})
                .find("/camera/depth and /camera/info: "),
            0U);
}

TEST(OnlineController, NobodyForAStageIsRefusedWithTheWayOut) {
  OnlineControllerSetup setup = SetupFor("open");
  setup.handler = (kData / "policies" / "handler").string();
  OnlineController controller(setup);
  const RobotState state = ReadRobotState(SightOf("open") / "state.yaml", controller.robot());
  try {
    controller.Decide(DepthOf("open"), state);
    FAIL() << "an opener is missing";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("opens"), std::string::npos) << error.what();
  }
}

// What its options were called is still understood, and told.
TEST(ActOptions, EarlierNamesAnswerAlikeWithANote) {
  const std::string sight = FilesOf("grasp");
  const std::string mask = (SightOf("grasp") / "mask.png").string();
  const std::string grasper = " --grasper " + (kData / "policies" / "grasper").string();
  EXPECT_EQ(ProgramAnswerOf(sight + " --handle " + mask + grasper),
            ProgramAnswerOf(sight + " --handle-mask " + mask + grasper));
  const std::string opener = (kData / "policies" / "opener").string();
  const std::string state = " --state " + (SightOf("open") / "state.yaml").string();
  const ProgramAnswer noted = AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " +
                                       FilesOf("open") + state + " --policy " + opener + " 2>&1");
  EXPECT_EQ(noted.code, 0) << noted.text;
  EXPECT_NE(noted.text.find("note: --policy is called --opener now"), std::string::npos)
      << noted.text;
  const ProgramAnswer both =
      AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " + FilesOf("open") + state +
               " --policy " + opener + " --opener " + opener + " 2>&1");
  EXPECT_EQ(both.code, 2) << both.text;
  EXPECT_NE(both.text.find("leave --policy out"), std::string::npos) << both.text;
}

TEST(ActOptions, TheExpertCannotActOnARobotAndAnUnknownPolicyIsToldWithWhatThereIs) {
  const std::string files =
      FilesOf("open") + " --state " + (SightOf("open") / "state.yaml").string();
  const auto refusal = [&](const std::string& opener) {
    const ProgramAnswer answer = AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " + files +
                                          " --opener " + opener + " 2>&1");
    EXPECT_EQ(answer.code, 2) << answer.text;
    return answer.text;
  };
  EXPECT_NE(refusal("expert").find("only the simulator knows"), std::string::npos)
      << refusal("expert");
  EXPECT_NE(refusal("openr").find("`doorforge train open`"), std::string::npos);
}

TEST(OnlineController, TheExampleRunsOnTheSamplePictures) {
  const ProgramAnswer answer =
      AnswerOf(DOORFORGE_BINARY_DIR "/bin/control_loop " + kData.string() + " 2>&1");
  EXPECT_EQ(answer.code, 0) << answer.text;
  std::size_t steps = 0;
  for (std::size_t at = 0; (at = answer.text.find("hold:     no", at)) != std::string::npos; ++at)
    ++steps;
  EXPECT_EQ(steps, 3U) << answer.text;
}

}  // namespace
}  // namespace doorforge
