// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/linear_algebra.h"

#include <algorithm>
#include <fstream>

#include <ATen/ATen.h>
#include <c10/core/GradMode.h>
#include <time.h>  // NOLINT: clock_gettime is POSIX
#include <torch/csrc/api/include/torch/version.h>

#include "head_objectives.h"

namespace doorforge {
namespace {

double ProcessorSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string MappedBlas() {
  std::ifstream maps("/proc/self/maps");
  std::string first;
  for (std::string line; std::getline(maps, line);) {
    const std::size_t slash = line.find('/');
    if (slash == std::string::npos) continue;
    std::string file = line.substr(slash);
    const std::string name = file.substr(file.rfind('/') + 1);
    if (name.find("openblas") != std::string::npos) return file;
    if (name.rfind("libblas", 0) == 0 || name.rfind("libmkl", 0) == 0) first = file;
  }
  return first;
}

}  // namespace

LinearAlgebra MeasureLinearAlgebra() {
  internal::UseOneTorchThread();
  const c10::AutoGradMode mode(false);
  constexpr std::int64_t kSize = 512;
  const at::Tensor a = at::full({kSize, kSize}, 0.5);
  const at::Tensor b = at::full({kSize, kSize}, 0.25);
  double best = 1e9;
  for (int i = 0; i < 5; ++i) {
    const double start = ProcessorSeconds();
    const at::Tensor c = at::mm(a, b);
    best = std::min(best, ProcessorSeconds() - start);
  }
  return {TORCH_VERSION, MappedBlas(), 2e-9 * kSize * kSize * kSize / best};
}

std::string LinearAlgebraRemedy() {
  return "apt-get install libopenblas0-openmp\n"
         "update-alternatives --set libblas.so.3-x86_64-linux-gnu "
         "/usr/lib/x86_64-linux-gnu/openblas-openmp/libblas.so.3\n"
         "update-alternatives --set liblapack.so.3-x86_64-linux-gnu "
         "/usr/lib/x86_64-linux-gnu/openblas-openmp/liblapack.so.3";
}

}  // namespace doorforge
