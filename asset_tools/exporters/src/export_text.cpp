// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "export_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

namespace doorforge::internal {

std::string Decimal(double value) {
  char digits[32];
  // + 0.0 turns -0 into 0
  const auto end = std::to_chars(digits, digits + sizeof digits, value + 0.0).ptr;
  return {digits, end};
}

std::string Decimals(const Eigen::Ref<const Eigen::VectorXd>& values,
                     const std::string& separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + Decimal(value);
  return text;
}

XmlElement& AddElement(XmlElement& parent, const char* name) {
  return parent.children.emplace_back(XmlElement{.name = name});
}

XmlElement& AddText(XmlElement& parent, const char* name, const std::string& text) {
  XmlElement& element = AddElement(parent, name);
  element.text = text;
  return element;
}

void SetAttribute(XmlElement& element, const char* name, const std::string& value) {
  element.attributes.emplace_back(name, value);
}

namespace {

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

void Print(const XmlElement& element, std::size_t depth, std::string& xml) {
  const std::string indent(depth * 2, ' ');
  xml += indent + "<" + element.name;
  for (const auto& [name, value] : element.attributes)
    xml.append(" ").append(name).append("=\"").append(Escaped(value)).append("\"");
  if (element.children.empty() && element.text.empty()) {
    xml += "/>\n";
    return;
  }
  xml += ">" + Escaped(element.text);
  if (!element.children.empty()) xml += "\n";
  for (const XmlElement& child : element.children) Print(child, depth + 1, xml);
  xml += (element.children.empty() ? "" : indent) + "</" + element.name + ">\n";
}

}  // namespace

std::string Printed(const XmlElement& root) {
  std::string xml = "<?xml version=\"1.0\"?>\n";
  Print(root, 0, xml);
  return xml;
}

const char* LabelOf(DoorLinkIndex link) {
  return link == kBaseLink ? "frame" : link == kLeafLink ? "leaf" : "handle";
}

double LinearLight(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

bool HasTwoSides(const VisualMesh& mesh) {
  using Place = std::array<double, 3>;
  std::map<std::array<Place, 3>, bool> turns_of;  // places in order, and how the triangle turns
  for (const VisualSurface& surface : mesh.surfaces) {
    for (const Eigen::Vector3i& t : surface.triangles) {
      std::array<Place, 3> places{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& v = mesh.vertices[static_cast<std::size_t>(t[static_cast<int>(k)])];
        places[k] = {v.x(), v.y(), v.z()};
      }
      const bool turn =
          (places[0] < places[1]) == ((places[1] < places[2]) == (places[0] < places[2]));
      std::sort(places.begin(), places.end());
      const auto [entry, is_new] = turns_of.try_emplace(places, turn);
      if (!is_new && entry->second != turn) return true;
    }
  }
  return false;
}

bool Turns(const DoorJoint& joint) { return joint.upper_rad > joint.lower_rad; }

}  // namespace doorforge::internal
