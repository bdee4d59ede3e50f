// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace doorforge {

/// A body and a handle to compose, and the side of the split that they are on.
struct DoorPair {
  std::string body_id;
  std::string handle_id;
  std::filesystem::path body_folder;
  std::filesystem::path handle_folder;
  std::string subset;  ///< "train" or "test"
};

/// Chooses the doors of a quick run from a folder of parts (those categories and mechanisms that
/// the rule-based expert can open).
///
/// Within each kind (category, role, mechanism) every third part is held out; parts made from the
/// same source go to the same side, so no body and no handle is on both. Up to 24 training and 5
/// held-out pairs are drawn per category and mechanism. A function of the parts' records and the
/// seed alone; sorted by subset, body, handle. Throws Error(kMissing) if no pair is possible.
std::vector<DoorPair> SplitIntoDoors(const std::filesystem::path& parts_folder, std::uint64_t seed);

}  // namespace doorforge
