// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace doorforge::internal {

/// An array as numpy names it.
struct NumpyArray {
  std::string dtype;  ///< Such as "<f4".
  std::vector<std::int64_t> shape;
  std::string bytes;  ///< In row order.

  /// Throws Error(kFormat), which begins with `name`, unless it holds numbers that are known here.
  std::vector<double> Numbers(const std::string& name) const;
};

NumpyArray ArrayOf(const float* values, std::vector<std::int64_t> shape);
NumpyArray ArrayOf(const double* values, std::vector<std::int64_t> shape);

/// A value of MessagePack, with arrays as openpi's msgpack_numpy packs them: maps whose keys are
/// bytes. Keys of maps are texts; those of bytes are taken as texts, others are refused.
struct Value {
  using List = std::vector<Value>;
  using Map = std::map<std::string, Value>;
  struct Bytes {
    std::string content;
  };

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Bytes, List, Map,
               NumpyArray>
      content;

  template <class T>
  const T* As() const {
    return std::get_if<T>(&content);
  }
  /// What a map has under a key; null if it is no map or has none.
  const Value* Find(const std::string& key) const;
};

std::string Packed(const Value& value);

/// Throws Error(kFormat) that says what is wrong, also on what nests more than 32 levels deep,
/// holds more than 100,000 values, or has bytes behind it. An array counts as the few values of its
/// map, so no message takes much more memory than its own bytes.
Value Unpacked(std::string_view message);

}  // namespace doorforge::internal
