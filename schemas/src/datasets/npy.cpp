// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/npy.h"

#include <array>
#include <bit>
#include <charconv>
#include <limits>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written as they lie in memory");

constexpr std::string_view kNpyMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kAlignment = 64;  // of the data, in NumPy's own files too

struct ElementType {
  std::string_view name;
  std::size_t size;
};
constexpr std::array<ElementType, 6> kElementTypes = {
    {{"<f4", 4}, {"<f8", 8}, {"<i8", 8}, {"<u2", 2}, {"|i1", 1}, {"|u1", 1}}};

// The dictionary in the header as Python writes it, with its keys in this order.
class HeaderText {
 public:
  HeaderText(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  void Expect(std::string_view token) {
    if (!rest_.starts_with(token))
      throw Error(ErrorCode::kFormat, path_ + ": npy header: expected \"" + std::string(token) +
                                          "\" before \"" + std::string(rest_.substr(0, 16)) + '"');
    rest_.remove_prefix(token.size());
  }

  bool Accept(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  std::string Quoted() {
    Expect("'");
    const std::size_t end = std::min(rest_.find('\''), rest_.size());
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end);
    Expect("'");
    return text;
  }

  std::vector<std::size_t> Shape() {
    std::vector<std::size_t> shape;
    Expect("(");
    while (!Accept(")")) {
      std::size_t length = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), length);
      if (error != std::errc{} || shape.size() == 32)
        throw Error(ErrorCode::kFormat, path_ + ": npy header: bad shape");
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      shape.push_back(length);
      if (!Accept(", ")) Accept(",");
    }
    return shape;
  }

  void End() {
    if (!Accept(", ")) Accept(",");
    Expect("}");
    if (rest_.find_first_not_of(" \n") != std::string_view::npos)
      throw Error(ErrorCode::kFormat, path_ + ": npy header: more than blanks behind its \"}\"");
  }

 private:
  std::string_view rest_;
  const std::string& path_;
};

std::size_t ElementSize(std::string_view type, const std::string& path) {
  for (const ElementType& known : kElementTypes) {
    if (known.name == type) return known.size;
  }
  throw Error(ErrorCode::kFormat, path + ": element type " + std::string(type) +
                                      ", allowed <f4, <f8, <i8, <u2, |i1, |u1");
}

// Product of the shape and the element size; throws where it does not fit.
std::size_t DataSize(const NpyHeader& header, const std::string& path) {
  std::size_t size = ElementSize(header.type, path);
  for (const std::size_t length : header.shape) {
    if (length != 0 && size > std::numeric_limits<std::size_t>::max() / length)
      throw Error(ErrorCode::kFormat, path + ": npy header: the shape is too large");
    size *= length;
  }
  return size;
}

std::string ShapeText(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

}  // namespace

std::string MakeNpyHeader(std::string_view type, const std::vector<std::size_t>& shape) {
  std::string dictionary = "{'descr': '" + std::string(type) +
                           "', 'fortran_order': False, 'shape': " + ShapeText(shape) + ", }";
  const std::size_t unpadded = kNpyMagic.size() + 2 + dictionary.size() + 1;
  dictionary.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  dictionary += '\n';
  Require(dictionary.size() <= 0xFFFF, ErrorCode::kInvalidArgument, "npy: shape is too long");
  std::string header(kNpyMagic);
  header += static_cast<char>(dictionary.size() & 0xFFU);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

NpyHeader ParseNpyHeader(std::span<const std::byte> bytes, const std::string& path) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(kNpyMagic) || text.size() < kNpyMagic.size() + 2)
    throw Error(ErrorCode::kFormat, path + ": not an .npy file of version 1.0");
  const std::size_t start = kNpyMagic.size() + 2;
  const std::size_t length =
      static_cast<unsigned char>(text[8]) + 256U * static_cast<unsigned char>(text[9]);
  if (text.size() < start + length)
    throw Error(ErrorCode::kFormat, path + ": npy header is cut off");
  NpyHeader header;
  header.data_offset = start + length;
  HeaderText dictionary(text.substr(start, length), path);
  dictionary.Expect("{'descr': ");
  header.type = dictionary.Quoted();
  dictionary.Expect(", 'fortran_order': False, 'shape': ");
  header.shape = dictionary.Shape();
  dictionary.End();
  const std::size_t expected = DataSize(header, path);
  if (bytes.size() - header.data_offset != expected)
    throw Error(ErrorCode::kFormat, path + ": " +
                                        std::to_string(bytes.size() - header.data_offset) +
                                        " bytes of data, the shape " + ShapeText(header.shape) +
                                        " needs " + std::to_string(expected));
  return header;
}

namespace internal {

void CheckNpyCount(std::size_t found, const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t length : shape) count *= length;
  Require(found == count, ErrorCode::kInvalidArgument,
          "npy: " + std::to_string(found) + " values for the shape " + ShapeText(shape));
}

void CheckNpyType(const NpyHeader& header, std::string_view type, const std::string& path) {
  if (header.type != type)
    throw Error(ErrorCode::kFormat,
                path + ": element type " + header.type + ", expected " + std::string(type));
}

void CheckNpyAlignment(const std::byte* data, std::size_t alignment, const std::string& path) {
  if (reinterpret_cast<std::uintptr_t>(data) % alignment != 0)
    throw Error(ErrorCode::kFormat, path + ": the data are not aligned for their type");
}

}  // namespace internal
}  // namespace doorforge
