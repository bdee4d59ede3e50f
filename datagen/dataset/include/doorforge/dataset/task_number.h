// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "doorforge/dataset/collect.h"

namespace doorforge {

/// Most tasks of one collection.
inline constexpr int kMostTasks = 1000000;

/// "3/16" is task 3 of 16, counted from 0. Throws Error(kInvalidArgument) on anything else: an
/// empty number, as an unset variable of a scheduler leaves it, must never pass for task 0.
CollectionTask ParseTask(std::string_view text);

/// The task of a scheduler's array: `offset` more than what Slurm's SLURM_ARRAY_TASK_ID or a
/// Kubernetes indexed job's JOB_COMPLETION_INDEX says. Throws Error(kInvalidArgument) if neither is
/// set, both are and differ, one is not a plain number, or the sum is not below `count`.
CollectionTask TaskFromEnvironment(int count, int offset);

}  // namespace doorforge
