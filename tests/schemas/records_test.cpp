// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/schemas/camera_model.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {
namespace {

TEST(Names, EveryNameReadsBack) {
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(CategoryNamed(NameOf(static_cast<Category>(i))), static_cast<Category>(i));
    EXPECT_EQ(MechanismNamed(NameOf(static_cast<Mechanism>(i))), static_cast<Mechanism>(i));
  }
  EXPECT_EQ(CategoryNamed("Interior"), std::nullopt);
}

// Camera x to the right, y down, z forward: the target projects to the middle of the image, and a
// point above the target lies above the middle (smaller row).
TEST(CameraModel, FollowsTheOpenCvConvention) {
  const CameraModel camera;
  const RigidTransform camera_from_world = WorldFromCamera(camera).inverse();
  const Eigen::Vector3d target = camera_from_world * camera.target_m;
  EXPECT_NEAR(target.x(), 0, 1e-12);
  EXPECT_NEAR(target.y(), 0, 1e-12);
  EXPECT_NEAR(target.z(), (camera.target_m - camera.position_m).norm(), 1e-12);
  EXPECT_LT((camera_from_world * (camera.target_m + Eigen::Vector3d(0, 0, 0.1))).y(), 0);
  // the camera looks along -x, so world +y is on its right
  EXPECT_GT((camera_from_world * (camera.target_m + Eigen::Vector3d(0, 0.1, 0))).x(), 0);
  EXPECT_NEAR(WorldFromCamera(camera).linear().determinant(), 1, 1e-12);
}

// 90 degrees across 256 pixels: half the width is one focal length.
TEST(CameraModel, FocalLengthFollowsFromTheFieldOfView) {
  EXPECT_NEAR(IntrinsicMatrix(CameraModel{})(0, 0), 128, 1e-9);
  EXPECT_NEAR(IntrinsicMatrix(CameraModel{})(1, 2), 128, 1e-9);
}

TEST(Policy, ActionsKeepTheirRotation) {
  Action action;
  action.position_delta_m = {0.01, -0.02, 0.03};
  action.world_from_hand_rotation = FromXyzRpy({0, 0, 0}, {3, 0.4, -1}).linear();
  const Action again = FromVector(ToVector(action));
  EXPECT_TRUE(again.world_from_hand_rotation.isApprox(action.world_from_hand_rotation, 1e-6));
  EXPECT_TRUE(again.position_delta_m.isApprox(action.position_delta_m, 1e-6));
}

TEST(Policy, AnySixNumbersGiveARotation) {
  for (const ActionVector& vector :
       {ActionVector{0, 0, 0, 0, 0, 0, 0, 0, 0}, ActionVector{0, 0, 0, 2, 0, 0, 4, 0, 0},
        ActionVector{0, 0, 0, 1, 1, 0, 0, 1, 1}}) {
    const Eigen::Matrix3d r = FromVector(vector).world_from_hand_rotation;
    EXPECT_TRUE((r * r.transpose()).isIdentity(1e-6));
    EXPECT_NEAR(r.determinant(), 1, 1e-6);
  }
  ActionVector bad{};
  bad[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(FromVector(bad), Error);
}

TEST(Policy, StateIsTheArmWithoutTheFingers) {
  Proprioception proprioception{};
  for (std::size_t i = 0; i < proprioception.size(); ++i) proprioception[i] = static_cast<float>(i);
  const PolicyState state = PolicyStateOf(proprioception);
  EXPECT_EQ(state[0], 0);
  EXPECT_EQ(state[8], 8);
  EXPECT_EQ(state[9], 11) << "velocities start behind 11 positions";
  EXPECT_EQ(state[17], 19);
  EXPECT_EQ(HandPositionOf(proprioception), Eigen::Vector3f(25, 26, 27));
  EXPECT_EQ(BasePositionOf(proprioception), Eigen::Vector3f(22, 23, 24));
  EXPECT_EQ(FingerOpeningsOf(proprioception), Eigen::Vector2f(9, 10));
  for (std::size_t i = 28; i < 32; ++i) proprioception[i] = 0.5F;  // x to y to z to x
  EXPECT_TRUE((HandRotationOf(proprioception) * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-6));
}

TEST(Episode, MetaReadsBackToTheSameText) {
  Episode episode;
  episode.scene.door_id = "a__b";
  episode.scene.world_from_door = Translation({0, 0.1, 0.1});
  episode.scene.latch.type = LatchType::kEffort;
  episode.outcome = EpisodeOutcome::kGripLost;
  episode.detail = "lost at 31 degrees";
  episode.peak_hinge_rad = 0.54;
  episode.decisions.resize(2);
  episode.decisions[1].time_s = 0.25;
  const auto json = EpisodeMetaToJson(episode);
  EXPECT_EQ(EpisodeMetaToJson(EpisodeFromMeta(json, "meta")).dump(), json.dump());
  EXPECT_FALSE(json.at("success").get<bool>());
  auto bad = json;
  bad["outcome"] = "won";
  EXPECT_THROW(EpisodeFromMeta(bad, "meta"), Error);
}

// Records from before there was a choice keep their bytes.
TEST(Scene, TheRecordHasTheLimitsWhereTheyAreNotTheDefaults) {
  Scene scene;
  EXPECT_FALSE(SceneToJson(scene).contains("episode_limits"));
  EXPECT_EQ(SceneFromJson(SceneToJson(scene), "scene").limits, EpisodeLimits{});
  scene.limits.open_angle_rad = 0.5;
  scene.limits.off_door_actions = 9;
  const auto json = SceneToJson(scene);
  EXPECT_EQ(json.at("episode_limits").at("open_angle_rad"), 0.5);
  EXPECT_EQ(SceneFromJson(json, "scene").limits, scene.limits);
  auto bad = json;
  bad["episode_limits"]["open_angle"] = 0.5;
  EXPECT_THROW(SceneFromJson(bad, "scene"), Error);
}

TEST(Scene, TheRecordHasTheSimulatorWhereItIsNotBullet) {
  Scene scene;
  EXPECT_FALSE(SceneToJson(scene).at("physics").contains("simulator"));
  EXPECT_EQ(SceneFromJson(SceneToJson(scene), "scene").physics.simulator, Simulator::kBullet);
  scene.physics.simulator = Simulator::kMujoco;
  const auto json = SceneToJson(scene);
  EXPECT_EQ(json.at("physics").at("simulator"), "mujoco");
  EXPECT_EQ(SceneFromJson(json, "scene").physics.simulator, Simulator::kMujoco);
}

TEST(EpisodeLimits, EveryFieldIsCheckedAndTheFirstWrongOneNamed) {
  EXPECT_NO_THROW(CheckEpisodeLimits({}, "config.scene.episode"));
  std::size_t fields = 0;
  const EpisodeLimits standard;
  EpisodeLimits::VisitFields(standard, [&](const char*, auto) { ++fields; });
  for (std::size_t wrong = 0; wrong < fields; ++wrong) {
    EpisodeLimits limits;
    std::size_t at = 0;
    std::string name;
    EpisodeLimits::VisitFields(limits, [&](const char* field, auto& value) {
      if (at++ != wrong) return;
      value = -1;
      name = field;
    });
    try {
      CheckEpisodeLimits(limits, "config.scene.episode");
      FAIL() << name << " is not checked";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      EXPECT_EQ(std::string(error.what()).find("config.scene.episode." + name + ": found -1"), 0U)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace doorforge
