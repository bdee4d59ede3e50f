// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace doorforge {

/// One dense layer's place in a network's flat parameter vector: the weight [outputs, inputs] row
/// by row (PyTorch's convention), then the bias [outputs].
struct DenseLayer {
  std::string name;  ///< Such as "encoder.sa1.0"; its tensors are name + ".weight" and ".bias".
  int inputs = 0;
  int outputs = 0;
  std::size_t offset = 0;  ///< The weight begins there.

  std::size_t weight_count() const { return static_cast<std::size_t>(inputs) * outputs; }
  std::size_t bias_offset() const { return offset + weight_count(); }
  std::size_t end() const { return bias_offset() + static_cast<std::size_t>(outputs); }
};

/// Layers whose parameters follow each other in one flat vector.
class ParameterLayout {
 public:
  /// Appends a layer; its offset is the present size(). Returns its index.
  std::size_t Add(const std::string& name, int inputs, int outputs);
  const std::vector<DenseLayer>& layers() const { return layers_; }
  std::size_t size() const { return layers_.empty() ? 0 : layers_.back().end(); }

 private:
  std::vector<DenseLayer> layers_;
};

/// He initialisation (He et al. 2015): weights normal with variance 2 / inputs, biases 0. Drawn
/// from the stream "init/<prefix><layer name>" of `seed`, so a layer's start does not depend on
/// others.
std::vector<float> HeInitialisation(const ParameterLayout& layout, std::uint64_t seed,
                                    const std::string& prefix);

}  // namespace doorforge
