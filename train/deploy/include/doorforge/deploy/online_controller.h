// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/evaluate/robot_sight.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/gain_critic.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/point_cloud.h"

#include "act_answer.h"

namespace doorforge {

/// What --set holds.
struct ActConfig {
  PolicyOptions policy;
  GraspOptions grasp;
  CloudConfig cloud;  ///< As in the data set that the policies were trained from.
  HoldConfig hold;
  /// About the world's z, from the world's x to the way straight out of the closed leaf.
  double door_yaw_rad = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("policy", self.policy);
    visit("grasp", self.grasp);
    visit("cloud", self.cloud);
    visit("hold", self.hold);
    visit("door_yaw_rad", self.door_yaw_rad);
  }
};

/// Throws Error(kInvalidConfig).
void CheckActConfig(const ActConfig& config);

/// Who decides, and from what.
struct DeciderSetup {
  std::string camera;
  std::string policy;
  std::string handler;
  std::string grasper;
  std::string stage = "auto";
  std::string base = "sliders";
  bool stream = false;
  ActConfig config;
};

/// What an answer was made from, for a picture of it.
struct SeenPicture {
  DepthImage depth;
  std::optional<PixelMask> handle;
};

/// Decides picture by picture, as one episode: what has been unlocked stays unlocked.
class Decider {
 public:
  explicit Decider(const DeciderSetup& setup);

  /// The hand's next pose.
  ActAnswer Decide(const std::filesystem::path& depth_path,
                   const std::filesystem::path& state_path);
  /// Where and how to take hold of the handle that a mask shows.
  ActAnswer DecideGrasp(const std::filesystem::path& depth_path,
                        const std::filesystem::path& handle_path);

  const CalibratedCamera& camera() const { return camera_; }
  const RobotModel& robot() const { return robot_; }
  const SeenPicture& last_seen() const { return seen_; }

 private:
  /// A policy of one stage, ready to act, and what is known of it.
  struct Actor {
    std::unique_ptr<Policy> policy;
    std::string weights_sha256;
    GainCritic critic;
    std::optional<Familiarity> familiarity;
    TurningPolicy* turning = nullptr;  // the same, where it says when the handle is turned
  };
  struct Grasper {
    std::unique_ptr<GraspPolicy> policy;
    std::string weights_sha256;
    std::optional<Familiarity> familiarity;
  };

  static std::optional<Actor> LoadActor(const std::string& folder, Stage stage,
                                        const PolicyOptions& options);
  static std::optional<Actor> LoadHandler(const std::string& folder, const PolicyOptions& options);
  static std::optional<Grasper> LoadGrasper(const std::string& folder, const GraspOptions& options);

  DepthImage ReadDepth(const std::filesystem::path& path) const;
  Stage StageOf(const RobotState& state, const std::string& path);
  bool Predicts() const;
  Actor& ActorOf(Stage stage);
  ActAnswer Answer(Stage stage, Actor& actor, const RobotState& state, const RobotSight& sight);
  ActAnswer Answer(const GraspChoice& choice, const HandleSight& sight) const;
  std::optional<Foreignness> ForeignnessOf(const std::optional<Familiarity>& familiarity,
                                           const SightNumbers& numbers) const;

  DeciderSetup setup_;
  RobotModel robot_;
  CalibratedCamera camera_;
  std::optional<Actor> opener_;
  std::optional<Actor> handler_;
  std::optional<Grasper> grasper_;
  SeenPicture seen_;
  bool unlocked_ = false;
};

}  // namespace doorforge
