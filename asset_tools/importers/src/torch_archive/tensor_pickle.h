// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge::internal {

/// What a pickled tensor says of itself; its elements lie elsewhere.
struct PickledTensor {
  std::string element;  ///< "FloatStorage", "DoubleStorage", "IntStorage", "LongStorage", ...
  std::string key;      ///< It names the storage.
  std::int64_t offset = 0;
  std::vector<std::int64_t> size;
  std::vector<std::int64_t> stride;
};

/// Reads a pickle that holds one tensor as torch.save() writes it.
///
/// A pickle is a program; of its instructions those are understood that describe such a tensor, and
/// what they would call is only looked at by name. Throws Error(kFormat), naming `name`, on any
/// other instruction or result.
PickledTensor ParseTensorPickle(std::string_view pickle, const std::string& name);

}  // namespace doorforge::internal
