// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "doorforge/deploy/online_controller.h"

namespace doorforge {

/// Refuses what does not go together, before anything is read.
///
/// @param picture File that one answer is to be drawn into; empty: none.
/// @throws Error(kInvalidArgument) in the words of the options of `doorforge act`.
void CheckRequest(const OnlineControllerSetup& setup, const DecisionFiles& files,
                  const std::string& picture);

/// How decisions of a stream are asked for and told.
struct DecisionStream {
  std::istream& requests;  ///< A line is a request, as docs/act.md has it; empty ones are skipped.
  DecisionFiles files;     ///< `before` is remembered first, `camera` is what messages call it.
  bool as_text = false;    ///< True: AnswerText(); false: AnswerToJson() on one line.
  /// Called with each answer as it comes: a robot waits for it.
  std::function<void(const std::string&)> tell;
};

/// Decides for every line until the requests end or a signal asks to stop. A line that cannot be
/// answered is answered with a hold that says why, and the stream goes on: the robot holds still
/// meanwhile.
///
/// @returns Whether any answer says hold.
bool AnswerStream(OnlineController& controller, const DecisionStream& stream);

}  // namespace doorforge
