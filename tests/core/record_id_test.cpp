// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/record_id.h"

#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

TEST(RecordId, TakesWhatPartsAndDoorsAreCalled) {
  const std::vector<std::string> good = {"interior_flush_01__interior_lever_03__right",
                                         "99650089960001",
                                         "udm-1.v2",
                                         "_",
                                         "a..b",
                                         std::string(120, 'x')};
  for (const std::string& id : good) EXPECT_EQ(IdProblem(id), "") << id;
}

TEST(RecordId, RefusesWhateverIsMoreThanAPlainName) {
  const std::vector<std::string> bad = {
      "",         ".",    "..",         "../x",  "/etc",
      "a/b",      "a\\b", ".hidden",    "-rf",   "a b",
      "a\n",      "a\tb", "t\xc3\xbcr", "a\xff", std::string("a\0b", 3),
      "<script>", "~",    "a:b",        "$(x)",  std::string(121, 'x')};
  for (const std::string& id : bad) {
    EXPECT_NE(IdProblem(id), "") << id;
    EXPECT_THROW(RequireId(id, "door.json: id"), Error) << id;
  }
  try {
    RequireId("a\nb", "door.json: id");
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("door.json: id: ")) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << "shown, not obeyed: " << what;
  }
}

TEST(RecordId, AnOutputIsOnePlainComponentBelowTheFolder) {
  EXPECT_EQ(OutputBelow("out", "x.png"), fs::path("out/x.png"));
  for (const std::string name : {"", ".", "..", "../x", "/x", "a/b", "x/"})
    EXPECT_THROW(OutputBelow("out", name), Error) << name;
}

}  // namespace
}  // namespace doorforge
