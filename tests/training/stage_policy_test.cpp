// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/stage_policy.h"

#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turning_policy.h"
#include "doorforge/schemas/safetensors.h"

#include "door_cloud.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

StageNetworks SomeNetworks() {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  return InitialNetworks(MeasureNormalisation(made.samples), false, 4);
}

Observation SomeObservation() {
  Observation observation;
  observation.cloud.xyz = testing::DoorCloud(8, 0.4);
  for (std::size_t i = 0; i < observation.proprioception.size(); ++i)
    observation.proprioception[i] = 0.05F * static_cast<float>(i);
  return observation;
}

TEST(StagePolicy, ActsAlikeInMemoryAndFromItsFolder) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "doorforge_stage_policy";
  std::filesystem::remove_all(folder);
  WritePolicy(folder, SomeNetworks(), {"open", "abc", "v", {}, 1});
  const Observation observation = SomeObservation();
  const Action memory = MakePolicy(ReadPolicy(folder).networks)->Act(observation);
  const Action loaded = LoadPolicy(folder)->Act(observation);
  EXPECT_EQ(memory.position_delta_m, loaded.position_delta_m);
  EXPECT_EQ(memory.world_from_hand_rotation, loaded.world_from_hand_rotation);
  EXPECT_NEAR((memory.world_from_hand_rotation * memory.world_from_hand_rotation.transpose() -
               Eigen::Matrix3d::Identity())
                  .norm(),
              0, 1e-6);
}

// This is the scene elsewhere: joints as before, cloud and hand moved.
Observation Moved(Observation observation, const Eigen::Vector3f& by) {
  for (std::size_t i = 0; i < observation.cloud.xyz.size(); ++i)
    observation.cloud.xyz[i] += by[static_cast<Eigen::Index>(i % 3)];
  for (std::size_t k = 0; k < 3; ++k)
    observation.proprioception[25 + k] += by[static_cast<Eigen::Index>(k)];
  return observation;
}

Observation WithHand(Observation observation, const Eigen::Quaternionf& hand) {
  const std::array<float, 4> xyzw = {hand.x(), hand.y(), hand.z(), hand.w()};
  std::copy(xyzw.begin(), xyzw.end(), observation.proprioception.end() - 4);
  return observation;
}

TEST(StagePolicy, InTheHandsFrameItMovesAlikeWhereverTheDoorIs) {
  StageNetworks networks = SomeNetworks();
  const Observation here = WithHand(SomeObservation(), Eigen::Quaternionf::Identity());
  const Observation there = Moved(here, {0.25F, -0.5F, 0.125F});
  const auto difference = [&] {
    return (MakePolicy(networks)->Act(here).position_delta_m -
            MakePolicy(networks)->Act(there).position_delta_m)
        .norm();
  };
  EXPECT_GT(difference(), 1e-4);  // the world's frame
  networks.normalisation.view.frame = ViewFrame::kHand;
  networks.normalisation.cloud_centre_m = {};
  EXPECT_LT(difference(), 1e-5);
}

TEST(StagePolicy, InTheHandsFrameItTurnsTheHandFromWhereItIs) {
  StageNetworks networks = SomeNetworks();
  networks.normalisation.view.frame = ViewFrame::kHand;
  const Eigen::Quaternionf hand(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized()));
  const Action plain =
      MakePolicy(networks)->Act(WithHand(SomeObservation(), Eigen::Quaternionf::Identity()));
  const Action turned = MakePolicy(networks)->Act(WithHand(SomeObservation(), hand));
  EXPECT_EQ(turned.position_delta_m, plain.position_delta_m);
  EXPECT_LT((turned.world_from_hand_rotation -
             plain.world_from_hand_rotation * hand.toRotationMatrix().cast<double>())
                .norm(),
            1e-5);
}

TEST(StagePolicy, TheStateIsOfTheHandOrOfTheJointsOrNone) {
  const Observation observation = WithHand(SomeObservation(), Eigen::Quaternionf::Identity());
  Observation other_arm = observation;
  for (const std::size_t first : {0U, 11U}) {
    for (std::size_t i = first; i < first + 9; ++i) other_arm.proprioception[i] += 0.3F;
  }
  Observation other_fingers = observation;
  other_fingers.proprioception[10] += 0.02F;
  const Observation other_turn =
      WithHand(observation, Eigen::Quaternionf(Eigen::AngleAxisf(0.5F, Eigen::Vector3f::UnitX())));
  const auto matters = [&](StateKind kind, const Observation& other) {
    StageNetworks networks = SomeNetworks();
    networks.normalisation.view.state = kind;
    const auto policy = MakePolicy(std::move(networks));
    return policy->Act(other).position_delta_m != policy->Act(observation).position_delta_m;
  };
  EXPECT_TRUE(matters(StateKind::kJoints, other_arm));
  EXPECT_FALSE(matters(StateKind::kJoints, other_fingers));
  EXPECT_FALSE(matters(StateKind::kJoints, other_turn));
  EXPECT_FALSE(matters(StateKind::kHand, other_arm));
  EXPECT_TRUE(matters(StateKind::kHand, other_fingers));
  EXPECT_TRUE(matters(StateKind::kHand, other_turn));
  for (const Observation& other : {other_arm, other_fingers, other_turn})
    EXPECT_FALSE(matters(StateKind::kNone, other));
  EXPECT_FALSE(matters(StateKind::kGripper, other_arm));
  EXPECT_TRUE(matters(StateKind::kGripper, other_fingers));
  EXPECT_TRUE(matters(StateKind::kGripper, other_turn));
}

TEST(StagePolicy, HalfATurnOfAGripperIsNoOtherState) {
  const Eigen::Quaternionf hand(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized()));
  const Eigen::Quaternionf half(
      Eigen::AngleAxisf(std::numbers::pi_v<float>, Eigen::Vector3f::UnitZ()));
  Proprioception here = WithHand(SomeObservation(), hand).proprioception;
  Proprioception turned = WithHand(SomeObservation(), hand * half).proprioception;
  std::swap(turned[9], turned[10]);  // each finger is where the other was
  const auto difference = [&](StateKind kind) {
    const PolicyState a = StateOf(kind, here);
    const PolicyState b = StateOf(kind, turned);
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  EXPECT_LT(difference(StateKind::kGripper), 1e-5F);
  EXPECT_GT(difference(StateKind::kHand), 0.1F);
}

TEST(StagePolicy, RepeatsAnEpisodeAfterReset) {
  PolicyOptions options;
  options.candidates = 4;
  const auto policy = MakePolicy(SomeNetworks(), options);
  const Observation observation = SomeObservation();
  policy->Reset();
  const Action first = policy->Act(observation);
  const Action second = policy->Act(observation);
  policy->Reset();
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  EXPECT_EQ(policy->Act(observation).position_delta_m, second.position_delta_m);
}

TEST(StagePolicy, WithOneCandidateNeitherSeedNorRepetitionMatters) {
  PolicyOptions options;
  options.seed = 99;
  const Observation observation = SomeObservation();
  const auto policy = MakePolicy(SomeNetworks(), options);
  const Action first = policy->Act(observation);
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  EXPECT_EQ(MakePolicy(SomeNetworks())->Act(observation).position_delta_m, first.position_delta_m);
}

TEST(StagePolicy, RefusesObservationsItCannotRead) {
  const auto policy = MakePolicy(SomeNetworks());
  Observation observation = SomeObservation();
  observation.cloud.xyz.resize(300);
  EXPECT_THROW(policy->Act(observation), Error);
  observation = SomeObservation();
  observation.cloud.xyz[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(policy->Act(observation), Error);
  observation = SomeObservation();
  observation.proprioception[3] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(policy->Act(observation), Error);
  PolicyOptions none;
  none.candidates = 0;
  EXPECT_THROW(MakePolicy(SomeNetworks(), none), Error);
}

// ---- when the handle is turned ------------------------------------------------------------------

constexpr double kDoneRad = 0.6;

// Turns about x, so far and after the action, and what a rule of them says; the rest is noise.
std::vector<TurnedExample> RuleExamples(std::uint64_t seed, int count) {
  Rng rng(seed, "test/turned");
  std::vector<TurnedExample> examples;
  for (int i = 0; i < count; ++i) {
    TurnedExample example;
    for (float& number : example.motion) number = static_cast<float>(0.02 * rng.Normal());
    const double turn = rng.Uniform(0, 1);
    example.motion[0] = static_cast<float>(turn - 0.2);
    example.motion[3] = static_cast<float>(turn);
    example.turned = turn >= kDoneRad;
    examples.push_back(example);
  }
  return examples;
}

TurnedClassifier RuleClassifier() { return *FitTurnedClassifier(RuleExamples(1, 600)); }

TEST(TurnedClassifier, LearnsARuleAndHoldsItBeyondWhatItSaw) {
  const TurnedClassifier classifier = RuleClassifier();
  const std::vector<TurnedExample> unseen = RuleExamples(2, 1000);
  const TurnedAccuracy accuracy = MeasureTurned(classifier, unseen);
  EXPECT_GT(accuracy.turned, 350);
  EXPECT_GT(accuracy.correct, 0.96 * accuracy.turned);
  EXPECT_LT(accuracy.called - accuracy.correct, 0.04 * accuracy.called);
  HandMotion far{};
  far[0] = 1.2F;
  far[3] = 1.4F;
  EXPECT_GT(classifier.Probability(far), 0.99);
  EXPECT_LT(classifier.Probability(HandMotion{}), 0.01);
}

TEST(TurnedClassifier, AtItsMinimumTheMeanProbabilityIsTheShareThatIsTurned) {
  // the gradient to the bias, which no ridge holds, is zero there
  const std::vector<TurnedExample> examples = RuleExamples(3, 500);
  const TurnedClassifier classifier = *FitTurnedClassifier(examples);
  double excess = 0;
  for (const TurnedExample& example : examples)
    excess += classifier.Probability(example.motion) - (example.turned ? 1 : 0);
  EXPECT_NEAR(excess / 500, 0, 1e-6);
}

TEST(TurnedClassifier, NeedsExamplesOfBothKinds) {
  std::vector<TurnedExample> examples = RuleExamples(4, 50);
  for (TurnedExample& example : examples) example.turned = true;
  EXPECT_FALSE(FitTurnedClassifier(examples));
  EXPECT_FALSE(FitTurnedClassifier({}));
}

TEST(TurnedClassifier, ComesBackFromItsFolderAndRefusesWhatDoesNotBelongThere) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "doorforge_turned";
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(ReadTurnedClassifier(folder, "data"));
  const TurnedClassifier classifier = RuleClassifier();
  WriteTurnedClassifier(folder, classifier, "data");
  const auto read = ReadTurnedClassifier(folder, "data");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->weight, classifier.weight);
  EXPECT_EQ(read->mean, classifier.mean);
  EXPECT_EQ(read->deviation, classifier.deviation);
  EXPECT_EQ(read->bias, classifier.bias);
  EXPECT_EQ(RuleClassifier().weight, classifier.weight) << "fitted twice";
  EXPECT_THROW(ReadTurnedClassifier(folder, "other data"), Error);

  const auto path = folder / "turned.safetensors";
  const TensorFile good = ReadTensors(path);
  const auto refuses = [&](const TensorFile& file) {
    CommitFile(path, EncodeTensors(file));
    try {
      ReadTurnedClassifier(folder, "data");
    } catch (const Error& error) {
      return error.code() == ErrorCode::kFormat &&
             std::string(error.what()).find("turned.safetensors") != std::string::npos;
    }
    return false;
  };
  TensorFile wider = good;
  wider.tensors["weight"] = MakeTensor<float>(std::vector<float>(29), {29});
  EXPECT_TRUE(refuses(wider));
  TensorFile newer = good;
  newer.metadata["schema_version"] = "2";
  EXPECT_TRUE(refuses(newer));
  TensorFile flat = good;
  flat.tensors["deviation"] = MakeTensor<float>(std::vector<float>(28), {28});
  EXPECT_TRUE(refuses(flat));

  WriteTurnedClassifier(folder, std::nullopt, "data");
  EXPECT_FALSE(std::filesystem::exists(path));
}

// Turns the hand about x by a step further at every action.
class Turning : public Policy {
 public:
  Action Act(const Observation& observation) override {
    const auto* xyzw = &observation.proprioception[28];
    const Eigen::Quaternionf hand(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    return {{0.01, 0, 0},
            Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                hand.toRotationMatrix().cast<double>()};
  }
};

// The hand after it has turned about x, as a robot tells it.
Observation AfterTurn(double turn_rad) {
  const auto turn = static_cast<float>(turn_rad);
  Observation observation;
  observation.proprioception[25] = 0.05F * turn;
  return WithHand(observation, Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitX()) *
                                   Eigen::AngleAxisf(0.7F, Eigen::Vector3f::UnitY()));
}

TEST(TurnedClassifier, ReadsTheHandsTurnAndWaySinceTheStageBegan) {
  const Observation now = AfterTurn(0.4);
  const HandMotion motion =
      HandMotionOf(AfterTurn(0).proprioception, now.proprioception, ToVector(Turning().Act(now)));
  const HandMotion expected = {0.4F, 0, 0, 0.6F, 0, 0, 0.02F, 0, 0, 0.03F, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(motion[i], expected[i], 1e-5) << i;
}

TEST(TurningPolicy, SaysWhenTheHandleIsTurnedAndHoldsToItUntilReset) {
  TurningPolicy policy(std::make_unique<Turning>(), RuleClassifier());
  policy.Reset();
  EXPECT_FALSE(policy.Turned());
  policy.Act(AfterTurn(0));
  EXPECT_FALSE(policy.Turned());
  policy.Act(AfterTurn(0.6));
  EXPECT_TRUE(policy.Turned());
  policy.Act(AfterTurn(0));
  EXPECT_TRUE(policy.Turned());
  policy.Reset();
  EXPECT_FALSE(policy.Turned());
  policy.Act(AfterTurn(0.6));  // where the stage begins does not matter
  EXPECT_FALSE(policy.Turned());
}

TEST(TurningPolicy, IsSaidToHaveTurnedFromTheProbabilityOnThatIsAskedFor) {
  const TurnedClassifier classifier = RuleClassifier();
  const Observation first = AfterTurn(0);
  for (const double turn : {0.1, 0.3, 0.4, 0.45, 0.5, 0.6, 0.8}) {
    const Observation now = AfterTurn(static_cast<float>(turn));
    const double said = classifier.Probability(
        HandMotionOf(first.proprioception, now.proprioception, ToVector(Turning().Act(now))));
    for (const double asked : {0.1, 0.5, 0.9, 0.999}) {
      TurningPolicy policy(std::make_unique<Turning>(), classifier, asked);
      policy.Act(first);
      policy.Act(now);
      EXPECT_EQ(policy.Turned(), said >= asked) << turn << ", " << asked;
    }
  }
  EXPECT_THROW(TurningPolicy(std::make_unique<Turning>(), classifier, 0), Error);
  EXPECT_THROW(TurningPolicy(std::make_unique<Turning>(), classifier, 1), Error);
}

}  // namespace
}  // namespace doorforge
