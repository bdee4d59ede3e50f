// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "models/model_xml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 64;
constexpr std::size_t kLongestName = 1024;
constexpr int kMostAttributes = 64;  // the parser compares each with those before it

// The element, and which link, joint or body it is or belongs to.
std::string OwnedName(const XMLElement& element) {
  const auto tag_of = [](const XMLElement& any) { return '<' + std::string(any.Name()) + '>'; };
  const auto name = [](const XMLElement& named) {
    const char* text = named.Attribute("name");
    return text == nullptr ? std::string() : " \"" + std::string(text) + '"';
  };
  const auto owns = [](const XMLElement& owner) {
    const std::string_view tag = owner.Name();
    return tag == "link" || tag == "joint" || tag == "body";
  };
  if (owns(element)) return tag_of(element) + name(element);
  const tinyxml2::XMLNode* node = element.Parent();
  while (node != nullptr && node->ToElement() != nullptr && !owns(*node->ToElement()))
    node = node->Parent();
  if (node == nullptr || node->ToElement() == nullptr) return tag_of(element);
  return tag_of(element) + " of " + node->ToElement()->Name() + name(*node->ToElement());
}

int LineAt(std::string_view text, std::size_t offset) {
  int line = 1;
  for (const char c : text.substr(0, offset)) line += c == '\n' ? 1 : 0;
  return line;
}

// Declarations define entities and name other files; no model needs them.
void RefuseDeclarations(std::string_view text, const ModelSource& source) {
  std::size_t at = 0;
  while ((at = text.find("<!", at)) != std::string_view::npos) {
    const std::string_view rest = text.substr(at);
    const bool comment = rest.starts_with("<!--");
    if (!comment && !rest.starts_with("<![CDATA["))
      source.Stop(LineAt(text, at), "a DOCTYPE or another declaration; remove it");
    const std::size_t end = text.find(comment ? "-->" : "]]>", at);
    if (end == std::string_view::npos) return;  // the parser reports it
    at = end + 3;
  }
}

// It counts those of each element before the parser does, which would take minutes over a million.
void RefuseManyAttributes(std::string_view text, const ModelSource& source) {
  char quote = 0;
  bool in_tag = false;
  int attributes = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const std::string_view rest = text.substr(at);
    if (!in_tag && rest.starts_with("<!")) {  // a comment or CDATA, where tags are text
      at = std::min(text.find(rest.starts_with("<!-") ? "-->" : "]]>", at), text.size());
    } else if (!in_tag) {
      in_tag = c == '<';
      attributes = 0;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=' && ++attributes > kMostAttributes) {
      source.Stop(LineAt(text, at), "an element of more than 64 attributes");
    } else if (c == '>') {
      in_tag = false;
    }
  }
}

// A name is repeated by all that refer to it, as each body does to the one around it.
void RefuseLongNames(const XMLElement& element, const ModelSource& source) {
  for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next()) {
    const std::string_view value = attribute->Value();
    const bool numbers =
        value.find_first_not_of("0123456789+-.eE \t\r\n") == std::string_view::npos;
    if (value.size() > kLongestName && !numbers)
      source.Stop(element.GetLineNum(), TagOf(element) + ": an attribute of " +
                                            std::to_string(value.size()) + " bytes, allowed " +
                                            std::to_string(kLongestName));
  }
}

void RefuseExcess(const XMLElement& element, int depth, const ModelSource& source) {
  if (depth > kMaxDepth)
    source.Stop(element.GetLineNum(), TagOf(element) + ": more than 64 levels of elements");
  RefuseLongNames(element, source);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    RefuseExcess(*child, depth + 1, source);
}

}  // namespace

std::string TagOf(const XMLElement& element) { return '<' + std::string(element.Name()) + '>'; }

void ModelSource::Stop(int line, const std::string& problem) const {
  throw Error(ErrorCode::kFormat, name + ":" + std::to_string(line) + ": " + problem);
}

void ModelSource::Add(UrdfFaultKind kind, const XMLElement& element,
                      const std::string& problem) const {
  faults.push_back({kind, element.GetLineNum(), OwnedName(element) + ": " + problem});
}

void ModelSource::Fail(const XMLElement& element, const std::string& problem) const {
  Add(UrdfFaultKind::kUnusable, element, problem);
}

void ModelSource::RequirePositive(const XMLElement& element, const char* what, double found) const {
  if (!(found > 0))
    Add(UrdfFaultKind::kWrong, element,
        std::string(what) + " is " + Shown(found) + ", allowed above 0");
}

void ModelSource::RequireNotNegative(const XMLElement& element, const char* what,
                                     const std::optional<double>& found) const {
  if (found && *found < 0)
    Add(UrdfFaultKind::kWrong, element,
        std::string(what) + " is " + Shown(*found) + ", allowed 0 and more");
}

std::string ModelSource::Shown(double number) {
  char digits[40];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

const XMLElement& ParseModelXml(const std::string& text, const char* root,
                                const ModelSource& source, tinyxml2::XMLDocument& document) {
  if (text.size() > kMaxModelBytes)
    throw Error(ErrorCode::kFormat, source.name + ": larger than the 16 MiB that a model may have");
  RefuseDeclarations(text, source);
  RefuseManyAttributes(text, source);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    source.Stop(document.ErrorLineNum(),
                "not well-formed XML; each tag needs its end, each value its quotes");
  const XMLElement* found = document.RootElement();
  if (found == nullptr || std::string_view(found->Name()) != root)
    source.Stop(found == nullptr ? 1 : found->GetLineNum(),
                "the root element is not <" + std::string(root) + ">");
  RefuseExcess(*found, 1, source);
  return *found;
}

std::optional<std::vector<double>> NumbersIn(const XMLElement& element, const char* what,
                                             const char* given, const ModelSource& source) {
  const std::string_view text = given;
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \t\r\n", at)) != std::string_view::npos) {
    if (text[at] == '+') ++at;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number)) {
      source.Fail(element, std::string(what) + "=\"" + std::string(text) +
                               "\" holds something that is not a finite number");
      return std::nullopt;
    }
    numbers.push_back(number);
    at = static_cast<std::size_t>(end - text.data());
  }
  return numbers;
}

std::optional<std::vector<double>> Numbers(const XMLElement& element, const char* attribute,
                                           const ModelSource& source) {
  return NumbersIn(element, attribute, element.Attribute(attribute), source);
}

std::optional<std::vector<double>> NumbersOfCount(const XMLElement& element, const char* attribute,
                                                  std::size_t count, const ModelSource& source) {
  auto numbers = Numbers(element, attribute, source);
  if (!numbers || numbers->size() == count) return numbers;
  source.Fail(element, std::string(attribute) + " has " + std::to_string(numbers->size()) +
                           " numbers, expected " + std::to_string(count));
  return std::nullopt;
}

std::optional<double> OptionalNumber(const XMLElement& element, const char* attribute,
                                     const ModelSource& source) {
  if (element.Attribute(attribute) == nullptr) return std::nullopt;
  const auto numbers = NumbersOfCount(element, attribute, 1, source);
  if (!numbers) return std::nullopt;
  return numbers->front();
}

double Number(const XMLElement& element, const char* attribute, const ModelSource& source) {
  if (element.Attribute(attribute) == nullptr)
    source.Fail(element, std::string("missing attribute ") + attribute);
  return OptionalNumber(element, attribute, source).value_or(0);
}

Eigen::Vector3d Vector(const XMLElement& element, const char* attribute,
                       const Eigen::Vector3d& fallback, const ModelSource& source) {
  if (element.Attribute(attribute) == nullptr) return fallback;
  const auto numbers = NumbersOfCount(element, attribute, 3, source);
  return numbers ? Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]) : fallback;
}

std::string Text(const XMLElement& element, const char* attribute, const ModelSource& source) {
  if (const char* text = element.Attribute(attribute)) return text;
  source.Fail(element, std::string("missing attribute ") + attribute);
  return {};
}

const XMLElement* Child(const XMLElement& element, const char* name, const ModelSource& source) {
  const XMLElement* child = element.FirstChildElement(name);
  if (child == nullptr) source.Fail(element, std::string("missing <") + name + ">");
  return child;
}

}  // namespace doorforge::internal
