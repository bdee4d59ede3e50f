// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge {

/// The file that a record in `folder` names. `named_by` (such as "mobility.urdf") goes into
/// messages. Throws Error(kFormat) if the name is absolute, has a scheme, or leaves the folder by
/// ".." or by a link, and Error(kMissing) if there is no such regular file.
std::filesystem::path FileInside(const std::filesystem::path& folder, const std::string& name,
                                 const std::string& named_by);

}  // namespace doorforge
