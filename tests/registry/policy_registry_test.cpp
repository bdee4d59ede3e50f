// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_registry.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class Standing : public Policy {
 public:
  Action Act(const Observation&) override { return {}; }
};

MotionPolicyRow Row(Stage stage, const std::string& name) {
  return {stage, name, [](const PolicySettings&) { return std::make_unique<Standing>(); }};
}

std::string RefusalOf(ErrorCode code, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

TEST(PolicyRegistry, TheToolkitKnowsTheExpertAtEveryStageAndSampledGrasps) {
  const PolicyRegistry registry = BuiltInPolicies();
  EXPECT_TRUE(registry.Find(Stage::kGrasp, "random", "--grasper").grasp.has_value());
  for (const Stage stage : {Stage::kOpen, Stage::kHandle, Stage::kGrasp}) {
    const PolicyChoice expert = registry.Find(stage, "expert", "--opener");
    EXPECT_TRUE(expert.IsExpert());
    EXPECT_EQ(registry.Names(stage).front(), "expert");
    // whatever comes with the toolkit is none of a user's own
    for (const std::string& name : registry.Names(stage))
      EXPECT_FALSE(registry.Find(stage, name, "--opener").IsOwn()) << name;
  }
}

TEST(PolicyRegistry, ARowOfOnesOwnIsFoundAtItsStageAlone) {
  PolicyRegistry registry = BuiltInPolicies();
  registry.Add(Row(Stage::kOpen, "mine"));
  const PolicyChoice mine = registry.Find(Stage::kOpen, "mine", "--opener");
  EXPECT_TRUE(mine.IsOwn());
  EXPECT_FALSE(mine.IsExpert());
  EXPECT_EQ(mine.Name(), "mine");
  EXPECT_NE(mine.motion->make({}), nullptr);
  RefusalOf(ErrorCode::kInvalidArgument,
            [&] { registry.Find(Stage::kHandle, "mine", "--handler"); });
}

TEST(PolicyRegistry, NamesThatWouldBeTakenForSomethingElseAreRefused) {
  PolicyRegistry registry = BuiltInPolicies();
  for (const std::string name : {"", "run/opener", "two words", "expert"})
    RefusalOf(ErrorCode::kInvalidArgument, [&] { registry.Add(Row(Stage::kOpen, name)); });
  RefusalOf(ErrorCode::kInvalidArgument, [&] { registry.Add(Row(Stage::kGrasp, "mine")); });
  RefusalOf(ErrorCode::kInvalidArgument, [&] {
    registry.Add(MotionPolicyRow{Stage::kOpen, "mine", nullptr});
  });
}

TEST(PolicyRegistry, AnUnknownWordIsToldWithTheNearestAndAllThatThereAre) {
  const PolicyRegistry registry = BuiltInPolicies();
  const std::string misspelled = RefusalOf(
      ErrorCode::kInvalidArgument, [&] { registry.Find(Stage::kGrasp, "randon", "--grasper"); });
  for (const char* part :
       {"--grasper randon", "did you mean \"random\"", "expert, random", "`doorforge train grasp`"})
    EXPECT_NE(misspelled.find(part), std::string::npos) << misspelled;
  const std::string nowhere = RefusalOf(
      ErrorCode::kMissing, [&] { registry.Find(Stage::kOpen, "run/no_such", "--opener"); });
  EXPECT_NE(nowhere.find("run/no_such: no such folder"), std::string::npos) << nowhere;
}

TEST(PolicyRegistry, AFolderIsTakenUnlessANameGoesBefore) {
  const fs::path folder =
      fs::temp_directory_path() / ("policy_registry_test_" + std::to_string(::getpid()));
  fs::create_directories(folder / "expert");
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  const PolicyRegistry registry = BuiltInPolicies();
  EXPECT_FALSE(registry.Find(Stage::kOpen, "expert", "--opener").IsFolder());
  const PolicyChoice choice = registry.Find(Stage::kOpen, "./expert/", "--opener");
  EXPECT_TRUE(choice.IsFolder());
  EXPECT_FALSE(choice.IsExpert());
  EXPECT_EQ(choice.Name(), "expert");
  fs::current_path(before);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace doorforge
