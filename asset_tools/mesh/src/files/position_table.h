// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace doorforge {

/// Gives equal positions one number, in order of first use.
class PositionTable {
 public:
  int IndexOf(const Eigen::Vector3d& position) {
    const Eigen::Vector3d key = position + Eigen::Vector3d::Zero();  // turns -0 into 0
    const auto [entry, is_new] = index_of_.try_emplace(key, static_cast<int>(positions_.size()));
    if (is_new) positions_.push_back(key);
    return entry->second;
  }

  std::vector<Eigen::Vector3d>& positions() { return positions_; }

 private:
  struct Hash {
    std::size_t operator()(const Eigen::Vector3d& v) const {
      std::uint64_t hash = 0;
      for (const double coordinate : v) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &coordinate, sizeof bits);
        hash = (hash ^ bits ^ (bits >> 32)) * 0x9E3779B97F4A7C15ULL;
      }
      return hash ^ (hash >> 29);
    }
  };

  std::unordered_map<Eigen::Vector3d, int, Hash> index_of_;  // looked up only, never walked
  std::vector<Eigen::Vector3d> positions_;
};

}  // namespace doorforge
