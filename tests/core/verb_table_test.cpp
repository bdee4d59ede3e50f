// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/cli/verb_table.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr Verb kVerbs[] = {{"grow", [](int argc, char**) { return 10 + argc; }},
                           {"shrink", [](int, char** argv) { return argv[0][0] == 's' ? 7 : 8; }}};

int RunWords(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return RunVerbs(kVerbs, static_cast<int>(pointers.size()), pointers.data());
}

TEST(VerbTable, RunsTheVerbThatIsNamedWithItsNameAsFirstArgument) {
  EXPECT_EQ(RunWords({"program", "grow", "a", "b"}), 13);
  EXPECT_EQ(RunWords({"program", "shrink"}), 7);
}

TEST(VerbTable, AnUnknownVerbIsWrongUseAndToldTheNearest) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(RunWords({"program", "grwo"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "doorforge: unknown verb \"grwo\"; did you mean \"grow\"? `doorforge --help` lists "
            "all\n");
}

TEST(VerbTable, TheOnlyVerbOfAProgramMayBeLeftOut) {
  const auto run = [](std::vector<std::string> words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    return RunOneVerb(kVerbs[0], static_cast<int>(pointers.size()), pointers.data());
  };
  EXPECT_EQ(run({"program", "grow", "a"}), 12);
  EXPECT_EQ(run({"program", "a"}), 12);
}

TEST(Answer, CountsAsPeopleWriteIt) {
  EXPECT_EQ(Counted(1, "door"), "1 door");
  EXPECT_EQ(Counted(0, "door"), "0 doors");
  EXPECT_EQ(CountedFindings(1, 2), "1 error, 2 warnings");
}

TEST(Answer, ABatchFailsWhereAnyOfItFailed) {
  EXPECT_EQ(ExitCodeOfBatch(0), 0);
  EXPECT_EQ(ExitCodeOfBatch(3), 1);
}

TEST(Answer, OfABatchTellsItsProblemsApart) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(AnswerOfBatch({"a: broken"}, false, nullptr, "1 door\n"), 1);
  EXPECT_EQ(AnswerOfBatch({}, false, nullptr, "2 doors\n"), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "1 door\n2 doors\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "doorforge: a: broken\n");
}

}  // namespace
}  // namespace doorforge
