// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The choice of grasp of a trained policy, 100 hands at each of 8 points of a made-up door's cloud
// of 4096 points, without picture and sampling:
//
//   grasp_throughput POLICY [repetitions]
//
// Prints the processor time of a choice, which other programs on the machine hardly change, and
// what was chosen, so that two builds can be compared.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include <time.h>  // NOLINT: clock_gettime is POSIX

#include "doorforge/policy/grasp_policy.h"

#include "door_cloud.h"

namespace doorforge {
namespace {

double ProcessorSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// What is within 10 cm of point 0 is the handle.
LabelledCloud ClosedDoor(std::uint64_t seed) {
  LabelledCloud cloud{testing::DoorCloud(seed, 0), {}};
  for (std::size_t i = 0; i < cloud.xyz.size(); i += 3) {
    const bool near = std::hypot(cloud.xyz[i] - cloud.xyz[0], cloud.xyz[i + 1] - cloud.xyz[1],
                                 cloud.xyz[i + 2] - cloud.xyz[2]) < 0.1F;
    cloud.label.push_back(
        static_cast<std::uint8_t>(near ? PointLabel::kHandle : PointLabel::kBody));
  }
  return cloud;
}

// The cloud with the point nearest to `start` in the place of its first.
LabelledCloud From(LabelledCloud cloud, const Eigen::Vector3d& start) {
  const Eigen::Map<const Eigen::Matrix3Xf> points(cloud.xyz.data(), 3,
                                                  static_cast<long>(cloud.label.size()));
  Eigen::Index first = 0;
  (points.colwise() - start.cast<float>()).colwise().squaredNorm().minCoeff(&first);
  for (std::size_t k = 0; k < 3; ++k)
    std::swap(cloud.xyz[k], cloud.xyz[3 * static_cast<std::size_t>(first) + k]);
  std::swap(cloud.label[0], cloud.label[static_cast<std::size_t>(first)]);
  return cloud;
}

int Run(const char* folder, int repetitions) {
  const auto policy = LoadGraspPolicy(folder);
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const LabelledCloud cloud = ClosedDoor(static_cast<std::uint64_t>(i % 5));
    const GraspObservation seen{
        .visible = cloud,
        .sample = [&](const Eigen::Vector3d& start, double) { return From(cloud, start); }};
    const double start = ProcessorSeconds();
    const std::optional<GraspAction> action = policy->Choose(seen);
    seconds.push_back(ProcessorSeconds() - start);
    if (i >= 5 || !action) continue;
    std::printf("door %d:", i);
    for (const double value : action->contact_m) std::printf(" %.9g", value);
    for (const double value : action->world_from_hand_rotation.reshaped())
      std::printf(" %.9g", value);
    std::printf(" %.9g\n", action->explanation->expected_opening_rad);
  }
  std::ranges::sort(seconds);
  std::printf("choice of grasp: median %.1f ms, 95 %% under %.1f ms (goal: 45)\n",
              1e3 * seconds[seconds.size() / 2], 1e3 * seconds[seconds.size() * 95 / 100]);
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: grasp_throughput POLICY [repetitions]\n"), 2;
  return doorforge::Run(argv[1], argc > 2 ? std::max(5, std::atoi(argv[2])) : 30);
}
