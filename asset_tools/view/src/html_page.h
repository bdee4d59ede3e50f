// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "page_content.h"

namespace doorforge::internal {

/// One HTML file with the viewer of data/view and the content, which reads nothing else: its
/// content security policy forbids every request. Throws Error(kMissing) where the viewer is not
/// among the data.
std::string HtmlPage(const std::string& title, const PageContent& content);

/// Makes the same page, which may ask the server that it came from.
std::string ServedHtmlPage(const std::string& title, const PageContent& content);

}  // namespace doorforge::internal
