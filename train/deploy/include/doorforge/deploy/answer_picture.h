// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/deploy/act_answer.h"
#include "doorforge/deploy/online_controller.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// The depth picture in colours, what the crop leaves out washed out, and beside it half a metre
/// about the hand; the mask of a handle outlined; the hand where it is in white and where it is to
/// go in red, with its fingers; a grasp's contact as a ring. Below it what is expected, how foreign
/// the picture is, and whether to hold.
///
/// @param answer The last answer of `controller`, whose robot says where the fingers are in the
///     hand's frame.
Picture AnswerPicture(const ActAnswer& answer, const OnlineController& controller,
                      const CloudConfig& cloud);

}  // namespace doorforge
