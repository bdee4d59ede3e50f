// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "png_pixels.h"

#include <bit>
#include <csetjmp>
#include <cstring>
#include <vector>

#include <png.h>

namespace doorforge::internal {
namespace {

// libpng leaves a function by longjmp, which skips destructors: what is between is plain data.
[[noreturn]] void Leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void Ignore(png_structp, png_const_charp) {}

void TakeBytes(png_structp png, png_bytep to, std::size_t count) {
  auto& left = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > left.size()) png_error(png, "cut off");
  std::memcpy(to, left.data(), count);
  left.remove_prefix(count);
}

void AddBytes(png_structp png, png_bytep from, std::size_t count) {
  auto& to = *static_cast<std::string*>(png_get_io_ptr(png));
  to.append(reinterpret_cast<const char*>(from), count);
}

void KeepAll(png_structp) {}

/// Where a picture's pixels go.
struct PixelRows {
  unsigned char** rows = nullptr;
  std::size_t row_bytes = 0;
  bool as_colors = false;
};

bool WriteRows(png_structp png, png_infop info, const PngPixels& picture, unsigned char** rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, 6);
  png_set_compression_strategy(png, 1);  // zlib's Z_FILTERED
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width),
               static_cast<png_uint_32>(picture.height), picture.bits,
               picture.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (picture.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

// What a file may hold becomes three samples of eight bits.
void AskForColors(png_structp png) {
  png_set_expand(png);
  png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_strip_alpha(png);
}

void AskForSamples(png_structp png, png_infop info) {
  if (png_get_bit_depth(png, info) == 16 && std::endian::native == std::endian::little)
    png_set_swap(png);
}

bool ReadRows(png_structp png, png_infop info, const PixelRows& to) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  to.as_colors ? AskForColors(png) : AskForSamples(png, info);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != to.row_bytes) return false;
  png_read_image(png, to.rows);
  png_read_end(png, nullptr);
  return true;
}

bool Decode(std::string_view bytes, unsigned char* pixels, std::size_t height, PixelRows to) {
  std::vector<unsigned char*> rows;
  for (std::size_t row = 0; row < height; ++row) rows.push_back(pixels + row * to.row_bytes);
  to.rows = rows.data();
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, Leave, Ignore);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool is_read = false;
  if (info != nullptr) {
    std::string_view left = bytes;
    png_set_read_fn(png, &left, TakeBytes);
    is_read = ReadRows(png, info, to);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return is_read;
}

}  // namespace

bool DecodePngPixels(std::string_view bytes, unsigned char* pixels, std::size_t height,
                     std::size_t row_bytes) {
  return Decode(bytes, pixels, height, {.row_bytes = row_bytes});
}

bool DecodePngColors(std::string_view bytes, unsigned char* pixels, std::size_t height,
                     std::size_t row_bytes) {
  return Decode(bytes, pixels, height, {.row_bytes = row_bytes, .as_colors = true});
}

std::string EncodePngPixels(const PngPixels& picture) {
  const std::size_t row_bytes = picture.width * static_cast<std::size_t>(picture.channels) *
                                static_cast<std::size_t>(picture.bits / 8);
  std::vector<unsigned char*> rows;
  for (std::size_t row = 0; row < picture.height; ++row)
    rows.push_back(const_cast<unsigned char*>(picture.pixels) + row * row_bytes);  // only read from
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, Leave, Ignore);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool is_written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &bytes, AddBytes, KeepAll);
    is_written = WriteRows(png, info, picture, rows.data());
  }
  png_destroy_write_struct(&png, &info);
  return is_written ? bytes : std::string();
}

}  // namespace doorforge::internal
