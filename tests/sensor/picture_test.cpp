// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/picture.h"

#include <array>
#include <cstdio>  // jpeglib.h needs it before
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <jpeglib.h>

#include "doorforge/core/error.h"

#include "canvas.h"
#include "caption_lines.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Picture Gradient(int width, int height) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.rgb.push_back(static_cast<std::uint8_t>(x));
      picture.rgb.push_back(static_cast<std::uint8_t>(y));
      picture.rgb.push_back(200);
    }
  }
  return picture;
}

// Size, bit depth, colour type and the first pixels' samples of a PNG, read by an independent
// decoder: Python's zlib and the filters of the PNG specification.
std::string DecodeWithPython(const fs::path& path) {
  const fs::path script = path.string() + ".py";
  std::ofstream(script) << R"(
import struct, sys, zlib
data = open(sys.argv[1], 'rb').read()
at, packed = 8, b''
while at < len(data):
    size, kind = struct.unpack('>I4s', data[at:at + 8])
    body = data[at + 8:at + 8 + size]
    assert struct.unpack('>I', data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
    if kind == b'IHDR': w, h, depth, color = struct.unpack('>IIBB', body[:10])
    if kind == b'IDAT': packed += body
    at += 12 + size
bpp = depth // 8 * {0: 1, 2: 3}[color]
raw, line, out = zlib.decompress(packed), bytearray(w * bpp), []
for y in range(h):
    row = bytearray(raw[y * (w * bpp + 1):(y + 1) * (w * bpp + 1)])
    kind, row = row[0], row[1:]
    for i in range(len(row)):
        a = row[i - bpp] if i >= bpp else 0
        b, c = line[i], line[i - bpp] if i >= bpp else 0
        p = a + b - c
        near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        row[i] = (row[i] + [0, a, b, (a + b) // 2, near][kind]) & 255
    line = row
    out.append(row)
text = b''.join(out)
samples = struct.unpack('>%d%s' % (len(text) // (depth // 8), {8: 'B', 16: 'H'}[depth]), text)
print(w, h, depth, color, *samples[:12])
)";
  const fs::path answer = path.string() + ".txt";
  const std::string command = "/usr/bin/python3 '" + script.string() + "' '" + path.string() +
                              "' > '" + answer.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::stringstream text;
  text << std::ifstream(answer).rdbuf();
  return text.str();
}

class PictureFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("doorforge_picture_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(PictureFile, IsAnRgbPngThatOtherProgramsDecode) {
  WritePng(folder_ / "a.png", Gradient(20, 3));
  EXPECT_EQ(DecodeWithPython(folder_ / "a.png"), "20 3 8 2 0 0 200 1 0 200 2 0 200 3 0 200\n");
}

TEST_F(PictureFile, HoldsDepthAsMillimetres) {
  DepthImage image;
  image.width = 3;
  image.height = 2;
  image.depth_m = {1.0F, 0.0004F, 2.4996F, std::numeric_limits<float>::infinity(), 65.535F, 66.0F};
  WriteDepthPng(folder_ / "d.png", image);
  EXPECT_EQ(DecodeWithPython(folder_ / "d.png"), "3 2 16 0 1000 0 2500 0 65535 0\n");
}

TEST(Picture, GivesTheSameBytesForTheSamePixels) {
  EXPECT_EQ(EncodePng(Gradient(50, 40)), EncodePng(Gradient(50, 40)));
}

TEST(Picture, IsRefusedWhereItIsEmpty) {
  EXPECT_THROW(EncodePng(Picture{}), Error);
  EXPECT_THROW(EncodePng(Picture{4, 4, std::vector<std::uint8_t>(5)}), Error);
  EXPECT_THROW(EncodeDepthPng(DepthImage{}), Error);
}

TEST(DepthPreview, ColorsNearAndFarDifferentlyAndLeavesTheUnseenGrey) {
  DepthImage image;
  image.width = 3;
  image.height = 1;
  image.depth_m = {0.5F, 2.0F, std::numeric_limits<float>::infinity()};
  const Picture preview = DepthPreview(image);
  const auto pixel = [&](std::size_t i) {
    return std::array<int, 3>{preview.rgb[3 * i], preview.rgb[3 * i + 1], preview.rgb[3 * i + 2]};
  };
  EXPECT_GT(pixel(0)[1], 200);  // viridis ends in yellow ...
  EXPECT_LT(pixel(1)[1], 40);   // ... and in violet
  EXPECT_EQ(pixel(2), (std::array<int, 3>{232, 232, 232}));
}

TEST(ContactSheet, PlacesPicturesInRows) {
  std::vector<Picture> pictures(5, Gradient(40, 30));
  const std::vector<std::string> captions(5, "a door");
  const Picture sheet =
      ContactSheet(pictures, captions, {.columns = 3, .tile_width = 80, .tile_height = 60});
  EXPECT_EQ(sheet.width, 3 * 90 + 10);
  EXPECT_EQ(sheet.height, 2 * (60 + 10 + 26) + 10);
  EXPECT_EQ(sheet.rgb[0], 255);
  EXPECT_THROW(ContactSheet({}, {}), Error);
  EXPECT_THROW(ContactSheet(pictures, std::vector<std::string>(2, "x")), Error);
}

TEST(ContactSheet, ShowsCaptionsToTheirEnd) {
  const std::vector<Picture> pictures(1, Gradient(40, 30));
  const auto sheet = [&](const std::string& caption) {
    return ContactSheet(pictures, std::vector<std::string>{caption},
                        {.columns = 1, .tile_width = 160, .tile_height = 120});
  };
  const Picture first = sheet("interior_four_panel_02__interior_lever_tube_01");
  const Picture second = sheet("interior_four_panel_02__interior_lever_tube_02");
  EXPECT_EQ(first.height, second.height);
  EXPECT_NE(first.rgb, second.rgb) << "both captions read the same";
  EXPECT_EQ(first.height, sheet("short").height + 2 * 16);
}

// Letters are as high as they are asked to be and end where their width says; each looks otherwise.
TEST(Canvas, WritesAllOfAsciiWithinItsWidth) {
  std::set<std::vector<std::uint8_t>> seen;
  for (char letter = '!'; letter <= '~'; ++letter) {
    internal::Canvas canvas(60, 60, {255, 255, 255});
    canvas.Text(std::string(1, letter), {10, 40}, 18, {0, 0, 0});
    const Picture picture = canvas.picture();
    std::array<int, 4> box = {60, 60, -1, -1};  // of what is dark: left, top, right, bottom
    for (int i = 0; i < 3600; ++i) {
      if (picture.rgb[3 * static_cast<std::size_t>(i)] > 200) continue;
      box = {std::min(box[0], i % 60), std::min(box[1], i / 60), std::max(box[2], i % 60),
             std::max(box[3], i / 60)};
    }
    EXPECT_GE(box[0], 8) << letter;
    EXPECT_LE(box[2], 10 + internal::TextWidth(std::string(1, letter), 18) + 1) << letter;
    EXPECT_GE(box[1], 40 - 22) << letter;
    EXPECT_LE(box[3], 40 + 7) << letter;
    EXPECT_TRUE(seen.insert(picture.rgb).second) << letter << " looks like another";
  }
  EXPECT_EQ(internal::TextWidth("", 18), 0);
}

// The area that a disc, a ring and a line cover, against geometry's.
TEST(Canvas, CoversAsMuchAsGeometrySays) {
  const auto covered = [](const internal::Canvas& canvas) {
    double sum = 0;
    for (std::size_t i = 0; i < canvas.picture().rgb.size(); i += 3)
      sum += 1 - canvas.picture().rgb[i] / 255.0;
    return sum;
  };
  internal::Canvas disc(60, 60, {255, 255, 255});
  disc.Disc({30.3, 29.6}, 12.25, {0, 0, 0});
  EXPECT_NEAR(covered(disc), std::numbers::pi * 12.25 * 12.25, 2);
  internal::Canvas ring(60, 60, {255, 255, 255});
  ring.Ring({30, 30}, 15, 4, {0, 0, 0});
  EXPECT_NEAR(covered(ring), 2 * std::numbers::pi * 15 * 4, 2);
  internal::Canvas line(60, 60, {255, 255, 255});
  line.Line({10.5, 20}, {40.5, 20}, 3, {0, 0, 0});
  EXPECT_NEAR(covered(line), 30 * 3 + std::numbers::pi * 2.25, 1.5);
  internal::Canvas beyond(20, 20, {255, 255, 255});
  beyond.Line({-1e6, 10}, {1e6, 10}, 2, {0, 0, 0});
  EXPECT_NEAR(covered(beyond), 20 * 2, 0.5);
}

TEST(Resized, KeepsTheMeanAndEvenColours) {
  const auto mean = [](const Picture& picture) {
    double sum = 0;
    for (const std::uint8_t value : picture.rgb) sum += value;
    return sum / static_cast<double>(picture.rgb.size());
  };
  const Picture picture = Gradient(120, 90);
  for (const auto [width, height] : {std::pair(40, 30), std::pair(31, 77), std::pair(360, 270)}) {
    const Picture resized = internal::Resized(picture, width, height);
    ASSERT_EQ(resized.rgb.size(), static_cast<std::size_t>(3 * width * height));
    EXPECT_NEAR(mean(resized), mean(picture), 0.6);
    EXPECT_EQ(resized.rgb[2], 200);
  }
  EXPECT_EQ(internal::Resized(picture, 120, 90).rgb, picture.rgb);
}

TEST(CaptionLines, BreakBehindUnderscoresAndBlanksAndLoseNoLetter) {
  const auto at_most_ten = [](const std::string& line) { return line.size() <= 10; };
  using Lines = std::vector<std::string>;
  EXPECT_EQ(internal::CaptionLines("short", at_most_ten), Lines{"short"});
  EXPECT_EQ(internal::CaptionLines("four_panel_02__lever", at_most_ten),
            (Lines{"four_", "panel_02__", "lever"}));
  EXPECT_EQ(internal::CaptionLines("panel_0123__lever", at_most_ten),
            (Lines{"panel_", "0123__", "lever"}));
  EXPECT_EQ(internal::CaptionLines("it opens  the door", at_most_ten),
            (Lines{"it opens", "the door"}));
  EXPECT_EQ(internal::CaptionLines("abcdefghijklm", at_most_ten), (Lines{"abcdefghij", "klm"}));
  EXPECT_EQ(internal::CaptionLines("", at_most_ten), Lines{});
}

TEST(MaskPng, ComesBackAsItWasWrittenAndAlsoFromSixteenBits) {
  const PixelMask mask{3, 2, {1, 0, 0, 1, 1, 0}};
  const PixelMask back = DecodeMaskPng(EncodeMaskPng(mask), "mask");
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.set, mask.set);
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const DepthImage depth{3, 2, {0.3F, kNone, kNone, 0.001F, 60, kNone}, {}, {}};
  EXPECT_EQ(DecodeMaskPng(EncodeDepthPng(depth), "mask").set, mask.set);
}

// Height and width as the frame's header says (ITU-T T.81, B.2.2), found from marker to marker.
std::array<int, 2> FrameSizeOf(const std::string& jpeg) {
  const auto number = [&](std::size_t at) {
    return 256 * static_cast<unsigned char>(jpeg.at(at)) +
           static_cast<unsigned char>(jpeg.at(at + 1));
  };
  std::size_t at = 2;
  while (jpeg.at(at + 1) != '\xc0') at += 2 + static_cast<std::size_t>(number(at + 2));
  return {number(at + 5), number(at + 7)};
}

double MeanError(const std::string& jpeg, const Picture& picture) {
  jpeg_error_mgr errors{};
  jpeg_decompress_struct codec{};
  codec.err = ::jpeg_std_error(&errors);
  ::jpeg_create_decompress(&codec);
  ::jpeg_mem_src(&codec, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size());
  ::jpeg_read_header(&codec, TRUE);
  ::jpeg_start_decompress(&codec);
  std::vector<unsigned char> row(picture.rgb.size() / static_cast<std::size_t>(picture.height));
  double sum = 0;
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    JSAMPROW rows[1] = {row.data()};
    ::jpeg_read_scanlines(&codec, rows, 1);
    for (std::size_t i = 0; i < row.size(); ++i)
      sum += std::abs(row[i] - picture.rgb[y * row.size() + i]);
  }
  ::jpeg_finish_decompress(&codec);
  ::jpeg_destroy_decompress(&codec);
  return sum / static_cast<double>(picture.rgb.size());
}

TEST(Jpeg, HoldsThePictureAsWellAsItsQualitySays) {
  const Picture picture = Gradient(150, 70);
  const std::string fine = EncodeJpeg(picture, 95);
  const std::string coarse = EncodeJpeg(picture, 20);
  EXPECT_TRUE(fine.starts_with("\xff\xd8\xff"));
  EXPECT_TRUE(fine.ends_with("\xff\xd9"));
  EXPECT_EQ(FrameSizeOf(fine), (std::array{70, 150}));
  EXPECT_LT(MeanError(fine, picture), 2);
  EXPECT_GT(MeanError(coarse, picture), MeanError(fine, picture));
  EXPECT_LT(coarse.size(), fine.size());
  EXPECT_EQ(fine, EncodeJpeg(picture, 95));
  EXPECT_THROW(EncodeJpeg(picture, 0), Error);
  EXPECT_THROW(EncodeJpeg({2, 2, {1}}, 80), Error);
}

TEST(DecodePicture, ReadsWhatCamerasWriteInColours) {
  const Picture picture = Gradient(150, 70);
  EXPECT_EQ(DecodePicture(EncodePng(picture), "c.png").rgb, picture.rgb);
  const Picture lossy = DecodePicture(EncodeJpeg(picture, 95), "c.jpg");
  ASSERT_EQ(lossy.rgb.size(), picture.rgb.size());
  double sum = 0;
  for (std::size_t i = 0; i < lossy.rgb.size(); ++i) sum += std::abs(lossy.rgb[i] - picture.rgb[i]);
  EXPECT_NEAR(sum / static_cast<double>(lossy.rgb.size()),
              MeanError(EncodeJpeg(picture, 95), picture), 1e-9);
  const Picture grey =
      DecodePicture(EncodeDepthPng({2, 1, {0.512F, 65.5F}, {}, {}}), "sixteen bits of grey");
  EXPECT_EQ(grey.rgb, (std::vector<std::uint8_t>{2, 2, 2, 255, 255, 255}));
}

TEST(DecodePicture, RefusesWhatIsDamagedHugeOrNoPicture) {
  const auto refusal = [](const std::string& bytes) -> std::string {
    try {
      DecodePicture(bytes, "c");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      return error.what();
    }
    return "taken";
  };
  const std::string png = EncodePng(Gradient(150, 70));
  const std::string jpeg = EncodeJpeg(Gradient(150, 70));
  for (const std::string& sound : {png, jpeg}) {
    EXPECT_NE(refusal(sound.substr(0, sound.size() / 2)).find("damaged"), std::string::npos);
    EXPECT_NE(refusal(sound.substr(0, 12)), "taken");
  }
  EXPECT_EQ(refusal("text"), "c: is no PNG and no JPEG");
  std::string huge = png;
  huge[16] = '\x7f';  // the width's first byte
  EXPECT_NE(refusal(huge).find("8192"), std::string::npos);
}

TEST(DepthPng, ADamagedOneIsRefusedAndNoLibrarySpeaks) {
  DepthImage image{8, 6, std::vector<float>(48, 1.25F)};
  image.depth_m[7] = 2;
  const std::string sound = EncodeDepthPng(image);
  const std::vector<float> depth = DecodeDepthPng(sound, 0.001, "d.png").depth_m;
  testing::internal::CaptureStderr();
  std::size_t refused = 0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    std::string damaged = sound;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    try {
      EXPECT_EQ(DecodeDepthPng(damaged, 0.001, "d.png").depth_m, depth) << "byte " << i;
    } catch (const Error& error) {
      ++refused;
      EXPECT_TRUE(std::string(error.what()).starts_with("d.png: ")) << error.what();
    }
    EXPECT_THROW(DecodeDepthPng(sound.substr(0, i), 0.001, "d.png"), Error) << "cut at " << i;
  }
  EXPECT_GT(refused, sound.size() * 9 / 10);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(MaskPng, OtherPicturesAreRefused) {
  const Picture picture{2, 1, {1, 2, 3, 4, 5, 6}};
  EXPECT_THROW(DecodeMaskPng(EncodePng(picture), "mask"), Error) << "colours";
  EXPECT_THROW(DecodeMaskPng("text", "mask"), Error);
  EXPECT_THROW(EncodeMaskPng({2, 2, {1}}), Error);
  EXPECT_THROW(DecodeDepthPng(EncodeMaskPng({1, 1, {1}}), 0.001, "depth"), Error) << "8 bits";
}

}  // namespace
}  // namespace doorforge
