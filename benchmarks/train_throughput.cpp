// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Forward and backward pass of the PointNet++ encoder, samples per second of one core, against the
// same network in stock libtorch operators in the same run. Processor time, best of several; point
// geometry is left out on both sides (it is found once per cloud) and timed apart; the last column
// finds it anew for every sample. Both networks minimise the same loss, which is compared.
//
//   train_throughput [repetitions]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <malloc.h>
#include <time.h>

#include "doorforge/networks/point_encoder.h"
#include "doorforge/training/linear_algebra.h"

#include "door_cloud.h"
#include "reference_network.h"

namespace doorforge {
namespace {

constexpr std::array<float, 3> kCentre = {0.1F, 0.0F, 1.0F};
constexpr std::size_t kBatch = 8;

double ProcessorSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double BestSeconds(int repetitions, const Work& work) {
  double best = 1e9;
  for (int i = 0; i < repetitions; ++i) {
    const double start = ProcessorSeconds();
    work();
    best = std::min(best, ProcessorSeconds() - start);
  }
  return best;
}

// Keeps freed tensors in the process: 30 % faster than glibc's default, and so the fairer peer.
void TuneMalloc() {
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
  ::mallopt(M_TOP_PAD, 256 << 20);
}

struct Network {
  ParameterLayout layout;
  std::vector<float> parameters;
  std::vector<std::vector<float>> clouds;

  Network() {
    AddEncoderLayers("", layout);
    parameters = HeInitialisation(layout, 1, "");
    for (std::size_t i = 0; i < kBatch; ++i)
      clouds.push_back(testing::DoorCloud(i, 0.1 * static_cast<double>(i)));
  }
};

// What both minimise: sum(weight * features), whose gradient to the features is the weight.
constexpr float kWeight = 0.01F;

struct Measured {
  double rate = 0;  // samples per second
  double loss = 0;  // mean of the clouds
};

double Loss(std::span<const float> features) {
  double sum = 0;
  for (const float feature : features) sum += kWeight * static_cast<double>(feature);
  return sum / kBatch;
}

Measured MeasureStock(const Network& network, int repetitions) {
  testing::ReferenceNetwork stock(network.layout, network.parameters, network.clouds, kCentre,
                                  testing::Precision::kSingle);
  const std::vector<float> wanted(kBatch * kCloudPoints * kFeatureSize, kWeight);
  const double loss = Loss(stock.Run(wanted).features);
  const double seconds = BestSeconds(std::max(2, repetitions / 4), [&] { stock.Run(wanted); });
  return {kBatch / seconds, loss};
}

Measured MeasureFused(const Network& network, InstructionSet set, bool all_points,
                      int repetitions) {
  std::vector<std::uint16_t> outputs(all_points ? kCloudPoints : 1);
  std::iota(outputs.begin(), outputs.end(), std::uint16_t{0});
  const std::vector<float> wanted(outputs.size() * kFeatureSize, kWeight);
  const PointEncoder encoder(network.layout, "", network.parameters, set);
  std::vector<float> gradient(network.parameters.size());
  double seconds = 0;
  Measured measured;
  PointEncoder::Trace trace;
  for (const std::vector<float>& cloud : network.clouds) {
    const CloudGeometry geometry = BuildGeometry(cloud, {kCentre}, outputs, set);
    seconds += BestSeconds(repetitions, [&] {
      trace = encoder.Forward(geometry, std::move(trace));
      encoder.AddGradient(geometry, trace, wanted, gradient);
    });
    measured.loss += Loss(trace.features);
  }
  measured.rate = kBatch / seconds;
  return measured;
}

double GeometrySeconds(const Network& network, InstructionSet set, bool all_points,
                       int repetitions) {
  std::vector<std::uint16_t> outputs(all_points ? kCloudPoints : 1);
  std::iota(outputs.begin(), outputs.end(), std::uint16_t{0});
  return BestSeconds(repetitions,
                     [&] { BuildGeometry(network.clouds[0], {kCentre}, outputs, set); });
}

void PrintFused(const Network& network, InstructionSet set, const Measured& stock,
                int repetitions) {
  for (const bool all_points : {true, false}) {
    const Measured fused = MeasureFused(network, set, all_points, repetitions);
    const double geometry = GeometrySeconds(network, set, all_points, repetitions);
    std::printf("fused, %-14s %-11s %7.1f %6.1f x stock %7.1f %7.2f ms",
                std::string(NameOf(set)).c_str(), all_points ? "all points" : "point 0", fused.rate,
                fused.rate / stock.rate, 1 / (1 / fused.rate + geometry), 1e3 * geometry);
    if (all_points) std::printf("   %.1e", std::fabs(fused.loss / stock.loss - 1));
    std::printf("\n");
  }
}

void Run(int repetitions) {
  TuneMalloc();
  const LinearAlgebra algebra = MeasureLinearAlgebra();
  std::printf("libtorch %s, %s, %.0f GFLOP/s\n", algebra.torch_version.c_str(),
              algebra.blas_library.c_str(), algebra.gflops);
  const Network network;
  const Measured stock = MeasureStock(network, repetitions);
  std::printf("%-33s %7s %14s %7s %10s   loss\n", "", "samples", "", "with", "geometry");
  std::printf("%-33s %7s %14s %7s %10s   differs\n", "", "/s/core", "", "geom.", "");
  std::printf("%-21s %-11s %7.1f\n", "stock libtorch", "all points", stock.rate);
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (IsSupported(set)) PrintFused(network, set, stock, repetitions);
  }
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  doorforge::Run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 12);
  return 0;
}
