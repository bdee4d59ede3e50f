// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace doorforge::internal {

/// Decodes a PNG into `height` rows of `row_bytes` bytes each, 16-bit samples in the machine's
/// order. The caller has read width, height and bits from the header and has room for them; a PNG
/// whose rows are not that long is refused. Returns false where it is damaged. Prints nothing,
/// unlike OpenCV's reader, which leaves it to libpng to write to standard error.
bool DecodePngPixels(std::string_view png, unsigned char* pixels, std::size_t height,
                     std::size_t row_bytes);

}  // namespace doorforge::internal
