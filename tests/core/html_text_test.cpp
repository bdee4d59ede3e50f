// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/html_text.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace doorforge::page {
namespace {

TEST(HtmlText, AFileIsAddressedFromTheFolderOfThePage) {
  EXPECT_EQ(AddressOn("out/page.html", "out/films.html"), "films.html");
  EXPECT_EQ(AddressOn("out/page.html", "films/all.html"), "../films/all.html");
  EXPECT_EQ(AddressOn("page.html", std::filesystem::absolute("films.html")), "films.html");
  EXPECT_EQ(AddressOn("out/page.html", ""), "");
}

// RFC 3629, section 3, and its examples of what is none: bytes of other encodings, a character that
// is cut off, an overlong one, half of a surrogate pair, one beyond the last.
TEST(HtmlText, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(page::Escape("T\xC3\xBCr \xE2\x82\xAC \xF0\x9F\x9A\xAA"),
            "T\xC3\xBCr \xE2\x82\xAC \xF0\x9F\x9A\xAA");
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(page::Escape("a\xFF<"), "a" + replaced + "&lt;");
  EXPECT_EQ(page::Escape("\xE2\x82"), replaced + replaced);
  EXPECT_EQ(page::Escape("\xC0\xAF"), replaced + replaced);
  EXPECT_EQ(page::Escape("\xED\xA0\x80"), replaced + replaced + replaced);
  EXPECT_EQ(page::Escape("\xF4\x90\x80\x80"), replaced + replaced + replaced + replaced);
}

}  // namespace
}  // namespace doorforge::page
