// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/schemas/cloud.h"

namespace doorforge::internal {

/// The contact moved, across the way in (columns 0 and 1 of the rotation), to the middle of what is
/// seen of the handle between the fingers: of the visible points that are linked to it by steps of
/// at most 15 mm. Fingers that close on a knob beside its middle hold a chord and slide off it.
/// Along a direction in which more is linked than an open hand spans (70 mm) the contact stays.
Eigen::Vector3d CentredContact(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                               const Eigen::Matrix3d& world_from_hand);

}  // namespace doorforge::internal
