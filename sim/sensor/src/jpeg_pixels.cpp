// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "jpeg_pixels.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace doorforge::internal {
namespace {

constexpr int kChannels = 3;

/// libjpeg's own handler ends the program. This one goes back to where encoding began.
struct ErrorHandler {
  jpeg_error_mgr manager{};  // the first member, so that its address is that of the whole
  std::jmp_buf begin{};
};

[[noreturn]] void GoBack(j_common_ptr codec) {
  std::longjmp(reinterpret_cast<ErrorHandler*>(codec->err)->begin, 1);
}

/// Memory that libjpeg allocates.
struct EncodedBytes {
  unsigned char* data = nullptr;
  unsigned long size = 0;
};

// No object with a destructor lives here: the jump back would leave it out.
bool Encode(const PngPixels& pixels, int quality, EncodedBytes& bytes) {
  ErrorHandler handler;
  jpeg_compress_struct codec{};
  codec.err = ::jpeg_std_error(&handler.manager);
  handler.manager.error_exit = GoBack;
  handler.manager.output_message = [](j_common_ptr) {};
  if (setjmp(handler.begin) != 0) {
    ::jpeg_destroy_compress(&codec);
    return false;
  }
  ::jpeg_create_compress(&codec);
  ::jpeg_mem_dest(&codec, &bytes.data, &bytes.size);
  codec.image_width = static_cast<JDIMENSION>(pixels.width);
  codec.image_height = static_cast<JDIMENSION>(pixels.height);
  codec.input_components = kChannels;
  codec.in_color_space = JCS_RGB;
  ::jpeg_set_defaults(&codec);
  ::jpeg_set_quality(&codec, quality, TRUE);
  ::jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    const auto* row = pixels.pixels + kChannels * pixels.width * codec.next_scanline;
    JSAMPROW rows[1] = {const_cast<JSAMPROW>(row)};  // only read from
    ::jpeg_write_scanlines(&codec, rows, 1);
  }
  ::jpeg_finish_compress(&codec);
  ::jpeg_destroy_compress(&codec);
  return true;
}

// libjpeg warns where data are damaged or end early, fills up with grey and goes on.
void GoBackOnWarning(j_common_ptr codec, int level) {
  if (level < 0) GoBack(codec);
}

// Reads a header, and rows where there is room for them; no destructors here either.
bool Decode(std::string_view jpeg, unsigned char* pixels, JpegExtent& size) {
  ErrorHandler handler;
  jpeg_decompress_struct codec{};
  codec.err = ::jpeg_std_error(&handler.manager);
  handler.manager.error_exit = GoBack;
  handler.manager.emit_message = GoBackOnWarning;
  handler.manager.output_message = [](j_common_ptr) {};
  if (setjmp(handler.begin) != 0) {
    ::jpeg_destroy_decompress(&codec);
    return false;
  }
  ::jpeg_create_decompress(&codec);
  ::jpeg_mem_src(&codec, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size());
  ::jpeg_read_header(&codec, TRUE);
  const bool fits = codec.image_width == size.width && codec.image_height == size.height;
  size = {codec.image_width, codec.image_height};
  if (pixels != nullptr && fits) {
    codec.out_color_space = JCS_RGB;
    ::jpeg_start_decompress(&codec);
    while (codec.output_scanline < codec.output_height) {
      JSAMPROW rows[1] = {pixels + kChannels * size.width * codec.output_scanline};
      ::jpeg_read_scanlines(&codec, rows, 1);
    }
    ::jpeg_finish_decompress(&codec);
  }
  ::jpeg_destroy_decompress(&codec);
  return fits;
}

}  // namespace

JpegExtent JpegSize(std::string_view jpeg) {
  JpegExtent size;
  Decode(jpeg, nullptr, size);
  return size;
}

bool DecodeJpegColors(std::string_view jpeg, unsigned char* pixels, const JpegExtent& size) {
  JpegExtent expected = size;
  return Decode(jpeg, pixels, expected);
}

std::string EncodeJpegPixels(const PngPixels& pixels, int quality) {
  EncodedBytes bytes;
  const bool done = Encode(pixels, quality, bytes);
  std::string text;
  if (done) text.assign(reinterpret_cast<const char*>(bytes.data), bytes.size);
  std::free(bytes.data);
  return text;
}

}  // namespace doorforge::internal
