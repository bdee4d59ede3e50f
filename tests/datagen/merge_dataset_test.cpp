// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/datagen/merge_dataset.h"

#include <algorithm>
#include <numeric>

#include "doorforge/core/error.h"
#include "doorforge/datagen/regenerate.h"
#include "doorforge/datagen/slurm_script.h"
#include "doorforge/datagen/task_number.h"

#include "synthetic.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using synthetic::HashesBelow;

class MergeDatasetTest : public synthetic::CollectionTest {
 protected:
  CollectSummary RunTask(const fs::path& folder, CollectionTask task, int threads) {
    CollectRequest request = RequestFor(folder, threads);
    request.task = task;
    return Collect(
        plan_, [this](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); },
        request);
  }

  // 0 .. count - 1, neither ascending nor descending.
  static std::vector<int> Scrambled(int count) {
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    Rng rng(static_cast<std::uint64_t>(count), "scrambled");
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[rng.Index(static_cast<std::uint32_t>(i))]);
    return order;
  }

  template <class Work>
  static std::string Complaint(const Work& work, ErrorCode code) {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
  }
};

TEST_F(MergeDatasetTest, GivesTheSameBytesForAnyCutAnyOrderAndAnyThreads) {
  CollectInto(folder_ / "whole", 1);
  const auto whole = HashesBelow(folder_ / "whole");
  for (const int threads : {1, 2, 4}) {
    for (const int count : {1, 2, 3, 7}) {
      const std::string name = std::to_string(count) + "x" + std::to_string(threads);
      const fs::path shared = folder_ / ("shared" + name);
      std::vector<fs::path> parts;
      for (const int task : Scrambled(count)) {
        RunTask(shared, {task, count}, threads);
        parts.push_back(folder_ / ("part" + name) / std::to_string(task));
        RunTask(parts.back(), {task, count}, threads);
      }
      if (count > 1) {
        EXPECT_FALSE(fs::exists(shared / "dataset.json"));
      }
      MergeDataset({shared, {}});
      EXPECT_EQ(HashesBelow(shared), whole) << name;
      const MergeSummary merged = MergeDataset({folder_ / ("merged" + name), parts});
      EXPECT_EQ(merged.linked, plan_.shards.size());
      EXPECT_EQ(HashesBelow(folder_ / ("merged" + name)), whole) << name;
    }
  }
}

TEST_F(MergeDatasetTest, NamesEveryShardThatIsMissing) {
  RunTask(folder_, {0, 3}, 1);
  RunTask(folder_, {2, 3}, 1);
  const std::string message = Complaint(
      [&] {
        MergeDataset({folder_, {}});
      },
      ErrorCode::kIncomplete);
  EXPECT_NE(message.find("open/train/shard-000001 (number 1 of the plan): missing"),
            std::string::npos)
      << message;
  EXPECT_FALSE(fs::exists(folder_ / "dataset.json"));
  RunTask(folder_, {1, 3}, 1);
  MergeDataset({folder_, {}});
  EXPECT_TRUE(fs::exists(folder_ / "dataset.json"));
}

TEST_F(MergeDatasetTest, RefusesTasksOfOtherSettingsOrBuilds) {
  RunTask(folder_ / "a", {0, 2}, 1);
  CollectRequest request = RequestFor(folder_ / "b", 1);
  request.task = {1, 2};
  request.provenance.code_version = "0.1.0+other";
  const auto run = [this](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); };
  Collect(plan_, run, request);
  const auto merge = [&] { MergeDataset({folder_ / "all", {folder_ / "a", folder_ / "b"}}); };
  EXPECT_NE(Complaint(merge, ErrorCode::kInvalidArgument).find("provenance.json differs"),
            std::string::npos);
  fs::remove_all(folder_ / "b");
  request = RequestFor(folder_ / "b", 1);
  request.config_text = "{\"seed\": 12}\n";
  Collect(plan_, run, request);
  EXPECT_NE(Complaint(merge, ErrorCode::kInvalidArgument).find("config.yaml differs"),
            std::string::npos);
}

TEST_F(MergeDatasetTest, RefusesOneShardWithTwoContents) {
  RunTask(folder_ / "a", {0, 2}, 1);
  RunTask(folder_ / "b", {0, 2}, 1);
  RunTask(folder_ / "b", {1, 2}, 1);
  const fs::path index = folder_ / "b/open/train/shard-000000.index.json";
  ShardIndex changed = ReadShardIndex(index);
  changed.failures.clear();
  changed.failures.push_back({"ep000099", "door0", "grip_lost", "changed", 0, 0});
  std::ofstream(index) << ShardIndexText(changed);
  EXPECT_NE(Complaint(
                [&] {
                  MergeDataset({folder_ / "all", {folder_ / "a", folder_ / "b"}});
                },
                ErrorCode::kInvalidArgument)
                .find("the same shard with different content"),
            std::string::npos);
}

TEST_F(MergeDatasetTest, MakesEpisodesAgainAndFindsWhatDiffers) {
  CollectInto(folder_);
  const auto run = [this](const PlannedEpisode& p) { return synthetic::RunSynthetic(p, doors_); };
  const RegenerateResult all = RegenerateEpisodes(plan_, run, {folder_, "open", 1.0, 2});
  EXPECT_EQ(all.episodes, 40U);
  EXPECT_TRUE(all.findings.empty());
  EXPECT_EQ(RegenerateEpisodes(plan_, run, {folder_, "open", 0.01, 1}).episodes, 1U);
  // one that differs in a number, one that fails where it succeeded, one the other way about
  const RegenerateResult changed =
      RegenerateEpisodes(plan_,
                         [&](const PlannedEpisode& planned) {
                           CollectedEpisode episode = synthetic::RunSynthetic(planned, doors_);
                           if (planned.number == 5) episode.episode.decisions[1].action[0] += 1e-6F;
                           if (planned.number == 6)
                             episode.episode.outcome = EpisodeOutcome::kGripLost;
                           if (planned.number == 10)
                             episode.episode.outcome = EpisodeOutcome::kOpened;
                           return episode;
                         },
                         {folder_, "open", 1.0, 2});
  ASSERT_EQ(changed.findings.size(), 3U);
  std::string places;
  for (const DatasetFinding& finding : changed.findings) {
    EXPECT_EQ(finding.code, "DST011");
    places += finding.where + "\n";
  }
  EXPECT_NE(places.find("ep000005.action.npy"), std::string::npos) << places;
  EXPECT_NE(places.find("ep000006"), std::string::npos) << places;
  EXPECT_NE(places.find("ep000010"), std::string::npos) << places;
}

TEST(ParseFraction, TakesPercentAndShares) {
  EXPECT_DOUBLE_EQ(ParseFraction("1%"), 0.01);
  EXPECT_DOUBLE_EQ(ParseFraction("0.25"), 0.25);
  for (const char* text : {"", "%", "0", "2", "101%", "-1%", "x", "1 %", "nan"})
    EXPECT_THROW(ParseFraction(text), Error) << text;
}

TEST(ParseTask, RefusesWhatIsEmptyOrAbsurd) {
  EXPECT_EQ(ParseTask("0/1").count, 1);
  EXPECT_EQ(ParseTask("3/16").number, 3);
  for (const char* text : {"", "/", "/16", "3/", "3", "16/16", "-1/16", "1/0", "0/1000001", " 1/2",
                           "1/2 ", "1.0/2", "0x1/2", "99999999999/2", "$i/4"})
    EXPECT_THROW(ParseTask(text), Error) << text;
}

class TaskFromEnvironmentTest : public ::testing::Test {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override {
    ::unsetenv("SLURM_ARRAY_TASK_ID");
    ::unsetenv("JOB_COMPLETION_INDEX");
  }
};

TEST_F(TaskFromEnvironmentTest, TakesSlurmsAndKubernetesNumbers) {
  ::setenv("SLURM_ARRAY_TASK_ID", "3", 1);
  EXPECT_EQ(TaskFromEnvironment(8, 0).number, 3);
  EXPECT_EQ(TaskFromEnvironment(1010, 1001).number, 1004);
  ::setenv("JOB_COMPLETION_INDEX", "4", 1);
  EXPECT_THROW(TaskFromEnvironment(8, 0), Error);  // both, and not the same
  ::unsetenv("SLURM_ARRAY_TASK_ID");
  EXPECT_EQ(TaskFromEnvironment(8, 0).number, 4);
}

TEST_F(TaskFromEnvironmentTest, RefusesNumbersThatAreEmptyOrOutOfRange) {
  EXPECT_THROW(TaskFromEnvironment(8, 0), Error);
  for (const char* text : {"", " ", "8", "-1", "4294967294", "18446744073709551614", "1,2", "%a"}) {
    ::setenv("SLURM_ARRAY_TASK_ID", text, 1);
    EXPECT_THROW(TaskFromEnvironment(8, 0), Error) << text;
  }
}

TEST(CutIntoArrays, HoldsEachTaskOnce) {
  for (const int tasks : {1, 1000, 1001, 1002, 2002, 5000}) {
    int next = 0;
    for (const SlurmArray& array : CutIntoArrays(tasks, 1001)) {
      EXPECT_EQ(array.first, next);
      EXPECT_GE(array.count, 1);
      EXPECT_LE(array.count, 1001);
      next += array.count;
    }
    EXPECT_EQ(next, tasks);
  }
}

TEST(SlurmScriptText, QuotesWhatItIsGiven) {
  SlurmScript script;
  script.program = "/opt/it's here/doorforge";
  script.work_folder = "/home/a b";
  script.dataset = "/data/$(touch x)";
  script.arguments = {"datagen", "open", "--doors", "my doors"};
  script.tasks = 2500;
  script.parallel = 50;
  const std::string text = SlurmScriptText(script);
  EXPECT_NE(text.find("program='/opt/it'\\''s here/doorforge'"), std::string::npos) << text;
  EXPECT_NE(text.find("'my doors'"), std::string::npos);
  EXPECT_NE(text.find("dataset='/data/$(touch x)'"), std::string::npos);
  EXPECT_NE(text.find("--array=0-1000%50"), std::string::npos);
  EXPECT_NE(text.find("--array=0-497%50"), std::string::npos);
  EXPECT_NE(text.find("task 2002"), std::string::npos);
  script.arguments.push_back("two\nlines");
  EXPECT_THROW(SlurmScriptText(script), Error);
}

}  // namespace
}  // namespace doorforge
