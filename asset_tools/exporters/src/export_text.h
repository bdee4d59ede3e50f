// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/schemas/door_asset.h"

// Pieces that the exporters share.

namespace doorforge::internal {

/// Shortest decimals that read back to the same double.
std::string Decimal(double value);
/// Writes each value as Decimal() does, with `separator` between them.
std::string Decimals(const Eigen::Ref<const Eigen::VectorXd>& values,
                     const std::string& separator = " ");

/// An element of an XML text that is being written. References to children stay valid.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes = {};
  std::list<XmlElement> children = {};
  std::string text = {};  ///< In place of children.
};

XmlElement& AddElement(XmlElement& parent, const char* name);
XmlElement& AddText(XmlElement& parent, const char* name, const std::string& text);
void SetAttribute(XmlElement& element, const char* name, const std::string& value);
/// With declaration and indentation; markup characters are escaped.
std::string Printed(const XmlElement& root);

/// What a link is called by whoever tells things apart by words: "frame", "leaf" or "handle".
const char* LabelOf(DoorLinkIndex link);

/// Light of a channel as a screen shows it (IEC 61966-2-1).
double LinearLight(double srgb);

/// Whether some triangle is there both ways round: then each side has a look of its own, and
/// renderers should draw none from behind.
bool HasTwoSides(const VisualMesh& mesh);

/// Whether the joint turns; else it is written as a rigid connection.
bool Turns(const DoorJoint& joint);

}  // namespace doorforge::internal
