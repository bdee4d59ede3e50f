// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// Says when the handle is turned and opening may begin, from what a robot knows of itself. A
/// policy that turns handles may be one as well.
class StageSwitch {
 public:
  virtual ~StageSwitch() = default;
  /// Whether it says anything in this episode. Somebody else's policy may not: the simulator does.
  virtual bool Says() const { return true; }
  /// Whether the handle is turned once the actions so far have been carried out. Stays true until
  /// the episode ends. Read only where Says().
  virtual bool Turned() const = 0;
};

}  // namespace doorforge
