// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "read/raw_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace doorforge::foreign {
namespace {

constexpr std::string_view kGaps = " \t\r";
constexpr std::size_t kMostCorners = 10'000;

// "7/1/2" names vertex 7, "-1" the last one.
int ObjVertex(WordLines& lines, std::string_view word, std::size_t vertices) {
  const std::string_view digits = word.substr(0, word.find('/'));
  long index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size())
    lines.Fail("\"" + std::string(word.substr(0, 40)) + "\" is no vertex of a face");
  const long count = static_cast<long>(vertices);
  const long found = index < 0 ? count + index : index - 1;
  if (found < 0 || found >= count)
    lines.Fail("a face names vertex " + std::to_string(index) + " of " + std::to_string(count));
  return static_cast<int>(found);
}

// Names may hold blanks, and a line may have several: each ends with .mtl, or all is one.
std::vector<std::string> LibraryNames(std::string_view rest) {
  std::vector<std::string> names;
  constexpr std::string_view kEnding = ".mtl";
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kGaps), rest.size()));
    const std::size_t at = rest.find(".mtl ");
    const std::size_t size = at == std::string_view::npos ? rest.size() : at + kEnding.size();
    const std::size_t last = rest.substr(0, size).find_last_not_of(kGaps);
    std::string name(rest.substr(0, last == std::string_view::npos ? 0 : last + 1));
    for (std::size_t i = name.find("\\ "); i != std::string::npos; i = name.find("\\ ", i))
      name.erase(i, 1);
    if (!name.empty()) names.push_back(std::move(name));
    rest.remove_prefix(size);
  }
  return names;
}

void ReadVertex(WordLines& lines, TriangleMesh& mesh) {
  Eigen::Vector3d position;
  for (int k = 0; k < 3; ++k) position[k] = lines.Number();
  mesh.vertices.push_back(position);
}

void RequireTriangles(const TriangleMesh& mesh, int line) {
  if (mesh.triangles.empty()) throw RawMeshFault(line, "no triangle in it");
}

}  // namespace

bool WordLines::Next() {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    rest_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    rest_ = rest_.substr(0, rest_.find('#'));
    if (rest_.find_first_not_of(kGaps) != std::string_view::npos) return true;
  }
  rest_ = {};
  return false;
}

std::string_view WordLines::Word() {
  const std::size_t begin = std::min(rest_.find_first_not_of(kGaps), rest_.size());
  const std::size_t end = std::min(rest_.find_first_of(kGaps, begin), rest_.size());
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

double WordLines::Number() {
  std::string_view word = Word();
  if (word.empty()) Fail("a number is missing");
  const std::string shown(word.substr(0, 40));
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error == std::errc::result_out_of_range)  // what is too small to be held is 0
    number = std::strtod(std::string(word).c_str(), nullptr);
  if (error == std::errc::invalid_argument || end != word.data() + word.size() ||
      !std::isfinite(number))
    Fail("\"" + shown + "\" is no finite number");
  return number;
}

long WordLines::Integer() {
  const std::string_view word = Word();
  long number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size())
    Fail("\"" + std::string(word.substr(0, 40)) + "\" is no whole number");
  return number;
}

void AddFace(const std::vector<int>& corners, int line, TriangleMesh& mesh) {
  if (corners.size() < 3)
    throw RawMeshFault(line, "a face of " + std::to_string(corners.size()) + " corners");
  if (corners.size() > kMostCorners)
    throw RawMeshFault(
        line, "a face of more than the " + std::to_string(kMostCorners) + " corners allowed");
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
  if (mesh.triangles.size() > kMaxRawTriangles)
    throw RawMeshFault(line,
                       "more than the " + std::to_string(kMaxRawTriangles) + " triangles allowed");
}

TriangleMesh ReadRawObj(std::string_view bytes, const std::string& file,
                        std::vector<ForeignFileName>& files) {
  TriangleMesh mesh;
  WordLines lines(bytes);
  std::vector<int> corners;
  while (lines.Next()) {
    const std::string_view kind = lines.Word();
    if (kind == "v") ReadVertex(lines, mesh);
    if (kind == "mtllib") {
      for (const std::string& name : LibraryNames(lines.Rest())) {
        if (files.size() < 64) files.push_back({name, {file, lines.line(), 0, "mtllib"}, true});
      }
    }
    if (kind != "f") continue;
    corners.clear();
    for (std::string_view word = lines.Word(); !word.empty(); word = lines.Word())
      corners.push_back(ObjVertex(lines, word, mesh.vertices.size()));
    AddFace(corners, lines.line(), mesh);
  }
  RequireTriangles(mesh, lines.line());
  return mesh;
}

TriangleMesh ReadRawOff(std::string_view bytes) {
  TriangleMesh mesh;
  WordLines lines(bytes);
  if (!lines.Next()) lines.Fail("the file is empty");
  const std::string_view word = lines.Word();
  const std::size_t mark = word.find("OFF");
  if (mark == std::string_view::npos) lines.Fail("the first word is not OFF");
  // the counts may follow on the same line, even without a blank
  std::string_view first = word.substr(mark + 3);
  if (first.empty()) first = lines.Word();
  if (first.empty() && lines.Next()) first = lines.Word();
  long vertices = 0;
  const auto [end, error] = std::from_chars(first.data(), first.data() + first.size(), vertices);
  if (error != std::errc{} || end != first.data() + first.size())
    lines.Fail("\"" + std::string(first.substr(0, 20)) + "\" is no count of vertices");
  const long faces = lines.Integer();
  const long most = static_cast<long>(bytes.size());
  if (vertices < 0 || faces < 0 || vertices > most || faces > most)
    lines.Fail("counts that the file is too short for");
  for (long i = 0; i < vertices; ++i) {
    if (!lines.Next()) lines.Fail("the file ends before its last vertex");
    ReadVertex(lines, mesh);
  }
  std::vector<int> corners;
  for (long i = 0; i < faces; ++i) {
    if (!lines.Next()) lines.Fail("the file ends before its last face");
    corners.clear();
    const long count = lines.Integer();
    for (long k = 0; k < count; ++k) {
      const long index = lines.Integer();
      if (index < 0 || index >= vertices)
        lines.Fail("a face names vertex " + std::to_string(index) + " of " +
                   std::to_string(vertices));
      corners.push_back(static_cast<int>(index));
    }
    AddFace(corners, lines.line(), mesh);
  }
  RequireTriangles(mesh, lines.line());
  return mesh;
}

}  // namespace doorforge::foreign
