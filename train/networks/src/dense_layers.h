// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "doorforge/networks/instruction_set.h"
#include "doorforge/networks/parameters.h"

#include "kernels.h"

namespace doorforge::internal {

/// A row-major matrix that owns its numbers; row i begins at values[i * stride].
struct Table {
  int rows = 0;
  int columns = 0;
  int stride = 0;
  std::vector<float> values;

  Rows View() const { return {values.data(), stride, rows, columns}; }
};

/// Numbers that lie row after row, `columns` of them in each.
Rows ViewOf(const std::vector<float>& values, int columns);
/// The columns of all parts side by side. All parts have the same number of rows.
Table SideBySide(std::initializer_list<Rows> parts);

enum class Activation { kNone, kLeaky, kRectified };

/// The dense layers behind a network's encoder, packed once for the kernels. A row's result does
/// not depend on the rows beside it. Immutable; serves several threads.
class DenseLayers {
 public:
  /// Takes every layer of the layout whose name does not begin with "encoder.".
  /// @throws Error(kInvalidArgument) as KernelsFor().
  DenseLayers(const ParameterLayout& layout, std::span<const float> parameters, InstructionSet set);

  /// One layer and what follows it. @throws Error(kInvalidArgument) if no layer has that name.
  Table Apply(const std::string& name, const Rows& x, Activation activation) const;
  /// This one writes into `out`, whose memory is used again.
  void Apply(const std::string& name, const Rows& x, Activation activation, Table& out) const;

  /// This one is quicker with what a rectified layer made, which holds many zeros.
  void ApplyToRectified(const std::string& name, const Rows& x, Activation activation,
                        Table& out) const;

  /// It is of a layer whose inputs before those of `x` are zero.
  Table ApplyToLast(const std::string& name, const Rows& x, Activation activation) const;

  /// The layers "<name>.0", "<name>.1", "<name>.2" with the activation between them.
  Table Branch(const std::string& name, Activation between, const Rows& x) const;

  /// A rectified layer's maximum over the rows of `x`, which a rectified layer made and which are
  /// at most 256 wide, one number an output, into `best`.
  void MaximumOver(const std::string& name, const Rows& x, std::span<float> best) const;

 private:
  struct Layer {
    std::string name;
    int outputs;
    Panels weight;
    std::vector<float> panels;
    std::vector<float> bias;
  };

  Layer Pack(const DenseLayer& dense, const float* weight) const;
  const Layer& Find(const std::string& name) const;
  const Layer& FindFor(const std::string& name, const Rows& x) const;
  using Multiply = decltype(Kernels::multiply);
  void Apply(const Layer& layer, Multiply multiply, const Rows& x, Activation activation,
             Table& out) const;

  const Kernels* kernels_;
  std::vector<Layer> layers_;
};

}  // namespace doorforge::internal
