// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/remembered_view.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

Eigen::Vector3d PointOf(const LabelledCloud& cloud, std::size_t i) {
  return {cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]};
}

auto CountOf(const LabelledCloud& cloud, PointLabel label) {
  return std::ranges::count(cloud.label, static_cast<std::uint8_t>(label));
}

// How far outside of the nearest of the handle's convex pieces a point of the closed door lies [m].
double OutsideHandle(const DoorAsset& door, const Scene& scene, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d p =
      (scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink]).inverse() * point_m;
  double nearest = 1e9;
  for (const DoorGeometry& geometry : door.links[kHandleLink].geometry) {
    for (const auto& hull : geometry.hulls) {
      double outside = -1e9;
      for (const auto& triangle : hull.triangles) {
        const auto vertex = [&](int k) {
          return hull.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])];
        };
        const Eigen::Vector3d normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
        outside = std::max(outside, normal.normalized().dot(p - vertex(0)));
      }
      nearest = std::min(nearest, outside);
    }
  }
  return nearest;
}

class RememberedViewTest : public testing::Test {
 protected:
  RememberedViewTest()
      : robot_(LoadMobileFranka()),
        door_(MakePrimitiveDoor(RandomPrimitive(Mechanism::kRound, 5, 1))),
        scene_(SampleScene(door_, 5, 1)) {}

  // The decisions of a stage, as a camera sees them that remembers or does not.
  Episode Watched(Stage stage, const RememberedViewConfig& config) {
    CameraObserver camera(scene_, door_, robot_);
    if (config.IsOn()) camera.Remember({scene_, door_, robot_, {}, config});
    HandleExpert turns;
    OpeningExpert opens;
    Episode episode = RunStages(scene_, door_, robot_,
                                {.recorded = stage, .handle = &turns, .open = &opens}, &camera);
    EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
    return episode;
  }

  RobotModel robot_;
  DoorAsset door_;
  Scene scene_;
};

TEST_F(RememberedViewTest, ShowsTheKnobThatTheHandHides) {
  const Episode now = Watched(Stage::kHandle, {.resolution_scale = 0});
  const Episode joined = Watched(Stage::kHandle, {.resolution_scale = 2, .crop_radius_m = 0.25});
  EXPECT_EQ(joined.state_sha256, now.state_sha256) << "the physics is the same";
  const LabelledCloud& hidden = now.decisions.at(0).cloud;
  const LabelledCloud& cloud = joined.decisions.at(0).cloud;
  EXPECT_LT(CountOf(hidden, PointLabel::kHandle), 20) << "else this door shows nothing";
  EXPECT_GT(CountOf(cloud, PointLabel::kHandle), 100);
  EXPECT_GT(CountOf(cloud, PointLabel::kRobot), 50) << "what is seen now is there too";
  ASSERT_EQ(cloud.label.size(), 4096U);
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    EXPECT_LE((PointOf(cloud, i) - PointOf(cloud, 0)).norm(), 0.25 + 1e-6);
    if (cloud.label[i] == static_cast<std::uint8_t>(PointLabel::kHandle)) {
      EXPECT_LT(OutsideHandle(door_, scene_, PointOf(cloud, i)), 1e-3) << i;
    }
  }
}

TEST_F(RememberedViewTest, PointZeroIsTheNearestOfBothToTheFingers) {
  const LabelledCloud visible{{0, 0, 0, 1, 0, 0}, {0, 1}};
  const LabelledCloud before{{0.5F, 0, 0, 0.9F, 0, 0}, {2, 3}};
  const LabelledCloud all = JoinedCloud(visible, before, {0.6, 0, 0}, {4, 0});
  EXPECT_EQ(all.label[0], 2);
  EXPECT_EQ(std::vector<std::uint8_t>(all.label.begin(), all.label.end()),
            (std::vector<std::uint8_t>{2, 0, 1, 3}))
      << "the farthest from those that are there comes next, the first among equals";
  const LabelledCloud near = JoinedCloud(visible, before, {0.6, 0, 0}, {4, 0.45});
  EXPECT_EQ(std::ranges::count(near.label, 0), 0) << "0.5 m from point 0";
  EXPECT_GT(std::ranges::count(near.label, 3), 0);
}

TEST_F(RememberedViewTest, OpeningIsSeenAsItIs) {
  const Episode now = Watched(Stage::kOpen, {.resolution_scale = 0});
  const Episode joined = Watched(Stage::kOpen, {});
  ASSERT_EQ(joined.decisions.size(), now.decisions.size());
  for (std::size_t i = 0; i < now.decisions.size(); ++i)
    EXPECT_EQ(joined.decisions[i].cloud.xyz, now.decisions[i].cloud.xyz) << i;
}

TEST_F(RememberedViewTest, RefusesNumbersOutOfRangeByName) {
  const auto message_of = [&](const RememberedViewConfig& config) -> std::string {
    try {
      RememberedView(scene_, door_, robot_, {}, config);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of({.resolution_scale = 9}).find("remembered.finer"), std::string::npos);
  EXPECT_NE(message_of({.resolution_scale = -1}).find("remembered.finer"), std::string::npos);
  EXPECT_NE(message_of({.resolution_scale = 0}).find("remembered.finer"), std::string::npos);
  EXPECT_NE(message_of({.crop_radius_m = -0.1}).find("remembered.within_m"), std::string::npos);
  EXPECT_EQ(message_of({}), "");
}

}  // namespace
}  // namespace doorforge
