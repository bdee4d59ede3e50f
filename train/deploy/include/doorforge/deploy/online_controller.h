// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/deploy/act_answer.h"
#include "doorforge/deploy/robot_observation.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/gain_critic.h"
#include "doorforge/policy/grasp_policy.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// Settings of an OnlineController, as `doorforge act --set` has them.
struct OnlineControllerConfig {
  PolicyOptions policy;
  GraspOptions grasp;
  CloudConfig cloud;  ///< It must be that of the data set that the policies were trained from.
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

/// Throws Error(kInvalidConfig) on a setting that is out of range.
void CheckOnlineControllerConfig(const OnlineControllerConfig& config);

/// Who decides, and from what.
struct OnlineControllerSetup {
  CalibratedCamera camera;
  /// Folders that `doorforge train open`, `handle` and `grasp` wrote; empty: nobody. At least one.
  std::string opener;
  std::string handler;
  std::string grasper = {};
  /// Which of opener and handler acts; nothing: the handler until the handle is turned.
  std::optional<Stage> stage = std::nullopt;
  RobotBase base = RobotBase::kSliders;  ///< kSliders or kFixed.
  /// Whether every decision of an episode is asked for, in order. Then a handler that can tell when
  /// the handle is turned is believed, and no state needs to say it.
  bool sees_every_decision = false;
  OnlineControllerConfig config = {};
};

/// What an answer was made from, for a picture of it.
struct SeenPicture {
  DepthImage depth;
  std::optional<PixelMask> handle;
};

/// What messages call the inputs of a decision, such as the files that they were read from.
struct InputNames {
  std::string depth = "the depth picture";
  std::string state = "the robot's state";
  std::string handle = "the mask of the handle";
  std::string camera = "the camera";
};

/// Trained policies on a robot: from a depth picture and the robot's state to the hand's next pose,
/// picture by picture, as one episode. What has been unlocked stays unlocked.
///
/// One instance serves one robot and one thread; the pictures are metres along the camera's z;
/// where nothing was measured they are 0, NaN or infinite (MakeDepthImage()). The world is the one
/// of CalibratedCamera and RobotState; its z points up.
class OnlineController {
 public:
  /// @throws Error(kMissing or kFormat) as ReadPolicy(); Error(kInvalidConfig) as
  ///     CheckOnlineControllerConfig(), or for a base that there is not.
  explicit OnlineController(const OnlineControllerSetup& setup);

  /// Keeps what is seen before the robot comes, for a handler that remembers it. The picture of
  /// DecideGrasp() is kept by itself.
  ///
  /// @throws Error(kInvalidArgument) as ObserveBefore().
  void Remember(const DepthImage& before, const InputNames& names = {});

  /// The hand's next pose.
  ///
  /// @throws Error(kInvalidArgument) as ObserveDepth(), or if nobody acts at the stage that the
  ///     state is in, or who acts remembers and nothing was kept; Error(kInvalidConfig) if neither
  ///     the state nor a policy says whether the handle is turned.
  ActAnswer Decide(DepthImage depth, const RobotState& state, const InputNames& names = {});

  /// Where and how to take hold of the handle, before the robot moves: of the one that the mask
  /// shows, or, without a mask, of the one that GraspOptions::finder finds.
  ///
  /// @throws Error(kInvalidArgument) as ObserveHandle(), without a grasper, without a mask where
  ///     there is no finder or it finds none, and with a mask where there is a finder.
  ActAnswer DecideGrasp(DepthImage depth, std::optional<PixelMask> handle,
                        const InputNames& names = {});
  /// Whether handles are found and not told.
  bool FindsHandle() const { return !setup_.config.grasp.finder.empty(); }

  const CalibratedCamera& camera() const { return setup_.camera; }
  const RobotModel& robot() const { return robot_; }
  const SeenPicture& last_seen() const { return seen_; }
  /// What the policies cannot do, a sentence each, for whoever runs the robot.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// A policy of one stage, ready to act, and what is known of it.
  struct Actor {
    std::unique_ptr<Policy> policy;
    std::string weights_sha256;
    GainCritic critic;
    std::optional<Familiarity> familiarity;
    MirroringPolicy* mirroring = nullptr;  // the same, or what turning plays
    TurningPolicy* turning = nullptr;      // the same, where it says when the handle is turned
    bool remembers = false;                // RememberedPoints, of so much:
    double crop_radius_m = 0;
  };
  struct Grasper {
    std::unique_ptr<GraspPolicy> policy;
    std::string weights_sha256;
    std::optional<Familiarity> familiarity;
  };

  HandleObservation ViewForGrasp(const InputNames& names) const;
  void KeepBefore(LabelledCloud before);
  std::optional<Actor> LoadActor(const std::string& folder, Stage stage);
  std::optional<Actor> LoadHandler(const std::string& folder);
  std::optional<Grasper> LoadGrasper(const std::string& folder);
  std::optional<Familiarity> LoadFamiliarity(const std::string& folder, const PolicyRecord& record);

  Stage StageOf(const RobotState& state, const std::string& name);
  bool Predicts() const;
  Actor& ActorOf(Stage stage);
  RobotObservation ObservationOf(const Actor& actor, const RobotState& state) const;
  ActAnswer Answer(Stage stage, Actor& actor, const RobotState& state,
                   const RobotObservation& seen);
  ActAnswer Answer(const GraspAction& choice, const HandleObservation& seen) const;
  std::optional<Foreignness> ForeignnessOf(const std::optional<Familiarity>& familiarity,
                                           const SightNumbers& numbers) const;

  OnlineControllerSetup setup_;
  std::vector<std::string> notes_;
  RobotModel robot_;
  std::optional<Actor> opener_;
  std::optional<Actor> handler_;
  std::optional<Grasper> grasper_;
  SeenPicture seen_;
  std::optional<LabelledCloud> before_;
  std::shared_ptr<DoorBelief> belief_;
  bool unlocked_ = false;
};

/// The files of one decision, as docs/act.md describes them; empty: none.
struct DecisionFiles {
  std::string depth{};         ///< A picture, see ReadDepthPicture().
  std::string state{};         ///< Either the robot's state, YAML,
  std::string handle{};        ///< or the mask of a handle that is to be taken hold of, PNG;
                               ///< neither: the handle is to be found, see FindsHandle().
  std::string before{};        ///< A depth picture from before the robot came, which is kept.
  std::string camera{};        ///< What messages call the camera.
  std::string color{};         ///< Colours of `depth`, PNG or JPEG, see AddColors().
  std::string before_color{};  ///< Colours of `before`.
};

/// Remembers what is to be remembered; nothing where `before` is empty.
///
/// @throws as OnlineController::Remember() and ReadDepthPicture(), naming the file.
void RememberFromFile(OnlineController& controller, const DecisionFiles& files);

/// A decision from files, after RememberFromFile().
///
/// @throws as the controller, ReadDepthPicture(), ReadRobotState(), and Error(kMissing or kFormat)
///     naming the file.
ActAnswer DecideFromFiles(OnlineController& controller, const DecisionFiles& files);

}  // namespace doorforge
