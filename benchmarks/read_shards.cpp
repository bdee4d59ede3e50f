// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
//
// read_shards DIR [STAGE SPLIT]: bytes a second of CPU time at which all arrays of a dataset's part
// are read and summed, with and without checksums. Run it twice: the second time the files are in
// memory.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numeric>
#include <string>

#include "doorforge/core/program.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {
namespace {

struct Reading {
  double bytes = 0;
  double checksum = 0;
};

Reading ReadAll(const DatasetReader& reader) {
  Reading reading;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    for (const std::span<const float> values :
         {arrays.cloud, arrays.proprio, arrays.action, arrays.joints, arrays.score}) {
      reading.bytes += static_cast<double>(values.size_bytes());
      // one number in each line of the cache, so that all of them are fetched
      for (std::size_t k = 0; k < values.size(); k += 16) reading.checksum += values[k];
    }
    reading.bytes += static_cast<double>(arrays.label.size_bytes() + arrays.state.size_bytes());
    reading.checksum += std::accumulate(arrays.label.begin(), arrays.label.end(), 0.0);
  }
  return reading;
}

void Measure(const std::string& name, const std::string& folder, const std::string& stage,
             const std::string& split, CrcCheck check) {
  double best = 0;
  double bytes = 0;
  double kept = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const DatasetReader reader(folder, stage, split, check);
    const std::clock_t start = std::clock();
    const Reading reading = ReadAll(reader);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    bytes = reading.bytes;
    kept += reading.checksum;
    best = std::max(best, reading.bytes / seconds);
  }
  std::printf("%-24s %7.1f MB  %6.2f GB/s  (sum %.6g)\n", name.c_str(), bytes / 1e6, best / 1e9,
              kept);
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  using doorforge::CrcCheck;
  return doorforge::RunProgram([&] {
    if (argc != 2 && argc != 4) {
      std::fprintf(stderr, "usage: read_shards DIR [STAGE SPLIT]\n");
      return 2;
    }
    const std::string stage = argc == 4 ? argv[2] : "open";
    const std::string split = argc == 4 ? argv[3] : "train";
    doorforge::Measure("C++, CRC on", argv[1], stage, split, CrcCheck::kOnFirstRead);
    doorforge::Measure("C++, CRC off", argv[1], stage, split, CrcCheck::kNever);
    return 0;
  });
}
