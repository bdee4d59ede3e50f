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
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:{more}">
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

// `more` ends the list of where pictures may come from, and may begin other lists.
std::string PageWith(const std::string& title, const std::string& more,
                     const PageContent& content) {
  return page::Fill(kBefore, {{"title", page::Escape(title)}, {"more", more}}) +
         DataOf("viewer.css") + std::string(kBody) + Base64(content.Packed()) +
         "</script>\n<script>" + DataOf("viewer.js") + "</script>\n</body>\n</html>\n";
}

}  // namespace

std::string HtmlPage(const std::string& title, const PageContent& content) {
  return PageWith(title, "", content);
}

std::string ServedHtmlPage(const std::string& title, const PageContent& content) {
  return PageWith(title, " 'self'; connect-src 'self'", content);
}

}  // namespace doorforge::internal
