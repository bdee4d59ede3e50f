// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/farthest_point_sampling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr std::size_t kWidest = 16;     // floats in the widest vector
constexpr std::size_t kLeafSize = 512;  // points in a box at most
constexpr float kUntouched = std::numeric_limits<float>::infinity();
constexpr float kTaken = -1;  // smaller than any squared distance

template <class T>
struct VectorAllocator {
  using value_type = T;
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64}));
  }
  void deallocate(T* pointer, std::size_t) { ::operator delete (pointer, std::align_val_t{64}); }
  bool operator==(const VectorAllocator&) const { return true; }
};
template <class T>
using Aligned = std::vector<T, VectorAllocator<T>>;

// A point with its index's bits in the fourth lane: moved and compared as one vector.
using Quad [[gnu::vector_size(16)]] = float;

std::int32_t IndexOf(const Quad& point) { return std::bit_cast<std::int32_t>(float{point[3]}); }

// Points in boxes. Slots of a box are contiguous, in ascending order of the points' indices, and
// padded with taken points to whole vectors.
struct Boxes {
  Aligned<float> x, y, z;
  Aligned<float> distance;            // squared, to the nearest taken point
  std::vector<std::int32_t> index;    // of the slot's point
  std::vector<std::int32_t> slot_of;  // of the point with this index
  std::vector<std::int32_t> box_of;   // of the point with this index

  // one entry a box, padded to whole vectors with boxes that are never visited
  Aligned<float> low[3], high[3];
  Aligned<float> farthest;               // largest distance in the box
  Aligned<std::int32_t> farthest_index;  // lowest index with that distance
  std::vector<std::int32_t> first_slot, end_slot;
};

std::size_t RoundUp(std::size_t count) { return (count + kWidest - 1) / kWidest * kWidest; }

// Splits points into boxes by sampled medians of the widest axis. Partitions are stable, which
// keeps indices ascending within each box.
class BoxBuilder {
 public:
  explicit BoxBuilder(std::span<const float> xyz)
      : points_(xyz.size() / 3), spare_(points_.size()) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i] = Quad{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2],
                        std::bit_cast<float>(static_cast<std::int32_t>(i))};
    }
    const std::size_t slots = points_.size() + points_.size() / 8;  // with room for padding
    for (auto* column : {&boxes_.x, &boxes_.y, &boxes_.z, &boxes_.distance}) column->reserve(slots);
    boxes_.index.reserve(slots);
    boxes_.slot_of.resize(points_.size());
    boxes_.box_of.resize(points_.size());
    Split(points_);
    Pad();
  }

  Boxes Take() { return std::move(boxes_); }

 private:
  struct Corners {
    Quad low;
    Quad high;  // the fourth lanes mean nothing
  };

  static Corners CornersOf(std::span<const Quad> points) {
    Corners corners{points[0], points[0]};
    for (const Quad& point : points) {
      corners.low = point < corners.low ? point : corners.low;
      corners.high = point > corners.high ? point : corners.high;
    }
    return corners;
  }

  static float SampledMedian(std::span<const Quad> points, int axis) {
    std::array<float, 33> sample{};
    for (std::size_t i = 0; i < sample.size(); ++i)
      sample[i] = points[i * points.size() / sample.size()][axis];
    std::nth_element(sample.begin(), sample.begin() + 16, sample.end());
    return sample[16];
  }

  std::size_t Partition(std::span<Quad> points, int axis, float pivot) {
    std::size_t low = 0;
    std::size_t high = 0;
    for (const Quad point : points) {
      const bool is_low = point[axis] < pivot;
      points[low] = point;  // in place is safe: low never overtakes the read position
      spare_[high] = point;
      low += is_low ? 1 : 0;
      high += is_low ? 0 : 1;
    }
    std::copy_n(spare_.begin(), high, points.begin() + static_cast<std::ptrdiff_t>(low));
    return low;
  }

  void Split(std::span<Quad> points) {
    const Corners corners = CornersOf(points);
    if (points.size() <= kLeafSize) return AddBox(points, corners);
    const Quad extent = corners.high - corners.low;
    int axis = extent[1] > extent[0] ? 1 : 0;
    axis = extent[2] > extent[axis] ? 2 : axis;
    std::size_t low = Partition(points, axis, SampledMedian(points, axis));
    // many equal coordinates: any split is correct, halves bound the depth
    if (std::min(low, points.size() - low) < points.size() / 16) {
      std::sort(points.begin(), points.end(),
                [](const Quad& a, const Quad& b) { return IndexOf(a) < IndexOf(b); });
      low = points.size() / 2;
    }
    Split(points.first(low));
    Split(points.subspan(low));
  }

  void AddSlot(const Quad& point, float distance) {
    boxes_.x.push_back(point[0]);
    boxes_.y.push_back(point[1]);
    boxes_.z.push_back(point[2]);
    boxes_.distance.push_back(distance);
    boxes_.index.push_back(IndexOf(point));
  }

  void AddBox(std::span<const Quad> points, const Corners& corners) {
    boxes_.first_slot.push_back(static_cast<std::int32_t>(boxes_.index.size()));
    for (const Quad& point : points) {
      const auto index = static_cast<std::size_t>(IndexOf(point));
      boxes_.slot_of[index] = static_cast<std::int32_t>(boxes_.index.size());
      boxes_.box_of[index] = static_cast<std::int32_t>(boxes_.farthest.size());
      AddSlot(point, kUntouched);
    }
    while (boxes_.index.size() % kWidest != 0) AddSlot(points.back(), kTaken);
    boxes_.end_slot.push_back(static_cast<std::int32_t>(boxes_.index.size()));
    for (int axis = 0; axis < 3; ++axis) {
      boxes_.low[axis].push_back(corners.low[axis]);
      boxes_.high[axis].push_back(corners.high[axis]);
    }
    boxes_.farthest.push_back(kUntouched);
    boxes_.farthest_index.push_back(IndexOf(points[0]));
  }

  void Pad() {
    const std::size_t count = RoundUp(boxes_.farthest.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes_.low[axis].resize(count, 0);
      boxes_.high[axis].resize(count, 0);
    }
    boxes_.farthest.resize(count, kTaken);
    boxes_.farthest_index.resize(count, std::numeric_limits<std::int32_t>::max());
  }

  Aligned<Quad> points_;
  Aligned<Quad> spare_;
  Boxes boxes_;
};

// The kernels are written once with GCC's vector types of kLanes floats and inlined into one
// wrapper for each instruction set. All take the same decisions, since each lane does the same
// operations in the same order; only how many lanes there are differs.
template <int kLanes>
struct Vector {
  using Float [[gnu::vector_size(kLanes * 4)]] = float;
  using Int [[gnu::vector_size(kLanes * 4)]] = std::int32_t;
  using Byte [[gnu::vector_size(kLanes)]] = std::int8_t;
};

alignas(64) constexpr std::int32_t kLaneNumbers[kWidest] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                            8, 9, 10, 11, 12, 13, 14, 15};

// It takes a reference, since passing wide vectors by value has no portable convention.
template <int kLanes>
[[gnu::always_inline]] inline void Load(typename Vector<kLanes>::Float& vector, const float* from) {
  vector = *reinterpret_cast<const typename Vector<kLanes>::Float*>(from);
}

// Moves the value of lane i ^ kStep into lane i.
template <int kLanes, int kStep, class Any>
[[gnu::always_inline]] inline void SwapLanes(Any& to, const Any& from) {
#if defined(__clang__)
  for (int lane = 0; lane < kLanes; ++lane) to[lane] = from[lane ^ kStep];
#else
  typename Vector<kLanes>::Int partner;
  for (int lane = 0; lane < kLanes; ++lane) partner[lane] = lane ^ kStep;
  to = __builtin_shuffle(from, partner);
#endif
}

// Puts the largest (smallest) value into all lanes, in halving steps.
template <int kLanes, int kStep = kLanes / 2>
[[gnu::always_inline]] inline void ReduceMax(typename Vector<kLanes>::Float& value) {
  typename Vector<kLanes>::Float other;
  SwapLanes<kLanes, kStep>(other, value);
  value = value > other ? value : other;
  if constexpr (kStep > 1) ReduceMax<kLanes, kStep / 2>(value);
}

template <int kLanes, int kStep = kLanes / 2>
[[gnu::always_inline]] inline void ReduceMin(typename Vector<kLanes>::Int& value) {
  typename Vector<kLanes>::Int other;
  SwapLanes<kLanes, kStep>(other, value);
  value = value < other ? value : other;
  if constexpr (kStep > 1) ReduceMin<kLanes, kStep / 2>(value);
}

struct Point {
  float x, y, z;
};

// Lowers the box's distances by those to `point`; updates its farthest point.
template <int kLanes>
[[gnu::always_inline]] inline void VisitBox(Boxes& boxes, std::size_t box, const Point& point) {
  using Float = typename Vector<kLanes>::Float;
  using Int = typename Vector<kLanes>::Int;
  Float best = Float{} + kTaken;
  Int best_slot = Int{} + boxes.first_slot[box];
  Int slot = *reinterpret_cast<const Int*>(kLaneNumbers) + boxes.first_slot[box];
  for (std::int32_t i = boxes.first_slot[box]; i < boxes.end_slot[box]; i += kLanes) {
    Float x, y, z, old;
    Load<kLanes>(x, &boxes.x[static_cast<std::size_t>(i)]);
    Load<kLanes>(y, &boxes.y[static_cast<std::size_t>(i)]);
    Load<kLanes>(z, &boxes.z[static_cast<std::size_t>(i)]);
    Load<kLanes>(old, &boxes.distance[static_cast<std::size_t>(i)]);
    x -= point.x;
    y -= point.y;
    z -= point.z;
    const Float squared = (x * x + y * y) + z * z;
    const Float now = squared < old ? squared : old;
    *reinterpret_cast<Float*>(&boxes.distance[static_cast<std::size_t>(i)]) = now;
    const Int farther = now > best;
    best = farther ? now : best;
    best_slot = farther ? slot : best_slot;
    slot += kLanes;
  }
  // slots ascend with indices, so the lowest slot among equals is the lowest index
  Float farthest = best;
  ReduceMax<kLanes>(farthest);
  Int lowest = best == farthest ? best_slot : Int{} + std::numeric_limits<std::int32_t>::max();
  ReduceMin<kLanes>(lowest);
  boxes.farthest[box] = farthest[0];
  boxes.farthest_index[box] = boxes.index[static_cast<std::size_t>(lowest[0])];
}

// Visits those of the kLanes boxes from `first` whose points the new one could be nearest to. The
// bound is safe in floating point too: rounding is monotonic, and bound and distance are sums of
// the same form, so bound <= distance holds for the computed values.
template <int kLanes>
[[gnu::always_inline]] inline void VisitNearBoxes(Boxes& boxes, std::size_t first,
                                                  const Point& point) {
  using Float = typename Vector<kLanes>::Float;
  using Byte = typename Vector<kLanes>::Byte;
  const float position[3] = {point.x, point.y, point.z};
  Float gap[3];
  for (int axis = 0; axis < 3; ++axis) {
    Float low, high;
    Load<kLanes>(low, &boxes.low[axis][first]);
    Load<kLanes>(high, &boxes.high[axis][first]);
    low = low - position[axis];
    high = position[axis] - high;
    gap[axis] = low > high ? low : high;
    gap[axis] = gap[axis] > 0.0F ? gap[axis] : Float{};
  }
  const Float bound = (gap[0] * gap[0] + gap[1] * gap[1]) + gap[2] * gap[2];
  Float farthest;
  Load<kLanes>(farthest, &boxes.farthest[first]);
  const Byte near = __builtin_convertvector(bound < farthest, Byte);
  for (int chunk = 0; chunk < kLanes; chunk += 8) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, reinterpret_cast<const char*>(&near) + chunk, std::min(kLanes, 8));
    while (bits != 0) {
      const int lane = std::countr_zero(bits) / 8;
      bits &= ~(0xFFULL << (8 * lane));
      VisitBox<kLanes>(boxes, first + static_cast<std::size_t>(chunk + lane), point);
    }
  }
}

// Index of the farthest point of all boxes, the lowest among equals.
template <int kLanes>
[[gnu::always_inline]] inline std::int32_t FarthestPoint(const Boxes& boxes) {
  using Float = typename Vector<kLanes>::Float;
  using Int = typename Vector<kLanes>::Int;
  Float best = Float{} + kTaken;
  Int best_index = Int{} + std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = 0; i < boxes.farthest.size(); i += kLanes) {
    Float distance;
    Load<kLanes>(distance, &boxes.farthest[i]);
    const Int index = *reinterpret_cast<const Int*>(&boxes.farthest_index[i]);
    const Int lower = index < best_index ? index : best_index;
    best_index = distance == best ? lower : best_index;
    best_index = distance > best ? index : best_index;
    best = distance > best ? distance : best;
  }
  Float farthest = best;
  ReduceMax<kLanes>(farthest);
  Int lowest = best == farthest ? best_index : Int{} + std::numeric_limits<std::int32_t>::max();
  ReduceMin<kLanes>(lowest);
  return lowest[0];
}

template <int kLanes>
[[gnu::always_inline]] inline void SampleBoxes(Boxes& boxes, std::vector<std::int32_t>& taken) {
  for (std::size_t i = 0; i + 1 < taken.size(); ++i) {
    const auto slot = static_cast<std::size_t>(boxes.slot_of[static_cast<std::size_t>(taken[i])]);
    const auto box = static_cast<std::size_t>(boxes.box_of[static_cast<std::size_t>(taken[i])]);
    boxes.distance[slot] = kTaken;
    boxes.farthest[box] = kUntouched;  // its farthest point may be gone: look again in any case
    const Point point = {boxes.x[slot], boxes.y[slot], boxes.z[slot]};
    for (std::size_t first = 0; first < boxes.farthest.size(); first += kLanes)
      VisitNearBoxes<kLanes>(boxes, first, point);
    taken[i + 1] = FarthestPoint<kLanes>(boxes);
  }
}

using Sampler = void (*)(Boxes&, std::vector<std::int32_t>&);

void SampleBaseline(Boxes& boxes, std::vector<std::int32_t>& taken) {
  SampleBoxes<4>(boxes, taken);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void SampleAvx2(Boxes& boxes, std::vector<std::int32_t>& taken) {
  SampleBoxes<8>(boxes, taken);
}

__attribute__((target("avx512f,avx512bw,avx512dq,avx512vl"))) void SampleAvx512(
    Boxes& boxes, std::vector<std::int32_t>& taken) {
  SampleBoxes<16>(boxes, taken);
}
#endif

bool Supports(SimdLevel level) {
#if defined(__x86_64__)
  if (level == SimdLevel::kAvx2) return __builtin_cpu_supports("avx2") != 0;
  if (level == SimdLevel::kAvx512)
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
           __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#endif
  return level == SimdLevel::kBaseline;
}

Sampler SamplerOf(SimdLevel level) {
  Require(Supports(level), ErrorCode::kInvalidArgument,
          "farthest point sampling: this processor does not have the requested vector level");
#if defined(__x86_64__)
  if (level == SimdLevel::kAvx2) return SampleAvx2;
  if (level == SimdLevel::kAvx512) return SampleAvx512;
#endif
  return SampleBaseline;
}

}  // namespace

SimdLevel BestSimdLevel() {
  for (const SimdLevel level : {SimdLevel::kAvx512, SimdLevel::kAvx2}) {
    if (Supports(level)) return level;
  }
  return SimdLevel::kBaseline;
}

std::vector<std::int32_t> FarthestPoints(std::span<const float> xyz, int count, int start,
                                         SimdLevel level) {
  const std::size_t size = xyz.size() / 3;
  const bool valid = xyz.size() % 3 == 0 && std::in_range<std::int32_t>(xyz.size()) && count >= 1 &&
                     std::cmp_less_equal(count, size) && start >= 0 && std::cmp_less(start, size);
  Require(valid, ErrorCode::kInvalidArgument,
          "farthest point sampling: needs N x 3 numbers, 1 <= count <= N, 0 <= start < N");
  Require(std::all_of(xyz.begin(), xyz.end(), [](float c) { return std::fabs(c) < 1e15F; }),
          ErrorCode::kInvalidArgument, "farthest point sampling: a coordinate is not below 1e15");
  const Sampler sampler = SamplerOf(level);
  Boxes boxes = BoxBuilder(xyz).Take();
  std::vector<std::int32_t> taken(static_cast<std::size_t>(count));
  taken[0] = start;
  sampler(boxes, taken);
  return taken;
}

}  // namespace doorforge
