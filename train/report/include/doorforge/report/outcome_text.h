// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "doorforge/report/evaluated_episode.h"
#include "doorforge/report/success_statistics.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/names.h"

// Names for people.

namespace doorforge::internal {

struct OutcomeText {
  std::string title;    ///< "Grip lost"
  std::string meaning;  ///< One sentence.
};
OutcomeText TextOf(EpisodeOutcome outcome);
/// Describes what CauseOf() gives.
OutcomeText TextOf(std::string_view cause);

std::string TitleOf(Category category);          ///< "Storage furniture"
std::string TitleOf(const EpisodeGroup& group);  ///< "All", "Storage furniture, with a latch"

}  // namespace doorforge::internal
