// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge {

/// Bytes of all files below a folder; 0 if it is not there.
double BytesBelow(const std::filesystem::path& folder);

/// Whether what is about to be written fits where `folder` lies; nothing if it does, otherwise a
/// sentence with the numbers, "<folder>: about 120 MiB are needed, 7 MiB are free". The folder need
/// not be there yet.
std::string LackOfSpace(const std::filesystem::path& folder, double needed_bytes);

/// Refuses work that would certainly fill the disk, before it begins.
/// @param way_out What may be done about it, "make room, or choose another --out".
/// @throws Error(kIo) with LackOfSpace() and the way out.
void RequireSpace(const std::filesystem::path& folder, double needed_bytes,
                  const std::string& way_out);

}  // namespace doorforge
