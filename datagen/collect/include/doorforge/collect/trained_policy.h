// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// A trained policy that acts at a stage instead of the rule, by what its folder says.
struct TrainedPolicy {
  Stage stage = Stage::kOpen;
  std::filesystem::path folder;
  DatasetPolicy identity;
  std::string role;      ///< handler, opener or learner, as its option is called.
  int cloud_points = 0;  ///< Of the clouds that it takes; 0: its record does not say.
  RememberedViewConfig remembered{.finer = 0};  ///< Of the stage "handle": what it remembers.
};

/// Folders of trained policies that act in the rules' place; empty: the rule.
struct PolicyFolders {
  std::string handler;
  std::string opener;
  std::string learner;  ///< Of the stage that is recorded: drives or, at "grasp", takes hold.

  bool Any() const { return !handler.empty() || !opener.empty() || !learner.empty(); }
};

/// Reads the record and checks the weights against it, so that a policy that does not fit is
/// refused before any work.
///
/// @throws Error(kMissing) if there is no policy, Error(kFormat) if it is of another schema or its
///     weights are others than the record's, Error(kInvalidArgument) if it is of another stage.
TrainedPolicy ReadTrainedPolicy(const std::filesystem::path& folder, Stage stage,
                                const std::string& role);

/// A line for config.yaml, so that a policy that has changed is noticed when a run goes on.
std::string TrainedPolicyText(const TrainedPolicy& policy);

/// Lends instances of a trained policy, as many as are in use at once, each to one episode at a
/// time. Safe to use from several threads.
template <class Actor>
class ActorPool {
 public:
  using Load = std::unique_ptr<Actor> (*)(const TrainedPolicy&);

  ActorPool(TrainedPolicy policy, Load load) : policy_(std::move(policy)), load_(load) {}

  const TrainedPolicy& policy() const { return policy_; }

  struct GiveBack {
    ActorPool* pool = nullptr;
    void operator()(Actor* actor) const { pool->Return(std::unique_ptr<Actor>(actor)); }
  };
  /// An instance that goes back to the pool by itself; the pool must outlive it.
  using Loan = std::unique_ptr<Actor, GiveBack>;

  Loan Take() {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Actor> actor = std::move(idle_.back());
        idle_.pop_back();
        return {actor.release(), {this}};
      }
    }
    return {load_(policy_).release(), {this}};
  }

 private:
  void Return(std::unique_ptr<Actor> actor) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(actor));
  }

  TrainedPolicy policy_;
  Load load_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Actor>> idle_;
};

/// What a trained grasp is chosen from.
struct ClosedDoor {
  LabelledCloud visible;                                 ///< Every point in view.
  Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();  ///< World: straight into the leaf.
  const GripperClearance& clearance;
};

/// A trained policy of the stage "grasp". Keeps nothing between calls; one instance serves one
/// thread at a time.
class LearnedGrasp {
 public:
  virtual ~LearnedGrasp() = default;
  /// @param extent Of the chosen grasp's cloud; the policy looks at clouds of its own extent.
  virtual std::optional<ChosenGrasp> Choose(const ClosedDoor& door, const CloudExtent& extent) = 0;
};

using PolicyPool = ActorPool<Policy>;
using GraspPool = ActorPool<LearnedGrasp>;

/// A new instance that uses one thread. Throws as the loader of policies.
std::unique_ptr<Policy> LoadTrainedPolicy(const TrainedPolicy& policy);
/// The same at the stage "grasp", with GraspOptions' defaults.
std::unique_ptr<LearnedGrasp> LoadLearnedGrasp(const TrainedPolicy& policy);

/// What the policies' bytes depend on beside their folders: the instruction set of the networks'
/// loops.
std::string PolicyArithmetic();

}  // namespace doorforge
