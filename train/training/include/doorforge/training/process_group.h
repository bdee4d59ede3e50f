// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace doorforge {

/// Processes, here or on several machines, that train one policy together. All of them make the
/// same calls in the same order.
class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;
  virtual int rank() const = 0;  ///< 0..size() - 1.
  virtual int size() const = 0;  ///< 1, 2, 4 or 8.
  /// What each process gave, one after the other by rank; all give as much.
  /// @throws Error(kIncomplete) if another process is gone.
  virtual std::vector<float> Gather(std::span<const float> mine) = 0;
  /// Sums in place what all processes give, in every one of them: neighbours in pairs, pairs of
  /// pairs and so on, so the bits are those of a binary tree over the ranks. All give as much.
  /// @throws Error(kIncomplete) if another process is gone.
  virtual void Sum(std::span<float> mine) = 0;
};

/// The one process that trains alone.
std::unique_ptr<ProcessGroup> SingleProcessGroup();

/// The group that the variables RANK, WORLD_SIZE, MASTER_ADDR and MASTER_PORT describe, as torchrun
/// sets them; the process of rank 0 listens on the port. Waits up to five minutes for the others.
///
/// @throws Error(kInvalidArgument) if a variable is missing or absurd, or libtorch has no
///     distributed back end (Gloo) here; Error(kIo) if the processes do not find each other.
std::unique_ptr<ProcessGroup> ProcessGroupFromEnvironment();

}  // namespace doorforge
