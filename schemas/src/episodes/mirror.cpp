// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mirror.h"

#include <utility>

namespace doorforge {

Proprioception MirroredSideways(const Proprioception& proprioception) {
  Proprioception mirrored = proprioception;
  std::swap(mirrored[9], mirrored[10]);   // finger openings
  std::swap(mirrored[20], mirrored[21]);  // and their speeds
  mirrored[23] = -mirrored[23];           // y of the base
  mirrored[26] = -mirrored[26];           // y of the hand
  // M R diag(1, -1, 1), with M the mirror, turns about an axis mirrored as an axis is: its x and z
  // change their sign
  mirrored[28] = -mirrored[28];
  mirrored[30] = -mirrored[30];
  return mirrored;
}

ActionVector MirroredSideways(const ActionVector& action) {
  ActionVector mirrored = action;
  mirrored[1] = -mirrored[1];  // y of the way
  // M R diag(1, -1, 1): of the first row the middle number, of the second both others
  for (const std::size_t odd : {4U, 6U, 8U}) mirrored[odd] = -mirrored[odd];
  return mirrored;
}

}  // namespace doorforge
