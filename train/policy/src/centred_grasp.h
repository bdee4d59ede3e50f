// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/schemas/cloud.h"

namespace doorforge::internal {

/// The contact moved across the way in, to the middle of what is seen of the handle between the
/// fingers: of the visible points that are linked to it by steps of at most 15 mm. First sideways
/// (column 0 of the rotation) to the middle of all of them, if an open hand spans them every way
/// (70 mm): of a knob, not of a bar. Then, the way the fingers close (column 1), to the middle of
/// those that the pads meet there, if it spans those. Fingers that close on a knob beside its
/// middle hold a chord and slide off it.
Eigen::Vector3d CentredContact(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                               const Eigen::Matrix3d& world_from_hand);

}  // namespace doorforge::internal
