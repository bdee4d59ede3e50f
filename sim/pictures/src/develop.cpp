// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "develop.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace doorforge {
namespace {

constexpr std::uint32_t kSteps = 4096;   // of light from 0 to 1
constexpr std::uint32_t kBrightest = 4;  // what is brighter is white
constexpr std::size_t kStretch = 3072;   // values that are developed at a time, whole pixels

// Light above 0.8 is compressed towards 1 instead of being cut off.
double Compressed(double light) {
  constexpr double kKnee = 0.8;
  return light <= kKnee ? light
                        : kKnee + (1 - kKnee) * (1 - std::exp((kKnee - light) / (1 - kKnee)));
}

// The byte of each step of light.
const std::array<std::uint8_t, kBrightest * kSteps + 1>& ToneTable() {
  static const auto kTable = [] {
    std::array<std::uint8_t, kBrightest * kSteps + 1> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double c = Compressed(static_cast<double>(i) / kSteps);
      const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      table[i] = static_cast<std::uint8_t>(std::lround(255 * srgb));
    }
    return table;
  }();
  return kTable;
}

// One of three even numbers' sums, which is nearly a normal number; its spread is a half.
inline float Grain(std::uint32_t seed, std::uint32_t place) {
  std::uint32_t h = seed + place * 0x9E3779B1U;
  h ^= h >> 16;
  h *= 0x7FEB352DU;
  h ^= h >> 15;
  h *= 0x846CA68BU;
  h ^= h >> 16;
  const auto sum = static_cast<std::int32_t>((h & 1023U) + (h >> 10 & 1023U) + (h >> 20 & 1023U));
  return static_cast<float>(sum) * (1.0F / 1023) - 1.5F;
}

// Gives the same bits in either form: its arithmetic is the standard's.
__attribute__((target_clones("avx2", "default"))) void FindSteps(const float* light,
                                                                 const float* gain,
                                                                 std::size_t count,
                                                                 std::int32_t* steps) {
  for (std::size_t i = 0; i < count; ++i) {
    const float shown = std::min(std::max(light[i] * gain[i], 0.0F), float{kBrightest});
    steps[i] = static_cast<std::int32_t>(shown * kSteps + 0.5F);
  }
}

struct Noise {
  float spread = 0;
  std::uint32_t seed = 0;
  std::uint32_t first = 0;  // place of the first value
};

__attribute__((target_clones("avx2", "default"))) void AddNoise(const float* light,
                                                                const float* gain,
                                                                std::size_t count,
                                                                const Noise& noise, float* noisy) {
  const float spread = 2 * noise.spread;
  const std::uint32_t seed = noise.seed;
  const std::uint32_t first = noise.first;
  for (std::size_t i = 0; i < count; ++i) {
    const float value = light[i] * gain[i];
    const float grain = Grain(seed, first + static_cast<std::uint32_t>(i));
    noisy[i] = value + spread * grain * std::sqrt(std::max(value, 0.0F) + 0.02F);
  }
}

// It adds to each value a share of those `step` before and behind, where there are such.
__attribute__((target_clones("avx2", "default"))) void Spread(const float* from, std::size_t count,
                                                              std::size_t step,
                                                              std::array<float, 2> shares,
                                                              float* to) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = shares[0] * from[i + step] + shares[1] * (from[i] + from[i + 2 * step]);
}

}  // namespace

void BlurPicture(std::vector<LinearColor>& colors, int width, const Exposure& exposure) {
  const float side = std::exp(-0.5F / std::max(exposure.blur_px * exposure.blur_px, 1e-3F));
  const float middle = 1 / (1 + 2 * side);
  const std::array<float, 2> shares = {middle, middle * side};
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  const std::size_t height = colors.size() / static_cast<std::size_t>(width);
  float* const picture = colors.data()->data();

  // rows with their first and last pixel again beyond the edge
  std::vector<float> padded(row + 6);
  for (std::size_t y = 0; y < height; ++y) {
    float* const line = picture + y * row;
    std::copy_n(line, row, padded.begin() + 3);
    std::copy_n(line, 3, padded.begin());
    std::copy_n(line + row - 3, 3, padded.end() - 3);
    Spread(padded.data(), row, 3, shares, line);
  }
  std::vector<float> rows((height + 2) * row);
  std::copy_n(picture, height * row, rows.begin() + static_cast<std::ptrdiff_t>(row));
  std::copy_n(picture, row, rows.begin());
  std::copy_n(picture + (height - 1) * row, row, rows.end() - static_cast<std::ptrdiff_t>(row));
  Spread(rows.data(), height * row, row, shares, picture);
}

std::vector<std::uint8_t> DevelopPicture(const std::vector<LinearColor>& colors,
                                         const Exposure& exposure, std::uint32_t seed) {
  std::vector<std::uint8_t> rgb(3 * colors.size());
  std::array<float, kStretch> gain;
  for (std::size_t i = 0; i < kStretch; ++i)
    gain[i] = exposure.gain[static_cast<Eigen::Index>(i % 3)];
  std::array<float, kStretch> ones;
  ones.fill(1);
  std::array<float, kStretch> noisy;
  std::array<std::int32_t, kStretch> steps;
  const float* const light = colors.empty() ? nullptr : colors.data()->data();
  const auto& tone = ToneTable();
  for (std::size_t first = 0; first < rgb.size(); first += kStretch) {
    const std::size_t count = std::min(kStretch, rgb.size() - first);
    if (exposure.noise > 0) {
      const Noise noise = {exposure.noise, seed, static_cast<std::uint32_t>(first)};
      AddNoise(light + first, gain.data(), count, noise, noisy.data());
      FindSteps(noisy.data(), ones.data(), count, steps.data());
    } else {
      FindSteps(light + first, gain.data(), count, steps.data());
    }
    for (std::size_t i = 0; i < count; ++i)
      rgb[first + i] = tone[static_cast<std::size_t>(steps[i])];
  }
  return rgb;
}

}  // namespace doorforge
