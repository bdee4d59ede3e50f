// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge {

/// The robot's file for a dataset whose config.yaml names `recorded`.
///
/// A dataset comes from anywhere, and a file that it names is not opened for that alone: it is the
/// embedded robot (empty), one below the dataset's folder, or `given`, which whoever calls the
/// program has named. Its content is compared with the recorded hash either way, by the reader.
///
/// @throws Error(kInvalidArgument) if it is none of these.
std::string RecordedRobot(const std::filesystem::path& dataset, const std::string& recorded,
                          const std::string& given);

}  // namespace doorforge
