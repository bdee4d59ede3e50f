// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "light_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "doorforge/sensor/ray_packet.h"

namespace doorforge {
namespace {

constexpr int kBlock = 4;            // pixels a side that share what they find
constexpr int kGroup = kPixelGroup;  // pixels a side of which a quarter looks first
constexpr std::size_t kPlaceCount = 16;
constexpr std::size_t kAroundCount =
    8;  // places of the surroundings, which every other pixel looks for
constexpr float kAroundReach = 0.8F;  // [m] what is farther keeps no light out of a corner
constexpr float kFullTurn = 6.2831853F;
constexpr std::size_t kAround = LightShares::kAround;

// Pixel i of a block looks for place kPlaces[i]: neighbours look far apart.
constexpr std::array<std::size_t, kPlaceCount> kPlaces = {0, 8,  2, 10, 12, 4, 14, 6,
                                                          3, 11, 1, 9,  15, 7, 13, 5};
constexpr std::array<std::size_t, kPlaceCount> kAroundPlaces = {0, 0, 5, 0, 0, 2, 0, 7,
                                                                6, 0, 3, 0, 0, 4, 0, 1};

// Four pixels of a block, spread over it. Packet p of a group takes set (t + p) % 4 of its block t,
// so that each packet has all 16 places and all four together have all pixels. Around look the sets
// 0 and 3 alone, which are those of a chequered pattern.
constexpr std::array<std::array<int, 4>, 4> kQuarters = {
    {{0, 2, 8, 10}, {1, 3, 9, 11}, {4, 6, 12, 14}, {5, 7, 13, 15}}};
constexpr std::array<std::size_t, 2> kAroundQuarters = {0, 3};

// A place on the unit disc, of `count` that cover it evenly in rings of four.
Eigen::Vector2f OnDisc(std::size_t place, std::size_t count) {
  const auto ring = static_cast<float>(place / 4);
  const auto rings = static_cast<float>(count / 4);
  const float radius = std::sqrt((ring + 0.5F) / rings);
  const float angle = kFullTurn * (static_cast<float>(place % 4) + ring / rings) / 4;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

template <std::size_t kCount>
const std::array<Eigen::Vector2f, kCount>& Disc() {
  static const std::array<Eigen::Vector2f, kCount> kDisc = [] {
    std::array<Eigen::Vector2f, kCount> disc;
    for (std::size_t place = 0; place < kCount; ++place) disc[place] = OnDisc(place, kCount);
    return disc;
  }();
  return kDisc;
}

Eigen::Vector3f AcrossOf(const Eigen::Vector3f& axis) {
  const Eigen::Vector3f helper =
      std::fabs(axis.x()) < 0.6F ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY();
  return axis.cross(helper).normalized();
}

// A pixel that looks, and its place in its block, which says what it looks for.
struct Looker {
  std::size_t pixel = 0;
  std::size_t in_block = 0;
  bool is_there = false;  // groups reach beyond the picture's edge
};
using Lookers = std::array<Looker, RayPacket::kSize>;
// What each of them finds.
using Found = std::array<std::uint32_t, RayPacket::kSize>;

class LightSampler {
 public:
  LightSampler(const LitScene& scene, const PointImage& image)
      : scene_(scene), image_(image), bounds_(BoundsOf(scene.geometry)) {}

  void Sample(int rounds, std::vector<LightShares>& shares) const {
    for (std::size_t round = 0; round < static_cast<std::size_t>(rounds); ++round) {
      for (int top = 0; top < image_.height; top += kGroup) {
        for (int left = 0; left < image_.width; left += kGroup)
          if (image_.IsWanted(left, top)) SampleGroup(left, top, round, shares);
      }
    }
  }

 private:
  // They are the pixels of one set in each of the four blocks.
  Lookers LookersOf(int left, int top, const std::array<std::size_t, 4>& quarters) const {
    Lookers lookers;
    for (std::size_t slot = 0; slot < lookers.size(); ++slot) {
      const std::size_t block = slot / 4;
      const int in_block = kQuarters[quarters[block]][slot % 4];
      const int column = left + kBlock * static_cast<int>(block % 2) + in_block % kBlock;
      const int row = top + kBlock * static_cast<int>(block / 2) + in_block / kBlock;
      if (column >= image_.width || row >= image_.height) continue;
      lookers[slot] = {image_.At(column, row), static_cast<std::size_t>(in_block), true};
    }
    return lookers;
  }

  void SampleGroup(int left, int top, std::size_t round, std::vector<LightShares>& shares) const {
    std::array<Lookers, 4> lookers;
    for (std::size_t packet = 0; packet < lookers.size(); ++packet)
      lookers[packet] =
          LookersOf(left, top, {packet, (packet + 1) % 4, (packet + 2) % 4, (packet + 3) % 4});
    const bool one_surface = SeesOneSurface(left, top);
    const std::size_t lamps = std::max<std::size_t>(1, scene_.appearance.lamps.size());
    for (std::size_t lamp = 0; lamp < lamps; ++lamp)
      Count(
          lookers, one_surface, lamp,
          [&](const Lookers& some) { return FindLamp(some, lamp, round); }, shares);
    std::array<Lookers, 2> around;
    for (std::size_t packet = 0; packet < around.size(); ++packet) {
      const std::size_t quarter = kAroundQuarters[packet];
      around[packet] = LookersOf(left, top, {quarter, quarter, quarter, quarter});
    }
    Count(
        around, one_surface, kAround, [&](const Lookers& some) { return FindAround(some, round); },
        shares);
  }

  // The first packet answers for the others where all of it find the same on one surface.
  template <std::size_t kPackets, class Find>
  void Count(const std::array<Lookers, kPackets>& lookers, bool one_surface, std::size_t light,
             const Find& find, std::vector<LightShares>& shares) const {
    const Found first = find(lookers[0]);
    const bool agree =
        one_surface && std::all_of(first.begin(), first.end(),
                                   [&](std::uint32_t count) { return count == first[0]; });
    for (std::size_t packet = 0; packet < kPackets; ++packet) {
      const Found found = packet == 0 || agree ? first : find(lookers[packet]);
      for (std::size_t slot = 0; slot < found.size(); ++slot) {
        if (found[slot] != 0) shares[lookers[packet][slot].pixel].Add(light, found[slot]);
      }
    }
  }

  bool SeesOneSurface(int left, int top) const {
    if (left + kGroup > image_.width || top + kGroup > image_.height) return false;
    std::uint32_t seams = 0;
    for (int row = top; row < top + kGroup; ++row) {
      for (int column = left; column < left + kGroup; ++column)
        seams |= image_.seams[image_.At(column, row)];
    }
    return seams == 0;
  }

  // 1: nothing is between the looker and its place of the lamp.
  Found FindLamp(const Lookers& lookers, std::size_t lamp, std::size_t round) const {
    RayPacket packet;
    for (std::size_t slot = 0; slot < lookers.size(); ++slot) {
      if (!lookers[slot].is_there) continue;
      const SeenPoint& point = image_.points[lookers[slot].pixel];
      const std::span<const Lamp> lamps = scene_.LampsAt(point);
      if (lamp >= lamps.size()) continue;
      const Eigen::Vector2f& on_disc =
          Disc<kPlaceCount>()[(kPlaces[lookers[slot].in_block] + 5 * round) % kPlaceCount];
      const Eigen::Vector3f origin = point.position + kSkin * point.face;
      const Eigen::Vector3f to_lamp =
          lamps[lamp].position_m +
          lamps[lamp].radius_m * Eigen::Vector3f(on_disc.x(), on_disc.y(), 0) - origin;
      if (to_lamp.dot(point.normal) > 0 && to_lamp.dot(point.face) > 0 &&
          !scene_.room.Blocks(origin, to_lamp, 1))
        packet.Set(slot, origin, to_lamp, 1);
    }
    Found found{};
    if (packet.rays == 0) return found;
    const std::uint32_t free = packet.rays & ~ObstructedRays(scene_.geometry, packet);
    for (std::size_t slot = 0; slot < found.size(); ++slot) found[slot] = free >> slot & 1U;
    return found;
  }

  // What is nearer keeps the more light out.
  Found FindAround(const Lookers& lookers, std::size_t round) const {
    RayPacket packet;
    std::array<float, RayPacket::kSize> nearest{};
    for (std::size_t slot = 0; slot < lookers.size(); ++slot) {
      if (!lookers[slot].is_there) continue;
      const SeenPoint& point = image_.points[lookers[slot].pixel];
      const Eigen::Vector2f& on_disc =
          Disc<kAroundCount>()[(kAroundPlaces[lookers[slot].in_block] + 3 * round) % kAroundCount];
      const Eigen::Vector3f origin = point.position + kSkin * point.face;
      const Eigen::Vector3f across = AcrossOf(point.normal);
      const Eigen::Vector3f around =
          on_disc.x() * across + on_disc.y() * point.normal.cross(across) +
          std::sqrt(std::max(0.0F, 1 - on_disc.squaredNorm())) * point.normal;
      nearest[slot] = kAroundReach;
      if (scene_.room.IsWithin(origin, around, kAroundReach))
        nearest[slot] = std::min(kAroundReach, scene_.room.Meet(origin, around).distance);
      if (bounds_.squaredExteriorDistance(origin) < nearest[slot] * nearest[slot])
        packet.Set(slot, origin, around, nearest[slot]);
    }
    const PacketHits hits = packet.rays == 0 ? PacketHits{} : CastRays(scene_.geometry, packet);
    Found found{};
    for (std::size_t slot = 0; slot < found.size(); ++slot) {
      const bool hit = (hits.hits >> slot & 1U) != 0;
      const float share = (hit ? hits.distance[slot] : nearest[slot]) / kAroundReach;
      found[slot] = static_cast<std::uint32_t>(
          std::lround(share * share * static_cast<float>(LightShares::kAroundUnit)));
    }
    return found;
  }

  const LitScene& scene_;
  const PointImage& image_;
  Eigen::AlignedBox3f bounds_;  // of what has meshes
};

// Sums over the blocks that begin at each pixel, of counts and of seams; a seam is within a block
// if both of its pixels are.
class BlockSums {
 public:
  BlockSums(const PointImage& image, const std::vector<LightShares>& found)
      : counts_(found.size()), seams_(found.size()) {
    const std::size_t count = found.size();
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint64_t> across(count);
    std::vector<std::uint8_t> across_seams(count);
    for (std::size_t i = 0; i + 3 < count; ++i) {
      across[i] =
          found[i].packed() + found[i + 1].packed() + found[i + 2].packed() + found[i + 3].packed();
      const auto any = image.seams[i] | image.seams[i + 1] | image.seams[i + 2];
      across_seams[i] = static_cast<std::uint8_t>(any | (image.seams[i + 3] & kBelow));
    }
    for (std::size_t i = 0; i + 3 * width + 3 < count; ++i) {
      counts_[i] = across[i] + across[i + width] + across[i + 2 * width] + across[i + 3 * width];
      const auto any = across_seams[i] | across_seams[i + width] | across_seams[i + 2 * width];
      seams_[i] = static_cast<std::uint8_t>(any | (across_seams[i + 3 * width] & kRight));
    }
  }

  bool IsOneSurface(std::size_t block) const { return seams_[block] == 0; }
  LightShares CountsOf(std::size_t block) const {
    LightShares counts(counts_[block]);
    counts.Add(kAround, counts.Of(kAround));  // half of the pixels have looked
    return counts;
  }

 private:
  static constexpr std::uint8_t kRight = 1;
  static constexpr std::uint8_t kBelow = 2;
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint8_t> seams_;
};

bool LooksAround(int column, int row) { return (column + row) % 2 == 0; }

std::uint32_t OfPlaces(std::uint32_t sum, std::uint32_t count) {
  return (sum * std::uint32_t{kPlaceCount} + count / 2) / count;
}

// What the pixels of the block have found that see the same as this one. Where none of them has
// looked around, the block's others say how much comes from there.
LightShares SharesOfSame(const PointImage& image, const std::vector<LightShares>& found,
                         std::size_t pixel, int left, int top) {
  const SeenPoint& point = image.points[pixel];
  std::array<std::uint64_t, 2> sums{};  // of all, and of the pixels that see the same
  std::array<std::uint32_t, 2> around{};
  std::uint32_t count = 0;
  for (int y = top; y < std::min(top + kBlock, image.height); ++y) {
    for (int x = left; x < std::min(left + kBlock, image.width); ++x) {
      const std::size_t i = image.At(x, y);
      const SeenPoint& other = image.points[i];
      const bool same = other.part == point.part && other.normal.dot(point.normal) >= kSameNormal &&
                        std::fabs((other.position - point.position).dot(point.face)) <= kSamePlane;
      for (std::size_t which = 0; which < (same ? 2U : 1U); ++which) {
        sums[which] += found[i].packed();
        around[which] += LooksAround(x, y) ? 1U : 0U;
      }
      count += same ? 1U : 0U;
    }
  }
  LightShares shares;
  for (std::size_t lamp = 0; lamp < kMostLamps && count > 0; ++lamp)
    shares.Add(lamp, OfPlaces(LightShares(sums[1]).Of(lamp), count));
  const std::size_t which = around[1] > 0 ? 1 : 0;
  if (around[which] > 0)
    shares.Add(kAround, OfPlaces(LightShares(sums[which]).Of(kAround), around[which]));
  return shares;
}

}  // namespace

// Any block of 4 x 4 holds all 16 places.
std::vector<LightShares> ShareLight(const LitScene& scene, const PointImage& image, int rounds) {
  std::vector<LightShares> found(image.points.size());
  LightSampler(scene, image).Sample(rounds, found);
  const BlockSums sums(image, found);
  std::vector<LightShares> shares(found.size());
  for (int row = 0; row < image.height; ++row) {
    const int top = std::clamp(row - 1, 0, std::max(0, image.height - kBlock));
    for (int column = 0; column < image.width; ++column) {
      if (!image.IsWanted(column, row)) continue;
      const int left = std::clamp(column - 1, 0, std::max(0, image.width - kBlock));
      const std::size_t pixel = image.At(column, row);
      const bool whole =
          image.width >= kBlock && image.height >= kBlock && sums.IsOneSurface(image.At(left, top));
      shares[pixel] =
          whole ? sums.CountsOf(image.At(left, top)) : SharesOfSame(image, found, pixel, left, top);
    }
  }
  return shares;
}

}  // namespace doorforge
