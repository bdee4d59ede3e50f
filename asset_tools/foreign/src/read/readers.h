// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "doorforge/foreign/articulated_object.h"

#include "faults/fault_list.h"
#include "text/xml_text.h"

namespace doorforge::foreign {

/// @name Readers of XML formats
/// Each fills the value as far as the document allows and adds the faults of the text.
/// @{
ArticulatedObject ReadForeignUrdf(const XmlDocument& document, const std::string& file,
                                  FaultList& faults);
ArticulatedObject ReadForeignSdf(const XmlDocument& document, const std::string& file,
                                 FaultList& faults);
/// Follows `<include>` to files below `root`.
ArticulatedObject ReadForeignMjcf(const XmlDocument& document, const std::string& file,
                                  const std::filesystem::path& root, FaultList& faults);
/// @}

/// Reads USD's text form, without composition.
ArticulatedObject ReadForeignUsda(std::string_view text, const std::string& file,
                                  FaultList& faults);

/// The text of a file of at most 16 MiB; FIL001 or FIL003 where there is none.
std::optional<std::string> ForeignText(const std::filesystem::path& path, FaultList& faults);

/// The document; FIL002, FIL003 or FIL004 where it is none.
std::optional<XmlDocument> ForeignXml(std::string_view text, const std::string& file,
                                      FaultList& faults);

}  // namespace doorforge::foreign
