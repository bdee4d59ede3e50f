// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace doorforge {

/// Processor time that the work on one object may take where the caller says nothing else [s].
inline constexpr double kObjectSeconds = 300;

/// How long this thread may work on one object before it gives the object up.
///
///     WorkBudget budget("parts/a.obj", 300);
///     RepairMesh(...);  // Error(kFormat) "parts/a.obj: ..." once the 300 s are used up
///
/// What counts is the processor time of this thread, not the wall clock: a busy machine refuses
/// nothing that a quiet one takes. A result never depends on the budget; there is one or there is
/// an Error. Every stage of this room that may take long asks CheckWork() as it goes. A budget
/// inside another one of the same thread changes nothing: the outermost counts.
class WorkBudget {
 public:
  /// `name` begins the message, so it should say which file or object it is. Throws
  /// Error(kInvalidConfig) unless `processor_s` is positive.
  explicit WorkBudget(std::string name, double processor_s = kObjectSeconds);
  ~WorkBudget();
  WorkBudget(const WorkBudget&) = delete;
  WorkBudget& operator=(const WorkBudget&) = delete;

 private:
  friend void CheckWork(unsigned steps);

  std::string name_;
  double allowed_s_;
  double begin_s_;
  unsigned long long steps_ = 0;  // since the clock was read
};

/// Throws Error(kFormat) if this thread works under a budget that is used up. `steps` says how much
/// was done since the last call, in steps of about ten nanoseconds: the clock is read once in some
/// ten thousand of them, and without an argument, for whoever does much between two calls.
void CheckWork(unsigned steps = ~0U);

/// What a user reads about the exception that is being handled, in one line that begins with `name`
/// unless it names a file itself. For the loop over the objects of a batch, in which whatever one
/// object throws is that object's failure: an Error's own words, that memory ran out, or that the
/// object is not what it should be.
std::string CurrentProblem(const std::string& name);

}  // namespace doorforge
