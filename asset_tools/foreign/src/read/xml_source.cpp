// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "read/xml_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace doorforge::foreign {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string CountText(std::size_t least, std::size_t most) {
  return least == most ? std::to_string(least)
                       : std::to_string(least) + " to " + std::to_string(most);
}

}  // namespace

SourcePlace XmlSource::At(const XmlElement& element, std::string_view attribute) const {
  const XmlAttribute* found = element.Attribute(attribute);
  return found == nullptr ? At(element) : PlaceOf(file_, element, *found);
}

std::optional<std::string> XmlSource::Text(const XmlElement& element, std::string_view attribute,
                                           bool required) const {
  if (const XmlAttribute* found = element.Attribute(attribute)) return found->value;
  if (required) faults_.Add("FIL007", At(element), "no attribute " + std::string(attribute));
  return std::nullopt;
}

const XmlElement* XmlSource::Child(const XmlElement& element, std::string_view name) const {
  const XmlElement* child = element.Child(name);
  if (child == nullptr) faults_.Add("FIL007", At(element), "no <" + std::string(name) + ">");
  return child;
}

std::optional<std::vector<double>> XmlSource::Numbers(const SourcePlace& place,
                                                      std::string_view text, std::size_t least,
                                                      std::size_t most) const {
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(kBlanks, at)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    std::string_view word = text.substr(at, end - at);
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(number)) {
      faults_.Add("FIL006", place, "\"" + std::string(text.substr(at, end - at)) + '"');
      return std::nullopt;
    }
    numbers.push_back(number);
    at = end;
  }
  if (numbers.size() >= least && numbers.size() <= most) return numbers;
  faults_.Add("FIL006", place,
              std::to_string(numbers.size()) + " numbers, expected " + CountText(least, most));
  return std::nullopt;
}

std::optional<std::vector<double>> XmlSource::Numbers(const XmlElement& element,
                                                      std::string_view attribute, std::size_t least,
                                                      std::size_t most) const {
  const XmlAttribute* found = element.Attribute(attribute);
  if (found == nullptr) return std::nullopt;
  return Numbers(At(element, attribute), found->value, least, most);
}

std::optional<double> XmlSource::Number(const XmlElement& element,
                                        std::string_view attribute) const {
  const auto numbers = Numbers(element, attribute, 1, 1);
  if (!numbers) return std::nullopt;
  return numbers->front();
}

std::optional<double> XmlSource::RequiredNumber(const XmlElement& element,
                                                std::string_view attribute) const {
  if (!Text(element, attribute)) return std::nullopt;
  return Number(element, attribute);
}

std::optional<Eigen::Vector3d> XmlSource::Vector(const XmlElement& element,
                                                 std::string_view attribute) const {
  const auto numbers = Numbers(element, attribute, 3, 3);
  if (!numbers) return std::nullopt;
  return Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

int LettersApart(std::string_view a, std::string_view b) {
  constexpr int kFar = 3;
  if (a.size() > b.size() + 2 || b.size() > a.size() + 2) return kFar;
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int exchanged = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, exchanged});
    }
  }
  return std::min(row[b.size()], kFar);
}

namespace {

// The known name that this one was meant to be: short names have too many neighbours.
std::string MeantBy(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() < 4 || name.find(':') != std::string_view::npos) return {};
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  const int most = name.size() < 6 ? 1 : 2;
  for (const std::string& other : known) {
    if (other.size() >= 4 && LettersApart(name, other) <= most) return other;
  }
  return {};
}

}  // namespace

void XmlSource::CheckSpelling(const XmlElement& element,
                              std::span<const KnownElement> known) const {
  const auto found = std::find_if(known.begin(), known.end(), [&](const KnownElement& one) {
    return one.name == element.name;
  });
  if (found == known.end()) return;
  for (const XmlAttribute& attribute : element.attributes) {
    const std::string meant = MeantBy(attribute.name, found->attributes);
    if (!meant.empty())
      faults_.Add("FIL009", PlaceOf(file_, element, attribute),
                  attribute.name + ", known is " + meant);
  }
  for (const XmlElement* child : element.children) {
    const std::string meant = MeantBy(child->name, found->children);
    if (!meant.empty())
      faults_.Add("FIL009", At(*child), "<" + child->name + ">, known is <" + meant + ">");
    CheckSpelling(*child, known);
  }
}

}  // namespace doorforge::foreign
