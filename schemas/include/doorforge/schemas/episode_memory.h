// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// What the policies of a set find out about an episode's door and pass on from stage to stage.
class EpisodeMemory {
 public:
  virtual ~EpisodeMemory() = default;
  /// Whether a picture of the closed door is of use.
  virtual bool WantsPicture() const = 0;
  /// Forgets the last episode; called before each.
  ///
  /// @param before What the camera sees of the door before the robot comes, in the world, labels
  ///     unread; nothing where nobody looked.
  virtual void Begin(std::optional<LabelledCloud> before) = 0;
  /// Whether the present grasp leads nowhere, so that another is better begun with at once.
  virtual bool GivesUp() const { return false; }
};

}  // namespace doorforge
