// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "faults/fault_list.h"
#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

struct PlyType {
  std::string_view name;
  std::size_t bytes;
  char kind;  // 'i', 'u' or 'f'
};
constexpr std::array<PlyType, 16> kPlyTypes = {{{"char", 1, 'i'},
                                                {"int8", 1, 'i'},
                                                {"uchar", 1, 'u'},
                                                {"uint8", 1, 'u'},
                                                {"short", 2, 'i'},
                                                {"int16", 2, 'i'},
                                                {"ushort", 2, 'u'},
                                                {"uint16", 2, 'u'},
                                                {"int", 4, 'i'},
                                                {"int32", 4, 'i'},
                                                {"uint", 4, 'u'},
                                                {"uint32", 4, 'u'},
                                                {"float", 4, 'f'},
                                                {"float32", 4, 'f'},
                                                {"double", 8, 'f'},
                                                {"float64", 8, 'f'}}};

struct PlyProperty {
  std::string name;
  PlyType type{};
  PlyType count{};  // of a list
  bool list = false;
};
struct PlyElement {
  std::string name;
  long count = 0;
  std::vector<PlyProperty> properties;
};

PlyType TypeNamed(WordLines& lines) {
  const std::string_view word = lines.Word();
  for (const PlyType& type : kPlyTypes) {
    if (type.name == word) return type;
  }
  lines.Fail("\"" + std::string(word.substr(0, 40)) + "\" is no type of a property");
}

// Where numbers come from, whichever way they are written.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, WordLines lines, bool text, bool big_endian)
      : bytes_(bytes), lines_(lines), at_(lines.offset()), text_(text), big_endian_(big_endian) {}

  void NextRow() {
    if (text_ && !lines_.Next()) lines_.Fail("the file ends before its last element");
  }
  double Take(const PlyType& type) {
    if (text_) return lines_.Number();
    std::array<char, 8> raw{};
    if (at_ + type.bytes > bytes_.size())
      throw RawMeshFault(0, "the file ends before its last element");
    std::memcpy(raw.data(), bytes_.data() + at_, type.bytes);
    at_ += type.bytes;
    const bool turn = big_endian_ != (std::endian::native == std::endian::big);
    if (turn) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    return As(raw, type);
  }
  [[noreturn]] void Fail(const std::string& problem) const {
    throw RawMeshFault(text_ ? lines_.line() : 0, problem);
  }
  int line() const { return text_ ? lines_.line() : 0; }

 private:
  template <class T>
  static T Cast(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  static double As(const std::array<char, 8>& raw, const PlyType& type) {
    if (type.kind == 'f') return type.bytes == 4 ? Cast<float>(raw) : Cast<double>(raw);
    if (type.kind == 'u')
      return type.bytes == 1   ? Cast<std::uint8_t>(raw)
             : type.bytes == 2 ? Cast<std::uint16_t>(raw)
                               : Cast<std::uint32_t>(raw);
    return type.bytes == 1   ? Cast<std::int8_t>(raw)
           : type.bytes == 2 ? Cast<std::int16_t>(raw)
                             : Cast<std::int32_t>(raw);
  }

  std::string_view bytes_;
  WordLines lines_;
  std::size_t at_;
  bool text_;
  bool big_endian_;
};

struct PlyHeader {
  std::vector<PlyElement> elements;
  std::string format;
};

PlyHeader ReadHeader(WordLines& lines) {
  PlyHeader header;
  if (!lines.Next() || lines.Word() != "ply") lines.Fail("the first word is not ply");
  while (true) {
    if (!lines.Next()) lines.Fail("the file ends inside its header");
    const std::string_view kind = lines.Word();
    if (kind == "end_header") return header;
    if (kind == "format") header.format = lines.Word();
    if (kind == "element") {
      PlyElement element;
      element.name = lines.Word();
      element.count = lines.Integer();
      header.elements.push_back(element);
    }
    if (kind != "property") continue;
    if (header.elements.empty()) lines.Fail("a property of no element");
    PlyProperty property;
    WordLines ahead = lines;
    property.list = ahead.Word() == "list";
    if (property.list) {
      lines = ahead;
      property.count = TypeNamed(lines);
    }
    property.type = TypeNamed(lines);
    property.name = lines.Word();
    header.elements.back().properties.push_back(property);
    if (header.elements.size() > 64 || header.elements.back().properties.size() > 64)
      lines.Fail("more than the 64 elements or properties allowed");
  }
}

// An index may be stated as any number.
std::string IndexText(double index) {
  return std::abs(index) < 1e15 ? std::to_string(static_cast<long long>(index)) : Digits(index);
}

double ListLength(const PlyProperty& property, PlyNumbers& numbers) {
  const double count = property.list ? numbers.Take(property.count) : 1;
  if (!(count >= 0 && count <= 10'000)) numbers.Fail("a list of more than the 10000 allowed");
  return count;
}

void ReadPlyVertex(const PlyElement& element, PlyNumbers& numbers, TriangleMesh& mesh) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (const PlyProperty& property : element.properties) {
    for (auto count = static_cast<int>(ListLength(property, numbers)); count > 0; --count) {
      const double number = numbers.Take(property.type);
      const bool is_axis =
          property.name.size() == 1 && property.name >= "x" && property.name <= "z";
      if (!is_axis) continue;
      if (!std::isfinite(number)) numbers.Fail("a position that is not finite");
      position[property.name[0] - 'x'] = number;
    }
  }
  mesh.vertices.push_back(position);
}

void ReadPlyFace(const PlyElement& element, PlyNumbers& numbers, TriangleMesh& mesh) {
  for (const PlyProperty& property : element.properties) {
    const bool indices =
        property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
    const auto count = static_cast<int>(ListLength(property, numbers));
    std::vector<int> corners;
    for (int k = 0; k < count; ++k) {
      const double index = numbers.Take(property.type);
      if (!indices) continue;
      if (!(index >= 0 && index < static_cast<double>(mesh.vertices.size())))
        numbers.Fail("a face names vertex " + IndexText(index) + " of " +
                     std::to_string(mesh.vertices.size()));
      corners.push_back(static_cast<int>(index));
    }
    if (indices) AddFace(corners, numbers.line(), mesh);
  }
}

}  // namespace

TriangleMesh ReadRawPly(std::string_view bytes) {
  WordLines lines(bytes);
  const PlyHeader header = ReadHeader(lines);
  const bool text = header.format == "ascii";
  if (!text && header.format != "binary_little_endian" && header.format != "binary_big_endian")
    lines.Fail("format \"" + header.format.substr(0, 40) + "\" is none of PLY's");
  PlyNumbers numbers(bytes, lines, text, header.format == "binary_big_endian");
  TriangleMesh mesh;
  for (const PlyElement& element : header.elements) {
    if (element.count < 0 || element.count > static_cast<long>(bytes.size()))
      lines.Fail("the file is too short for " + std::to_string(element.count) + " of " +
                 element.name.substr(0, 40));
    if (element.properties.empty()) continue;  // nothing in the file stands for one
    for (long i = 0; i < element.count; ++i) {
      numbers.NextRow();
      if (element.name == "vertex") {
        ReadPlyVertex(element, numbers, mesh);
      } else {
        ReadPlyFace(element, numbers, mesh);
      }
    }
  }
  if (mesh.triangles.empty()) lines.Fail("no triangle in it");
  return mesh;
}

}  // namespace doorforge::foreign
