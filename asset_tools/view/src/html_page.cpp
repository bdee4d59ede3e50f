// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "html_page.h"

#include "doorforge/core/committed_file.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/program.h"

namespace doorforge::internal {
namespace {

constexpr std::string_view kBefore = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>)html";

constexpr std::string_view kBody = R"html(</style>
</head>
<body>
<noscript>This page draws doors with JavaScript, which is switched off here.</noscript>
<script type="application/octet-stream" id="content">)html";

std::string DataOf(const char* file) {
  return ReadFile(DataFolder() / "view" / file, std::uint64_t{16} << 20);
}

}  // namespace

std::string ViewerScript() { return DataOf("viewer.js"); }
std::string ViewerStyle() { return DataOf("viewer.css"); }

std::string HtmlPage(const std::string& title, const PageContent& content) {
  return page::Fill(kBefore, {{"title", page::Escape(title)}}) + ViewerStyle() +
         std::string(kBody) + Base64(content.Packed()) + "</script>\n<script>" + ViewerScript() +
         "</script>\n</body>\n</html>\n";
}

}  // namespace doorforge::internal
