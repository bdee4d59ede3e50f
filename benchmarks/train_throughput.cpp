// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Forward and backward pass of the PointNet++ encoder, samples per second of one core, against the
// same network in stock libtorch operators in the same run. Processor time, best of several; point
// geometry is left out on both sides (it is found once per cloud) and timed apart.
//
//   train_throughput [repetitions]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <malloc.h>
#include <time.h>

#include "doorforge/learn/linear_algebra.h"
#include "doorforge/learn/point_encoder.h"

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

double StockRate(const Network& network, int repetitions) {
  testing::ReferenceNetwork stock(network.layout, network.parameters, network.clouds, kCentre,
                                  testing::Precision::kSingle);
  const std::vector<float> wanted(kBatch * kCloudPoints * kFeatureSize, 0.01F);
  stock.Run(wanted);
  return kBatch / BestSeconds(std::max(2, repetitions / 4), [&] { stock.Run(wanted); });
}

double FusedRate(const Network& network, InstructionSet set, bool all_points, int repetitions) {
  std::vector<std::uint16_t> outputs(all_points ? kCloudPoints : 1);
  std::iota(outputs.begin(), outputs.end(), std::uint16_t{0});
  const std::vector<float> wanted(outputs.size() * kFeatureSize, 0.01F);
  const PointEncoder encoder(network.layout, "", network.parameters, set);
  std::vector<float> gradient(network.parameters.size());
  double seconds = 0;
  PointEncoder::Trace trace;
  for (const std::vector<float>& cloud : network.clouds) {
    const CloudGeometry geometry = BuildGeometry(cloud, kCentre, outputs, set);
    seconds += BestSeconds(repetitions, [&] {
      trace = encoder.Forward(geometry, std::move(trace));
      encoder.AddGradient(geometry, trace, wanted, gradient);
    });
  }
  return kBatch / seconds;
}

void Print(const char* name, const char* part, double rate, double stock) {
  std::printf("%-22s %-12s %8.1f samples/s/core  %5.1f x stock\n", name, part, rate, rate / stock);
}

void Run(int repetitions) {
  TuneMalloc();
  const LinearAlgebra algebra = MeasureLinearAlgebra();
  std::printf("libtorch %s, %s, %.0f GFLOP/s\n", algebra.torch_version.c_str(),
              algebra.blas_library.c_str(), algebra.gflops);
  const Network network;
  const double stock = StockRate(network, repetitions);
  Print("stock libtorch", "all points", stock, stock);
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!IsSupported(set)) continue;
    const std::string name = "fused, " + std::string(NameOf(set));
    Print(name.c_str(), "all points", FusedRate(network, set, true, repetitions), stock);
    Print(name.c_str(), "point 0", FusedRate(network, set, false, repetitions), stock);
  }
  const double geometry =
      BestSeconds(repetitions, [&] { BuildGeometry(network.clouds[0], kCentre); });
  std::printf("geometry for point 0   %.2f ms per cloud\n", 1e3 * geometry);
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  doorforge::Run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 12);
  return 0;
}
