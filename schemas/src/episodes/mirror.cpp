// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mirror.h"

#include <algorithm>
#include <utility>

namespace doorforge {
namespace {

// A hand's fingers change places in either mirror.
void ExchangeFingers(Proprioception& proprioception) {
  std::swap(proprioception[9], proprioception[10]);   // openings
  std::swap(proprioception[20], proprioception[21]);  // speeds
}

void TurnSign(LabelledCloud& cloud, std::size_t axis) {
  for (std::size_t i = axis; i < cloud.xyz.size(); i += 3) cloud.xyz[i] = -cloud.xyz[i];
  cloud.picture.reset();
}

}  // namespace

Proprioception MirroredSideways(const Proprioception& proprioception) {
  Proprioception mirrored = proprioception;
  ExchangeFingers(mirrored);
  mirrored[23] = -mirrored[23];  // y of the base
  mirrored[26] = -mirrored[26];  // y of the hand
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

LabelledCloud MirroredSideways(LabelledCloud cloud) {
  TurnSign(cloud, 1);
  return cloud;
}

Proprioception MirroredUpright(const Proprioception& proprioception) {
  Proprioception mirrored = proprioception;
  ExchangeFingers(mirrored);
  mirrored[24] = -mirrored[24];  // z of the base
  mirrored[27] = -mirrored[27];  // z of the hand
  // M R diag(1, -1, 1), with M the mirror, is M R M and then half a turn about the hand's x: the
  // first changes the sign of the quaternion's x and y, both together read it backwards
  std::reverse(mirrored.begin() + 28, mirrored.begin() + 32);
  return mirrored;
}

ActionVector MirroredUpright(const ActionVector& action) {
  ActionVector mirrored = action;
  mirrored[2] = -mirrored[2];  // z of the way
  // M R diag(1, -1, 1): of both rows the middle number
  for (const std::size_t odd : {4U, 7U}) mirrored[odd] = -mirrored[odd];
  return mirrored;
}

LabelledCloud MirroredUpright(LabelledCloud cloud) {
  TurnSign(cloud, 2);
  return cloud;
}

}  // namespace doorforge
