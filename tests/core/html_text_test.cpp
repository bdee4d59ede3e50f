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

}  // namespace
}  // namespace doorforge::page
