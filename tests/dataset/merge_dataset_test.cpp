// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/merge_dataset.h"

#include <algorithm>
#include <numeric>

#include "doorforge/core/error.h"
#include "doorforge/dataset/regenerate.h"
#include "doorforge/dataset/slurm_script.h"
#include "doorforge/dataset/task_number.h"
#include "doorforge/dataset/task_summary.h"

#include "../program_answer.h"
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

TEST(TaskSummary, SaysWhatATaskDid) {
  CollectSummary summary;
  summary.planned = 9;
  summary.written = 7;
  summary.failures = {{"slipped", 2}};
  summary.shards = 3;
  summary.bytes = 5 << 20;
  EXPECT_EQ(TaskSummaryText(summary, {1, 4}, "data"),
            "task 1/4: 3 shards, 7 of 9 episodes succeeded, 5.0 MiB in data\n");
  const nlohmann::ordered_json json = TaskSummaryToJson(summary, {1, 4});
  EXPECT_EQ(json.at("task"), 1);
  EXPECT_EQ(json.at("tasks"), 4);
  EXPECT_EQ(json.at("episodes"), 7);
  EXPECT_EQ(json.at("failures").at("slipped"), 2);
  EXPECT_EQ(json.at("bytes"), 5242880);
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

// bash runs the script with an sbatch and a scancel that write down how they were called;
// tests/cluster has it run by Slurm.
class SubmittedScript : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("doorforge_submitted_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    AddProgram("sbatch", R"(echo "$*" >> "$0.calls"; number=$(wc -l < "$0.calls")
[ "$number" -lt "$REFUSED" ] || { echo "sbatch: error: limit of jobs" >&2; exit 7; }
echo "$((100 + number));cluster")");
    AddProgram("scancel", R"(echo "$*" >> "$0.calls")");
    SlurmScript script;
    script.program = "/opt/doorforge";
    script.work_folder = "/";
    script.dataset = (folder_ / "100%j").string();
    script.tasks = 2500;
    std::ofstream(folder_ / "collect.sh") << SlurmScriptText(script);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void AddProgram(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << "#!/bin/bash\n" << text << "\n";
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }

  // Slurm refuses the call of this number.
  ProgramAnswer Submit(int refused) const {
    return AnswerOf("PATH='" + folder_.string() + "':$PATH REFUSED=" + std::to_string(refused) +
                    " bash '" + (folder_ / "collect.sh").string() + "' 2>&1");
  }

  std::vector<std::string> CallsOf(const std::string& program) const {
    std::vector<std::string> calls;
    std::ifstream file(folder_ / (program + ".calls"));
    for (std::string line; std::getline(file, line);) calls.push_back(line);
    return calls;
  }

  fs::path folder_;
};

TEST_F(SubmittedScript, CutsTheTasksIntoArraysAndMergesAfterAllOfThem) {
  const ProgramAnswer answer = Submit(99);
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(answer.text, "tasks 101 102 103 merge 104 verify 105\n");
  const std::vector<std::string> calls = CallsOf("sbatch");
  ASSERT_EQ(calls.size(), 5U);
  const auto expect = [&](std::size_t call, const std::string& what) {
    EXPECT_NE(calls[call].find(what), std::string::npos) << calls[call] << "\n" << what;
  };
  expect(0, "--array=0-1000 ");
  expect(0, "collect.sh task 0");
  expect(1, "--array=0-1000 ");
  expect(1, "collect.sh task 1001");
  expect(2, "--array=0-497 ");
  expect(2, "collect.sh task 2002");
  expect(3, "--dependency=afterok:101:102:103 ");
  expect(4, "--dependency=afterok:104 ");
  expect(4, "100%%j.slurm/verify-%j.log");  // of a name with a % that Slurm is not to fill in
  EXPECT_TRUE(fs::is_directory(folder_ / "100%j.slurm"));
  EXPECT_TRUE(CallsOf("scancel").empty());
}

TEST_F(SubmittedScript, CancelsWhatSlurmTookWhereItRefusesTheRest) {
  for (const auto& [refused, cancelled] : std::vector<std::pair<int, std::string>>{
           {3, "101 102"}, {4, "101 102 103"}, {5, "101 102 103 104"}}) {
    for (const char* program : {"sbatch.calls", "scancel.calls"}) fs::remove(folder_ / program);
    const ProgramAnswer answer = Submit(refused);
    EXPECT_EQ(answer.code, 7);
    EXPECT_NE(answer.text.find("cancelling " + cancelled), std::string::npos) << answer.text;
    EXPECT_EQ(CallsOf("sbatch").size(), static_cast<std::size_t>(refused));
    EXPECT_EQ(CallsOf("scancel"), std::vector<std::string>{cancelled});
  }
  fs::remove(folder_ / "sbatch.calls");
  fs::remove(folder_ / "scancel.calls");
  EXPECT_EQ(Submit(1).code, 7);
  EXPECT_TRUE(CallsOf("scancel").empty());
}

}  // namespace
}  // namespace doorforge
