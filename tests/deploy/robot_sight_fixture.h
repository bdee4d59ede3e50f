// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/deploy/robot_observation.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"
#include "../program_answer.h"

namespace doorforge {

/// Networks as they are before training, whose actions have the size of a trained policy's.
inline StageNetworks UntrainedNetworks(NetworkFamily family = NetworkFamily::kMotion) {
  StageNormalisation normalisation;
  normalisation.cloud_centre_m = {0.16F, 0, 0.83F};
  normalisation.state.deviation.fill(0.3F);
  normalisation.action.deviation.fill(0.3F);
  for (std::size_t i = 0; i < 3; ++i) normalisation.action.deviation.at(i) = 0.02F;
  normalisation.action.mean = {0.02F, 0, 0, 0, 0, -1, 0, 1, 0};
  normalisation.hand_m.deviation.fill(0.2F);
  normalisation.base_m.deviation.fill(0.2F);
  normalisation.angle_gain_rad.deviation.fill(0.1F);
  return InitialNetworks(normalisation, false, 3, family);
}

inline void WriteUntrained(const std::filesystem::path& folder, const std::string& stage,
                           bool colors = false) {
  PolicyProvenance provenance;
  provenance.stage = stage;
  provenance.dataset_sha256 = std::string(64, 'a');
  provenance.config.family = FamilyOf(stage);
  StageNormalisation normalisation = UntrainedNetworks(FamilyOf(stage)).normalisation;
  normalisation.view.colors = colors;
  WritePolicy(folder, InitialNetworks(normalisation, false, 3, FamilyOf(stage)), provenance);
}

/// The camera of an episode, which keeps every picture that it made.
class Photographer : public Observer {
 public:
  Photographer(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : camera_(scene, door, robot) {}
  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    CameraFrame frame = camera_.Render(snapshot);
    pictures.push_back(std::move(frame.depth));
    hands.push_back(snapshot.robot.world_from_hand);
    links.push_back(LinkPosesOf(snapshot));
    return frame.sampled.cloud;
  }

  std::vector<DepthImage> pictures;
  std::vector<std::vector<RigidTransform>> links;
  std::vector<RigidTransform> hands;

 private:
  CameraObserver camera_;
};

inline ProgramAnswer RunAct(const std::string& arguments, const std::string& errors = "2>&1") {
  return AnswerOf(DOORFORGE_BINARY_DIR "/bin/doorforge-act act " + arguments + " " + errors);
}

inline nlohmann::ordered_json CameraFile(const CameraModel& camera, double pixel_centre) {
  const Eigen::Matrix3d k = IntrinsicMatrix(camera);
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", k(0, 0)},
          {"fy", k(1, 1)},
          {"cx", k(0, 2) - 0.5 + pixel_centre},
          {"cy", k(1, 2) - 0.5 + pixel_centre},
          {"pixel_centre", pixel_centre},
          {"world_from_camera", TransformToJson(WorldFromCamera(camera))}};
}

inline nlohmann::ordered_json StateFile(const Decision& decision, const Scene& scene) {
  nlohmann::ordered_json state;
  for (std::size_t i = 0; i < 11; ++i) {
    state["joint_positions"].push_back(decision.state.at(i));
    state["joint_velocities"].push_back(decision.proprioception.at(11 + i));
  }
  state["world_from_base"] = TransformToJson(scene.world_from_robot_base);
  return state;
}

/// One simulated episode in which an untrained policy opens, and its files as a robot has them.
class RobotSightTest : public testing::Test {
 protected:
  using Json = nlohmann::ordered_json;

  static constexpr int kActions = 5;
  static constexpr int kCandidates = 4;

  static void SetUpTestSuite() {
    folder_ = std::filesystem::temp_directory_path() /
              ("robot_observation_test_" + std::to_string(::getpid()));
    WriteUntrained(folder_ / "opener", "open");
    WriteUntrained(folder_ / "handler", "handle");
    WriteUntrained(folder_ / "grasper", "grasp");
    const DoorAsset door = MakePrimitiveDoor({});
    SceneConfig config;
    config.physics.max_opening_actions = kActions;
    scene_ = SampleScene(door, 7, 0, config);
    Photographer photographer(scene_, door, robot_);
    PolicyOptions options;
    options.candidates = kCandidates;
    const auto policy = MakePolicy(UntrainedNetworks(), options);
    episode_ = RunEpisode(scene_, door, robot_, *policy, &photographer);
    pictures_ = std::move(photographer.pictures);
    hands_ = std::move(photographer.hands);
    links_ = std::move(photographer.links);
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      WriteDepthPng(Depth(i), pictures_[i]);
      WriteJsonFile(State(i), StateFile(episode_.decisions[i], scene_));
    }
    WriteJsonFile(folder_ / "camera.yaml", CameraFile(scene_.camera, 0));
    WriteJsonFile(folder_ / "camera_corner.yaml", CameraFile(scene_.camera, 0.5));
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder_); }

  static std::filesystem::path Depth(std::size_t i) {
    return folder_ / ("d" + std::to_string(i) + ".png");
  }
  static std::filesystem::path State(std::size_t i) {
    return folder_ / ("s" + std::to_string(i) + ".yaml");
  }

  // the simulator's picture in whole millimetres, and what its camera makes of it
  static DepthImage Rounded(std::size_t i) {
    DepthImage rounded = pictures_[i];
    for (float& depth : rounded.depth_m)
      if (std::isfinite(depth)) depth = static_cast<float>(std::round(depth * 1000.0) * 0.001);
    return rounded;
  }
  static LabelledCloud Sampled(const DepthImage& depth, std::size_t i) {
    const RigidTransform tcp = hands_[i] * robot_.hand_from_tcp();
    return ObserveCloud(depth, scene_.camera, tcp.translation()).cloud;
  }

  // What a training on other episodes of the door would have written.
  static void WriteFamiliar(const std::filesystem::path& folder) {
    const DoorAsset door = MakePrimitiveDoor({});
    SceneConfig config;
    config.physics.max_opening_actions = kActions;
    const auto policy = MakePolicy(UntrainedNetworks());
    std::vector<Episode> episodes;
    std::vector<TrainingSample> samples;
    for (std::uint64_t e = 1; e <= 24; ++e) {
      const Scene scene = SampleScene(door, 7, e, config);
      Photographer photographer(scene, door, robot_);
      episodes.push_back(RunEpisode(scene, door, robot_, *policy, &photographer));
    }
    for (const Episode& episode : episodes) {
      for (const Decision& decision : episode.decisions) {
        TrainingSample& sample = samples.emplace_back();
        sample.cloud = decision.cloud.xyz;
        sample.proprioception = decision.proprioception;
      }
    }
    const std::span<const TrainingSample> all(samples);
    const std::size_t fitted = all.size() * 2 / 3;
    WriteFamiliarity(folder,
                     FitFamiliarity(all.first(fitted), all.subspan(fitted), NetworkFamily::kMotion),
                     std::string(64, 'a'));
  }

  // The first picture with other depths, as a file.
  template <class Depth>
  static std::filesystem::path WriteOther(const std::string& name, const Depth& depth_at) {
    DepthImage other = pictures_[0];
    for (std::size_t i = 0; i < other.depth_m.size(); ++i)
      other.depth_m[i] = static_cast<float>(depth_at(i));
    WriteDepthPng(folder_ / name, other);
    return folder_ / name;
  }

  static ProgramAnswer Open(const std::filesystem::path& policy, const std::filesystem::path& depth,
                            const std::string& more = "", const std::string& errors = "2>&1") {
    return RunAct("--camera " + (folder_ / "camera.yaml").string() + " --opener " +
                      policy.string() + " --stage open --depth " + depth.string() + " --state " +
                      State(0).string() + " " + more,
                  errors);
  }

  static std::string With(const std::string& camera, const std::string& more) {
    // what untrained networks expect is arbitrary
    return "--least-gain off --camera " + (folder_ / camera).string() + " --opener " +
           (folder_ / "opener").string() + " " + more;
  }

  static std::string Line(const std::filesystem::path& depth, const std::filesystem::path& state) {
    return Json{{"depth", depth.string()}, {"state", state.string()}}.dump() + "\n";
  }

  // one process, one answer a line
  static std::vector<Json> Stream(const std::string& arguments, const std::string& lines,
                                  int code = 0) {
    CommitFile(folder_ / "lines", lines);
    const ProgramAnswer answer =
        RunAct(arguments + " --stream < " + (folder_ / "lines").string(), "2>/dev/null");
    EXPECT_EQ(answer.code, code) << answer.text;
    std::istringstream rows(answer.text);
    std::vector<Json> answers;
    for (std::string row; std::getline(rows, row);) answers.push_back(Json::parse(row));
    return answers;
  }

  // The picture without its last column, which no camera of the same shape makes.
  static std::filesystem::path WriteCutPicture(const std::filesystem::path& path) {
    const DepthImage whole = DecodeDepthPng(ReadFile(path), 0.001, "whole");
    DepthImage cut = whole;
    cut.width -= 1;
    cut.depth_m.resize(static_cast<std::size_t>(cut.width) * static_cast<std::size_t>(cut.height));
    WriteDepthPng(folder_ / "cut.png", cut);
    return folder_ / "cut.png";
  }

  static std::filesystem::path WriteState(const std::string& name, const Json& change) {
    Json state = ReadJsonFile(State(0));
    for (const auto& [key, value] : change.items()) {
      if (value.is_null())
        state.erase(key);
      else
        state[key] = value;
    }
    WriteJsonFile(folder_ / name, state);
    return folder_ / name;
  }

  // How many pixels of about this colour a picture's first columns have, and where their middle is.
  struct ColoredPixels {
    double count = 0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  };
  static ColoredPixels PixelsOf(const std::filesystem::path& picture, const std::string& color) {
    const ProgramAnswer answer =
        AnswerOf(PYTHON " " DOORFORGE_SOURCE_DIR "/tests/deploy/colored_pixels.py " +
                 picture.string() + " " + color + " 650");
    std::istringstream numbers(answer.text);
    ColoredPixels pixels;
    numbers >> pixels.count >> pixels.middle.x() >> pixels.middle.y();
    return pixels;
  }

  inline static std::filesystem::path folder_;
  inline static Scene scene_;
  inline static Episode episode_;
  inline static std::vector<DepthImage> pictures_;
  inline static std::vector<RigidTransform> hands_;
  inline static std::vector<std::vector<RigidTransform>> links_;
  inline static const RobotModel robot_ = LoadMobileFranka();
};

}  // namespace doorforge
