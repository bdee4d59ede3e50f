// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "doorforge/sensor/picture.h"

namespace doorforge {

/// Copies between a picture and OpenCV's 8-bit BGR. Throws Error(kInvalidArgument) if the picture
/// is empty.
cv::Mat ToMat(const Picture& picture);
Picture FromMat(const cv::Mat& bgr);

}  // namespace doorforge
