// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"

#include "kernel_choice.h"

namespace doorforge::internal {
namespace {

// A product whose left side is as rectified layers make it: of each two rows some columns are zero,
// and a third of the rest.
struct Product {
  Product(const Kernels& kernels, int rows, int columns) : depth(columns), rows(rows) {
    outputs = 3 * kernels.panel;
    Rng rng(static_cast<std::uint64_t>(columns), "test/sparse_kernels");
    for (int row = 0; row < rows; ++row) {
      for (int k = 0; k < columns; ++k) {
        const bool zero = (row / 2 + k) % 3 == 0 || rng.Uniform() < 0.3;
        left.push_back(zero ? 0.0F : static_cast<float>(rng.Normal()));
      }
    }
    for (int i = 0; i < outputs * columns; ++i) right.push_back(static_cast<float>(rng.Normal()));
    for (int i = 0; i < outputs; ++i) bias.push_back(static_cast<float>(rng.Normal()));
    out.resize(static_cast<std::size_t>(rows * outputs));
  }

  Rows Left() const { return {left.data(), depth, rows, depth}; }
  Panels Right() const { return {right.data(), outputs, depth}; }

  // One output, summed in double precision.
  double Expected(int row, int output, int panel) const {
    double sum = static_cast<double>(bias[static_cast<std::size_t>(output)]);
    for (int k = 0; k < depth; ++k) {
      const int at = output / panel * panel * depth + k * panel + output % panel;
      sum += static_cast<double>(left[static_cast<std::size_t>(row * depth + k)]) *
             static_cast<double>(right[static_cast<std::size_t>(at)]);
    }
    return std::max(sum, 0.0);
  }

  int depth;
  int rows;
  int outputs;
  std::vector<float> left;
  std::vector<float> right;
  std::vector<float> bias;
  std::vector<float> out;
};

std::vector<InstructionSet> SetsOfThisProcessor() {
  std::vector<InstructionSet> sets = {InstructionSet::kBaseline, InstructionSet::kAvx2,
                                      InstructionSet::kAvx512};
  std::erase_if(sets, [](InstructionSet set) { return !IsSupported(set); });
  return sets;
}

TEST(SparseKernels, LeaveOutZerosAndGiveTheSameBits) {
  for (const InstructionSet set : SetsOfThisProcessor()) {
    const Kernels& kernels = KernelsFor(set);
    for (const int rows : {1, 5, 31}) {
      for (const int columns : {1, 3, 64, 100, kMostSparseColumns, kMostSparseColumns + 1}) {
        SCOPED_TRACE(std::string(kernels.name) + " " + std::to_string(rows) + " x " +
                     std::to_string(columns));
        Product product(kernels, rows, columns);
        std::vector<float> dense = product.out;
        kernels.multiply(product.Left(), product.Right(), product.bias.data(),
                         {dense.data(), product.outputs}, true);
        kernels.multiply_sparse(product.Left(), product.Right(), product.bias.data(),
                                {product.out.data(), product.outputs}, true);
        EXPECT_EQ(product.out, dense);
        for (const int output : {0, product.outputs - 1})
          EXPECT_NEAR(product.out[static_cast<std::size_t>((rows - 1) * product.outputs + output)],
                      product.Expected(rows - 1, output, kernels.panel), 1e-4);
      }
    }
  }
}

TEST(SparseKernels, TheMaximumIsThatOfTheRowsOfTheProduct) {
  for (const InstructionSet set : SetsOfThisProcessor()) {
    const Kernels& kernels = KernelsFor(set);
    for (const int rows : {1, 5, 31}) {
      Product product(kernels, rows, 64);
      kernels.multiply(product.Left(), product.Right(), product.bias.data(),
                       {product.out.data(), product.outputs}, true);
      std::vector<float> best(static_cast<std::size_t>(product.outputs), -1);
      kernels.multiply_max(product.Left(), product.Right(), product.bias.data(), best.data());
      for (int output = 0; output < product.outputs; ++output) {
        float most = 0;
        for (int row = 0; row < rows; ++row)
          most =
              std::max(most, product.out[static_cast<std::size_t>(row * product.outputs + output)]);
        EXPECT_EQ(best[static_cast<std::size_t>(output)], most) << kernels.name << " " << output;
      }
    }
  }
}

}  // namespace
}  // namespace doorforge::internal
