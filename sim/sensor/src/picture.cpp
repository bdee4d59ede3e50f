// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"

#include "canvas.h"
#include "caption_lines.h"
#include "jpeg_pixels.h"
#include "png_pixels.h"

namespace doorforge {
namespace {

constexpr int kCaptionHeight = 26;  // of one line
constexpr int kLineHeight = 16;
constexpr double kCapitalHeight = 9;
constexpr int kGap = 10;
constexpr internal::Color kInk = {60, 60, 60};
constexpr internal::Color kWhite = {255, 255, 255};

std::string Encode(const internal::PngPixels& pixels) {
  std::string bytes = internal::EncodePngPixels(pixels);
  if (bytes.empty()) throw Error(ErrorCode::kIo, "picture: cannot be encoded as PNG");
  return bytes;
}

// Numbers of 8 or 16 bits, row by row.
template <class T>
std::string EncodeGrey(const std::vector<T>& pixels, int width, int height) {
  return Encode({reinterpret_cast<const unsigned char*>(pixels.data()),
                 static_cast<std::size_t>(width), static_cast<std::size_t>(height), 1,
                 static_cast<int>(8 * sizeof(T))});
}

void RequirePixels(const Picture& picture) {
  const std::size_t count =
      3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  const bool valid = picture.width > 0 && picture.height > 0 && picture.rgb.size() == count;
  Require(valid, ErrorCode::kInvalidArgument, "picture: empty, or its size and pixels disagree");
}

// Nearest and farthest depth seen up to `limit`.
std::pair<float, float> DepthRange(const DepthImage& image, float limit) {
  float near = limit;
  float far = 0;
  for (const float depth : image.depth_m) {
    if (depth >= limit) continue;
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  return {near, far};
}

// Where a tile, or a caption, lies.
struct Box {
  int left;
  int top;
  int width;
  int height;
};

// The picture scaled to fit the tile, in its middle.
void PasteInto(internal::Canvas& sheet, const Picture& picture, const Box& tile) {
  RequirePixels(picture);
  const double scale = std::min(static_cast<double>(tile.width) / picture.width,
                                static_cast<double>(tile.height) / picture.height);
  const int width = std::clamp(static_cast<int>(std::lround(picture.width * scale)), 1, tile.width);
  const int height =
      std::clamp(static_cast<int>(std::lround(picture.height * scale)), 1, tile.height);
  sheet.Paste(internal::Resized(picture, width, height), tile.left + (tile.width - width) / 2,
              tile.top + (tile.height - height) / 2);
}

double CaptionWidth(const std::string& text) { return internal::TextWidth(text, kCapitalHeight); }

using Caption = std::vector<std::string>;  // its lines

std::vector<Caption> Wrapped(std::span<const std::string> captions, int width) {
  std::vector<Caption> wrapped;
  for (const std::string& caption : captions)
    wrapped.push_back(internal::CaptionLines(
        caption, [&](const std::string& line) { return CaptionWidth(line) <= width; }));
  return wrapped;
}

// Below a sheet's pictures; as high as the longest caption needs.
int CaptionHeight(const std::vector<Caption>& captions) {
  std::size_t lines = 1;
  for (const Caption& caption : captions) lines = std::max(lines, caption.size());
  return captions.empty() ? 0 : kCaptionHeight + (static_cast<int>(lines) - 1) * kLineHeight;
}

void DrawCaption(internal::Canvas& sheet, const Caption& caption, const Box& box) {
  double baseline = box.top + (kCaptionHeight + 10) / 2;
  for (const std::string& line : caption) {
    sheet.Text(line, {std::round(box.left + (box.width - CaptionWidth(line)) / 2), baseline},
               kCapitalHeight, kInk);
    baseline += kLineHeight;
  }
}

constexpr std::uint32_t kMostPixels = 8192;  // a side

struct PngHeader {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int bits = 0;
  int color_type = 0;  // 0: grey
};

// read here, so that a small file that claims to be huge is refused before memory is asked for
PngHeader HeaderOf(std::string_view bytes, const std::string& name,
                   const char* otherwise = "no PNG") {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  if (!bytes.starts_with(kSignature) || bytes.size() < 26)
    throw Error(ErrorCode::kFormat, name + ": is " + otherwise);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | byte(at + i);
    return value;
  };
  return {number(16), number(20), byte(24), byte(25)};
}

// Numbers of bytes that may lie anywhere.
template <class T>
std::vector<T> Copied(const std::byte* values, std::size_t count) {
  std::vector<T> copy(count);
  std::memcpy(copy.data(), values, count * sizeof(T));
  return copy;
}

template <class Units>
std::vector<float> InMetres(const Units& units, double metres_per_unit) {
  std::vector<float> metres;
  metres.reserve(units.size());
  for (const auto value : units) metres.push_back(static_cast<float>(value * metres_per_unit));
  return metres;
}

std::string ListOf(const std::vector<int>& numbers) {
  std::string list;
  for (const int number : numbers) list += (list.empty() ? "" : " or ") + std::to_string(number);
  return list;
}

struct GreyPixels {
  int width;
  int height;
  std::vector<std::uint16_t> values;
};

// A grey PNG with one of these numbers of bits a pixel.
GreyPixels DecodeGrey(std::string_view bytes, const std::string& name,
                      const std::vector<int>& bits) {
  const PngHeader header = HeaderOf(bytes, name);
  const bool allowed = header.width >= 1 && header.height >= 1 && header.width <= kMostPixels &&
                       header.height <= kMostPixels &&
                       std::ranges::find(bits, header.bits) != bits.end() && header.color_type == 0;
  if (!allowed)
    throw Error(ErrorCode::kFormat,
                name + ": a PNG of " + std::to_string(header.width) + " x " +
                    std::to_string(header.height) + " pixels, " + std::to_string(header.bits) +
                    " bits" + (header.color_type == 0 ? "" : ", not grey") + "; expected " +
                    ListOf(bits) + "-bit grey, 1 to 8192 pixels a side");
  GreyPixels grey{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  grey.values.resize(static_cast<std::size_t>(header.width) * header.height);
  std::vector<unsigned char> small(header.bits == 16 ? 0 : grey.values.size());
  auto* const pixels =
      header.bits == 16 ? reinterpret_cast<unsigned char*>(grey.values.data()) : small.data();
  const auto sample_bytes = static_cast<std::size_t>(header.bits / 8);
  if (!internal::DecodePngPixels(bytes, pixels, header.height, header.width * sample_bytes))
    throw Error(ErrorCode::kFormat, name + ": the PNG is damaged");
  std::copy(small.begin(), small.end(), grey.values.begin());
  return grey;
}

}  // namespace

std::string EncodePng(const Picture& picture) {
  RequirePixels(picture);
  return Encode({picture.rgb.data(), static_cast<std::size_t>(picture.width),
                 static_cast<std::size_t>(picture.height)});
}

std::string EncodeJpeg(const Picture& picture, int quality) {
  Require(quality >= 1 && quality <= 100, ErrorCode::kInvalidArgument,
          "picture: the quality of a JPEG must lie in 1..100");
  RequirePixels(picture);
  std::string bytes =
      internal::EncodeJpegPixels({picture.rgb.data(), static_cast<std::size_t>(picture.width),
                                  static_cast<std::size_t>(picture.height)},
                                 quality);
  if (bytes.empty()) throw Error(ErrorCode::kIo, "picture: cannot be encoded as JPEG");
  return bytes;
}

std::string EncodeDepthPng(const DepthImage& image) {
  Require(image.width > 0 && image.height > 0, ErrorCode::kInvalidArgument,
          "depth picture: the image is empty");
  std::vector<std::uint16_t> millimetres(image.depth_m.size());
  for (std::size_t i = 0; i < image.depth_m.size(); ++i) {
    const double rounded = std::round(1000.0 * image.depth_m[i]);
    if (rounded <= std::numeric_limits<std::uint16_t>::max())
      millimetres[i] = static_cast<std::uint16_t>(rounded);
  }
  return EncodeGrey(millimetres, image.width, image.height);
}

DepthImage DecodeDepthPng(std::string_view bytes, double metres_per_unit, const std::string& name) {
  const GreyPixels units = DecodeGrey(bytes, name, {16});
  return MakeDepthImage(units.width, units.height, InMetres(units.values, metres_per_unit));
}

DepthImage DecodeDepthNpy(std::string_view bytes, const DepthUnits& units,
                          const std::string& name) {
  const std::span<const std::byte> data = std::as_bytes(std::span(bytes.data(), bytes.size()));
  const NpyHeader header = ParseNpyHeader(data, name);
  const std::vector<std::size_t>& shape = header.shape;
  const bool is_flat = shape.size() == 2 || (shape.size() == 3 && shape[2] == 1);
  if (!is_flat || shape[0] < 1 || shape[1] < 1 || shape[0] > kMostPixels || shape[1] > kMostPixels)
    throw Error(ErrorCode::kFormat,
                name + ": expected an array of rows and columns, 1 to 8192 each");
  const auto metres = [&]() -> std::vector<float> {
    const std::byte* values = data.data() + header.data_offset;
    const std::size_t count = shape[0] * shape[1];
    if (header.type == "<f4") return InMetres(Copied<float>(values, count), units.of_float);
    if (header.type == "<f8") return InMetres(Copied<double>(values, count), units.of_float);
    if (header.type == "<u2")
      return InMetres(Copied<std::uint16_t>(values, count), units.of_integer);
    throw Error(ErrorCode::kFormat,
                name + ": numbers of type " + header.type +
                    "; depth is of float32, float64 (<f4, <f8) or uint16 (<u2)");
  };
  return MakeDepthImage(static_cast<int>(shape[1]), static_cast<int>(shape[0]), metres());
}

DepthImage MakeDepthImage(int width, int height, std::vector<float> depth_m) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Require(width > 0 && height > 0 && depth_m.size() == count, ErrorCode::kInvalidArgument,
          "depth picture: " + std::to_string(depth_m.size()) + " numbers for " +
              std::to_string(width) + " x " + std::to_string(height) + " pixels");
  DepthImage image{width, height, std::move(depth_m), {}, {}};
  for (float& metres : image.depth_m)
    if (!(metres > 0 && std::isfinite(metres))) metres = std::numeric_limits<float>::infinity();
  image.link.assign(count, -1);
  image.label.assign(count, static_cast<std::uint8_t>(PointLabel::kOther));
  return image;
}

Picture DecodePicture(std::string_view bytes, const std::string& name) {
  const bool is_jpeg = bytes.starts_with("\xff\xd8\xff");
  Picture picture;
  if (is_jpeg) {
    const auto size = internal::JpegSize(bytes);
    picture.width = static_cast<int>(size.width);
    picture.height = static_cast<int>(size.height);
  } else {
    const PngHeader header = HeaderOf(bytes, name, "no PNG and no JPEG");
    picture.width = static_cast<int>(std::min(header.width, kMostPixels + 1));
    picture.height = static_cast<int>(std::min(header.height, kMostPixels + 1));
  }
  const auto width = static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
    throw Error(ErrorCode::kFormat, name + ": damaged, or more than 8192 pixels a side");
  picture.rgb.resize(3 * width * height);
  const bool is_read =
      is_jpeg ? internal::DecodeJpegColors(bytes, picture.rgb.data(), {width, height})
              : internal::DecodePngColors(bytes, picture.rgb.data(), height, 3 * width);
  if (!is_read) throw Error(ErrorCode::kFormat, name + ": the picture is damaged");
  return picture;
}

PixelMask DecodeMaskPng(std::string_view bytes, const std::string& name) {
  const GreyPixels grey = DecodeGrey(bytes, name, {8, 16});
  PixelMask mask{grey.width, grey.height, {}};
  for (const std::uint16_t value : grey.values) mask.set.push_back(value != 0 ? 1 : 0);
  return mask;
}

std::string EncodeMaskPng(const PixelMask& mask) {
  const auto count = static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height);
  Require(mask.width > 0 && mask.height > 0 && mask.set.size() == count,
          ErrorCode::kInvalidArgument, "mask: empty, or its size and pixels disagree");
  std::vector<std::uint8_t> pixels(count);
  for (std::size_t i = 0; i < count; ++i) pixels[i] = mask.set[i] != 0 ? 255 : 0;
  return EncodeGrey(pixels, mask.width, mask.height);
}

void WritePng(const std::filesystem::path& path, const Picture& picture) {
  CommitFile(path, EncodePng(picture));
}

void WriteDepthPng(const std::filesystem::path& path, const DepthImage& image) {
  CommitFile(path, EncodeDepthPng(image));
}

Picture DepthPreview(const DepthImage& image, double max_depth_m) {
  const auto [near, far] = DepthRange(image, static_cast<float>(max_depth_m));
  const float range = std::max(far - near, 1e-6F);
  constexpr internal::Color kUnseen = {232, 232, 232};
  Picture preview{image.width, image.height, {}};
  preview.rgb.reserve(3 * image.depth_m.size());
  for (const float depth : image.depth_m) {
    const auto nearness = static_cast<double>(1 - (depth - near) / range);
    const internal::Color color = depth > far ? kUnseen : internal::Viridis(nearness);
    preview.rgb.insert(preview.rgb.end(), color.begin(), color.end());
  }
  return preview;
}

Picture ContactSheet(std::span<const Picture> pictures, std::span<const std::string> captions,
                     const ContactSheetConfig& config) {
  const bool valid = !pictures.empty() && config.columns > 0 && config.tile_width > 0 &&
                     config.tile_height > 0 &&
                     (captions.empty() || captions.size() == pictures.size());
  Require(valid, ErrorCode::kInvalidArgument,
          "contact sheet: needs pictures, one caption each or none, and a tile size");
  const int count = static_cast<int>(pictures.size());
  const int columns = std::min(config.columns, count);
  const int rows = (count + columns - 1) / columns;
  const int step_x = config.tile_width + kGap;
  const std::vector<Caption> lines = Wrapped(captions, config.tile_width);
  const int caption_height = CaptionHeight(lines);
  const int step_y = config.tile_height + kGap + caption_height;
  internal::Canvas sheet(columns * step_x + kGap, rows * step_y + kGap, kWhite);
  for (int i = 0; i < count; ++i) {
    const Box tile{kGap + i % columns * step_x, kGap + i / columns * step_y, config.tile_width,
                   config.tile_height};
    PasteInto(sheet, pictures[static_cast<std::size_t>(i)], tile);
    if (captions.empty()) continue;
    DrawCaption(sheet, lines[static_cast<std::size_t>(i)],
                {tile.left, tile.top + tile.height, tile.width, caption_height});
  }
  return std::move(sheet).Take();
}

}  // namespace doorforge
