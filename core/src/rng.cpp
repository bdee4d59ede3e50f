// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/rng.h"

#include <cmath>
#include <numbers>

namespace doorforge {
namespace {

std::uint32_t High(std::uint64_t product) { return static_cast<std::uint32_t>(product >> 32); }
std::uint32_t Low(std::uint64_t product) { return static_cast<std::uint32_t>(product); }

// FNV-1a: names streams; Philox does the mixing
std::uint64_t HashName(std::string_view name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

}  // namespace

std::array<std::uint32_t, 4> Philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = 0xD2511F53ULL * counter[0];
    const std::uint64_t product1 = 0xCD9E8D57ULL * counter[2];
    counter = {High(product1) ^ counter[1] ^ key[0], Low(product1),
               High(product0) ^ counter[3] ^ key[1], Low(product0)};
    key[0] += 0x9E3779B9U;
    key[1] += 0xBB67AE85U;
  }
  return counter;
}

Rng::Rng(std::uint64_t seed, std::string_view stream) : key_{Low(seed), High(seed)} {
  const std::uint64_t name = HashName(stream);
  counter_ = {0, 0, Low(name), High(name)};
}

std::uint32_t Rng::NextUint32() {
  if (used_ == 4) {
    block_ = Philox4x32(counter_, key_);
    if (++counter_[0] == 0) ++counter_[1];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double Rng::Uniform() {
  const std::uint64_t high = NextUint32();
  const std::uint64_t low = NextUint32();
  return static_cast<double>(((high << 32) | low) >> 11) * 0x1.0p-53;
}

double Rng::Uniform(double low, double high) { return low + (high - low) * Uniform(); }

std::uint32_t Rng::Index(std::uint32_t count) {
  // reject the last incomplete cycle so that every index is equally likely
  const std::uint32_t limit = ~std::uint32_t{0} - (~std::uint32_t{0} % count + 1) % count;
  std::uint32_t value = NextUint32();
  while (value > limit) value = NextUint32();
  return value % count;
}

double Rng::Normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * Uniform());
}

}  // namespace doorforge
