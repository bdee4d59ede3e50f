// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// The part of NumPy's .npy format, version 1.0, that shards use: C order, little endian, elements
/// of type `<f4`, `<f8`, `<i8`, `<u2`, `|i1` or `|u1`.
/// (https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html)
struct NpyHeader {
  std::string type;                ///< "<f4", "<f8", "<i8", "<u2", "|i1" or "|u1".
  std::vector<std::size_t> shape;  ///< Empty for a scalar.
  std::size_t data_offset = 0;     ///< The first element begins there, at a multiple of 64.
};

/// Type name of T in NpyHeader.
template <class T>
constexpr std::string_view NpyTypeOf();
template <>
constexpr std::string_view NpyTypeOf<float>() {
  return "<f4";
}
template <>
constexpr std::string_view NpyTypeOf<double>() {
  return "<f8";
}
template <>
constexpr std::string_view NpyTypeOf<std::int64_t>() {
  return "<i8";
}
template <>
constexpr std::string_view NpyTypeOf<std::uint16_t>() {
  return "<u2";
}
template <>
constexpr std::string_view NpyTypeOf<std::int8_t>() {
  return "|i1";
}
template <>
constexpr std::string_view NpyTypeOf<std::uint8_t>() {
  return "|u1";
}

/// Magic, version and dictionary, padded so that the data that follow start at a multiple of 64.
std::string MakeNpyHeader(std::string_view type, const std::vector<std::size_t>& shape);

/// Parses the header and checks that exactly the announced data follow. Throws Error(kFormat), its
/// message beginning with `path`, on anything else than the format described at NpyHeader, Fortran
/// order and version 2 or 3 included.
NpyHeader ParseNpyHeader(std::span<const std::byte> bytes, const std::string& path);

/// A whole .npy file. Throws Error(kInvalidArgument) if `values` does not have as many elements as
/// `shape` says.
template <class T>
std::string MakeNpy(std::span<const T> values, const std::vector<std::size_t>& shape);

/// An array within the bytes of an .npy file.
template <class T>
struct NpyView {
  std::vector<std::size_t> shape;
  std::span<const T> values;  ///< C order; points into the bytes given to ViewNpy().
};

/// Throws Error(kFormat) as ParseNpyHeader(), or if the element type is not T's or the data are not
/// aligned for T.
template <class T>
NpyView<T> ViewNpy(std::span<const std::byte> bytes, const std::string& path);

namespace internal {
void CheckNpyCount(std::size_t found, const std::vector<std::size_t>& shape);
void CheckNpyType(const NpyHeader& header, std::string_view type, const std::string& path);
void CheckNpyAlignment(const std::byte* data, std::size_t alignment, const std::string& path);
}  // namespace internal

template <class T>
std::string MakeNpy(std::span<const T> values, const std::vector<std::size_t>& shape) {
  internal::CheckNpyCount(values.size(), shape);
  std::string bytes = MakeNpyHeader(NpyTypeOf<T>(), shape);
  const std::size_t offset = bytes.size();
  bytes.resize(offset + values.size_bytes());
  if (!values.empty()) std::memcpy(bytes.data() + offset, values.data(), values.size_bytes());
  return bytes;
}

template <class T>
NpyView<T> ViewNpy(std::span<const std::byte> bytes, const std::string& path) {
  NpyHeader header = ParseNpyHeader(bytes, path);
  internal::CheckNpyType(header, NpyTypeOf<T>(), path);
  const std::span<const std::byte> data = bytes.subspan(header.data_offset);
  internal::CheckNpyAlignment(data.data(), alignof(T), path);
  return {std::move(header.shape),
          {reinterpret_cast<const T*>(data.data()), data.size() / sizeof(T)}};
}

}  // namespace doorforge
