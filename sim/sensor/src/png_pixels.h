// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace doorforge::internal {

/// Decodes a PNG into `height` rows of `row_bytes` bytes each, 16-bit samples in the machine's
/// order. The caller has read width, height and bits from the header and has room for them; a PNG
/// whose rows are not that long is refused. Returns false where it is damaged. Prints nothing.
bool DecodePngPixels(std::string_view png, unsigned char* pixels, std::size_t height,
                     std::size_t row_bytes);

/// Decodes any PNG likewise into red, green, blue of 8 bits each.
bool DecodePngColors(std::string_view png, unsigned char* pixels, std::size_t height,
                     std::size_t row_bytes);

/// Pixels of `channels` samples (1: grey, 3: red, green, blue) of `bits` bits (8 or 16, these in
/// the machine's order), row after row.
struct PngPixels {
  const unsigned char* pixels = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  int channels = 3;
  int bits = 8;
};

/// Encodes them with fixed settings: equal pixels give equal bytes. Returns nothing where libpng
/// has no memory left.
std::string EncodePngPixels(const PngPixels& picture);

}  // namespace doorforge::internal
