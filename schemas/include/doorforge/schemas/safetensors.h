// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// Element types of the safetensors format that this project writes and reads. A file with another
/// type is refused.
enum class TensorType { kF64, kF32, kF16, kI64, kU8 };
std::string_view NameOf(TensorType type);  ///< "F64", "F32", "F16", "I64", "U8".
std::size_t ElementSize(TensorType type);  ///< [bytes]

template <class T>
constexpr TensorType TensorTypeOf();
template <>
constexpr TensorType TensorTypeOf<double>() {
  return TensorType::kF64;
}
template <>
constexpr TensorType TensorTypeOf<float>() {
  return TensorType::kF32;
}
template <>
constexpr TensorType TensorTypeOf<std::int64_t>() {
  return TensorType::kI64;
}
template <>
constexpr TensorType TensorTypeOf<std::uint8_t>() {
  return TensorType::kU8;
}

/// A dense tensor, row-major.
struct Tensor {
  TensorType type = TensorType::kF32;
  std::vector<std::uint64_t> shape;  ///< Empty for a scalar.
  std::string bytes;                 ///< Little endian, C order.
};

/// Throws Error(kInvalidArgument) unless `values` has as many elements as `shape` says.
template <class T>
Tensor MakeTensor(std::span<const T> values, std::vector<std::uint64_t> shape);

/// The elements of a tensor. Throws Error(kFormat), naming `path`, unless type and shape are these.
template <class T>
std::vector<T> ValuesOf(const Tensor& tensor, const std::vector<std::uint64_t>& shape,
                        const std::string& path);

/// A tensor of half precision: each value rounded to the nearest, ties to even. Throws
/// Error(kInvalidArgument) as MakeTensor(), and for a finite value beyond 65504.
Tensor MakeHalfTensor(std::span<const float> values, std::vector<std::uint64_t> shape);

/// The elements of a tensor of single or half precision. Throws Error(kFormat) as ValuesOf().
std::vector<float> FloatsOf(const Tensor& tensor, const std::vector<std::uint64_t>& shape,
                            const std::string& path);

/// What a .safetensors file holds (https://github.com/huggingface/safetensors): named tensors and
/// free text.
struct TensorFile {
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;
};

/// The file's bytes: 8 bytes of header length, a JSON header padded with blanks so that the data
/// begin at a multiple of 64, the data without gaps. Tensors of wider elements come first, equal
/// ones by name, so every tensor is aligned and equal values give equal bytes.
std::string EncodeTensors(const TensorFile& file);

/// Checks everything: lengths, types, shapes, that the data ranges cover the file without gap or
/// overlap, that no name occurs twice. Throws Error(kFormat), its message beginning with `path`.
TensorFile DecodeTensors(std::string_view bytes, const std::string& path);

/// DecodeTensors() of a file. Throws Error(kMissing, kIo or kFormat).
TensorFile ReadTensors(const std::filesystem::path& path);

/// The tensor of this name. Throws Error(kFormat), naming `path`, if there is none.
const Tensor& TensorNamed(const TensorFile& file, const std::string& name, const std::string& path);

namespace internal {
std::uint64_t ElementCount(const std::vector<std::uint64_t>& shape);
Tensor MakeTensor(TensorType type, std::span<const std::byte> bytes,
                  std::vector<std::uint64_t> shape);
void CheckTensor(const Tensor& tensor, TensorType type, const std::vector<std::uint64_t>& shape,
                 const std::string& path);
void CopyBytes(std::string_view from, void* to);
}  // namespace internal

template <class T>
Tensor MakeTensor(
    std::span<const T> values,
    std::vector<std::uint64_t> shape) {  // NOLINT(performance-unnecessary-value-param): is moved
  return internal::MakeTensor(TensorTypeOf<T>(), std::as_bytes(values), std::move(shape));
}

template <class T>
std::vector<T> ValuesOf(const Tensor& tensor, const std::vector<std::uint64_t>& shape,
                        const std::string& path) {
  internal::CheckTensor(tensor, TensorTypeOf<T>(), shape, path);
  std::vector<T> values(tensor.bytes.size() / sizeof(T));
  internal::CopyBytes(tensor.bytes, values.data());
  return values;
}

}  // namespace doorforge
