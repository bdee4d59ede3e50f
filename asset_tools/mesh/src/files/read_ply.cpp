// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "doorforge/core/committed_file.h"

#include "files/mesh_readers.h"
#include "files/polygon_soup.h"
#include "files/text_lines.h"

namespace doorforge {
namespace {

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct ScalarType {
  std::string_view name;
  std::string_view alias;
  std::size_t bytes;
  char kind;  // i, u or f
};

constexpr std::array kScalarTypes{
    ScalarType{"char", "int8", 1, 'i'},     ScalarType{"uchar", "uint8", 1, 'u'},
    ScalarType{"short", "int16", 2, 'i'},   ScalarType{"ushort", "uint16", 2, 'u'},
    ScalarType{"int", "int32", 4, 'i'},     ScalarType{"uint", "uint32", 4, 'u'},
    ScalarType{"float", "float32", 4, 'f'}, ScalarType{"double", "float64", 8, 'f'}};

struct Property {
  std::string name;
  ScalarType type;
  std::optional<ScalarType> count_type;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
};

ScalarType ScalarTypeOf(const Lines& lines, std::string_view name) {
  for (const ScalarType& type : kScalarTypes) {
    if (name == type.name || name == type.alias) return type;
  }
  lines.Fail("\"" + std::string(name.substr(0, 40)) + "\" is no number type");
}

Property PropertyOf(const Lines& lines, Words& words) {
  std::string_view word = words.Next();
  std::optional<ScalarType> count_type;
  if (word == "list") {
    count_type = ScalarTypeOf(lines, words.Next());
    if (count_type->kind == 'f') lines.Fail("the length of a list must be an integer");
    word = words.Next();
  }
  const ScalarType type = ScalarTypeOf(lines, word);
  return {std::string(words.Next()), type, count_type};
}

Encoding EncodingOf(const Lines& lines, std::string_view name) {
  if (name == "ascii") return Encoding::kText;
  if (name == "binary_little_endian") return Encoding::kLittleEndian;
  if (name == "binary_big_endian") return Encoding::kBigEndian;
  lines.Fail("\"" + std::string(name.substr(0, 40)) + "\" is no encoding");
}

Header ReadHeader(Lines& lines) {
  Header header;
  const auto first = lines.Next();
  if (!first || Words(*first).Next() != "ply") lines.Fail("the file does not begin with \"ply\"");
  while (const auto line = lines.Next()) {
    Words words(*line);
    const std::string_view key = words.Next();
    if (key == "end_header") return header;
    if (key == "format") header.encoding = EncodingOf(lines, words.Next());
    if (key == "element") {
      const std::string name(words.Next());
      const auto count = NumberOf<std::uint64_t>(words.Next());
      if (!count) lines.Fail("an element needs a name and a count");
      header.elements.push_back({name, *count, {}});
    }
    if (key == "property") {
      if (header.elements.empty()) lines.Fail("a property comes before any element");
      header.elements.back().properties.push_back(PropertyOf(lines, words));
    }
  }
  lines.Fail("the file ends inside its header");
}

// Hands out the numbers behind the header one by one.
class Body {
 public:
  Body(Encoding encoding, std::string_view content) : encoding_(encoding), rest_(content) {}

  double Next(const ScalarType& type) {
    return encoding_ == Encoding::kText ? NextWord() : NextBinary(type);
  }

  /// Each record takes at least a byte, so a count beyond this is a lie.
  std::uint64_t bytes_left() const { return rest_.size(); }

 private:
  double NextWord() {
    constexpr std::string_view kBlanks = " \t\r\n";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    const auto number = NumberOf<double>(word);
    if (word.empty()) throw Error(ErrorCode::kFormat, "the file ends before its last element");
    if (!number)
      throw Error(ErrorCode::kFormat, "\"" + std::string(word.substr(0, 40)) + "\" is no number");
    rest_.remove_prefix(word.size());
    return *number;
  }

  template <class Number>
  double NextAs() {
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), rest_.data(), bytes.size());
    rest_.remove_prefix(bytes.size());
    if ((encoding_ == Encoding::kBigEndian) != (std::endian::native == std::endian::big))
      std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<Number>(bytes));
  }

  double NextBinary(const ScalarType& type) {
    if (rest_.size() < type.bytes)
      throw Error(ErrorCode::kFormat, "the file ends before its last element");
    if (type.kind == 'f') return type.bytes == 4 ? NextAs<float>() : NextAs<double>();
    if (type.bytes == 1) return type.kind == 'i' ? NextAs<std::int8_t>() : NextAs<std::uint8_t>();
    if (type.bytes == 2) return type.kind == 'i' ? NextAs<std::int16_t>() : NextAs<std::uint16_t>();
    return type.kind == 'i' ? NextAs<std::int32_t>() : NextAs<std::uint32_t>();
  }

  Encoding encoding_;
  std::string_view rest_;
};

std::vector<double> NextList(Body& body, const Property& property) {
  const double count = property.count_type ? body.Next(*property.count_type) : 1;
  if (!(count >= 0) || count > static_cast<double>(body.bytes_left()))
    throw Error(ErrorCode::kFormat,
                "a list of length " + std::to_string(count) + " does not fit into the file");
  std::vector<double> values;
  for (double i = 0; i < count; ++i) values.push_back(body.Next(property.type));
  return values;
}

class PlyReader {
 public:
  explicit PlyReader(const MeshImportLimits& limits) : soup_(limits) {}

  ImportedMesh Read(const Header& header, Body body) {
    for (const Element& element : header.elements) {
      if (element.properties.empty()) continue;
      if (element.count > body.bytes_left())
        throw Error(ErrorCode::kFormat, std::to_string(element.count) + " elements \"" +
                                            element.name + "\" do not fit into the file");
      for (std::uint64_t i = 0; i < element.count; ++i) ReadRecord(element, body);
      if (element.name == "vertex") soup_.BeginPiece("", MeanColor());
    }
    return std::move(soup_).Finish();
  }

 private:
  void ReadRecord(const Element& element, Body& body) {
    if (element.name == "vertex") vertices_.emplace_back(0, 0, 0);
    for (const Property& property : element.properties) {
      const std::vector<double> values = NextList(body, property);
      if (element.name == "vertex" && values.size() == 1) ReadVertexValue(property, values[0]);
      if (element.name == "face" && property.name.starts_with("vertex_ind")) ReadFace(values);
    }
  }

  void ReadVertexValue(const Property& property, double value) {
    constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
    constexpr std::array<std::string_view, 3> kChannels{"red", "green", "blue"};
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (property.name == kAxes[axis]) vertices_.back()[k] = value;
      if (property.name == kChannels[axis]) {
        color_sum_[k] += property.type.kind == 'f' ? value : value / 255;
        has_color_ = true;
      }
    }
  }

  Eigen::Vector4d MeanColor() const {
    Eigen::Vector4d color = ImportedPiece{}.color_rgba;
    if (has_color_ && color_sum_.allFinite())
      color.head<3>() = color_sum_ / static_cast<double>(vertices_.size());
    return color;
  }

  // An index may be stated as any number.
  static std::string IndexText(double index) {
    if (std::abs(index) < 1e15) return std::to_string(static_cast<std::int64_t>(index));
    return std::isnan(index) ? "that is no number" : "beyond all numbers";
  }

  void ReadFace(const std::vector<double>& indices) {
    corners_.clear();
    for (const double index : indices) {
      if (!(index >= 0) || index >= static_cast<double>(vertices_.size()))
        throw Error(ErrorCode::kFormat,
                    "a face names vertex " + IndexText(index) + ", allowed 0.." +
                        std::to_string(static_cast<std::int64_t>(vertices_.size()) - 1));
      corners_.push_back(vertices_[static_cast<std::size_t>(index)]);
    }
    soup_.AddPolygon(corners_);
  }

  PolygonSoup soup_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3d> corners_;
  Eigen::Vector3d color_sum_ = Eigen::Vector3d::Zero();
  bool has_color_ = false;
};

}  // namespace

ImportedMesh ReadPlyFile(const std::filesystem::path& path, const MeshImportLimits& limits) {
  const std::string content = ReadFile(path, limits.max_file_bytes);
  Lines lines(content);
  const Header header = ReadHeader(lines);
  return PlyReader(limits).Read(header, Body(header.encoding, lines.rest()));
}

}  // namespace doorforge
