// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge::foreign {

struct XmlAttribute {
  std::string name;
  std::string value;  ///< With references replaced.
  int line = 0;
  int column = 0;
};

/// An element of an XML document, with the place of its "<".
struct XmlElement {
  std::string name;
  std::vector<XmlAttribute> attributes;
  std::vector<const XmlElement*> children;
  std::string text;  ///< Character data directly in it, all pieces together.
  std::string step;  ///< Its part of XPathOf(), with the "/".
  const XmlElement* parent = nullptr;
  int line = 0;
  int column = 0;

  const XmlAttribute* Attribute(std::string_view wanted) const;
  const XmlElement* Child(std::string_view wanted) const;  ///< The first one, or null.
};

/// Elements stay where they are, so pointers to them hold as long as the document.
struct XmlDocument {
  std::deque<XmlElement> elements;
  const XmlElement* root = nullptr;
};

enum class XmlFaultKind { kNotWellFormed, kDeclaration, kLimit };

/// Why a text is no XML that is read.
struct XmlFault : std::runtime_error {
  XmlFault(XmlFaultKind fault_kind, int at_line, int at_column, const std::string& problem)
      : std::runtime_error(problem), kind(fault_kind), line(at_line), column(at_column) {}

  XmlFaultKind kind;
  int line;
  int column;
};

struct XmlLimits {
  std::size_t depth = 64;
  std::size_t elements = 200'000;
  std::size_t attributes = 64;    ///< One element has at most so many.
  std::size_t name_bytes = 1024;  ///< A value that is no list of numbers has at most so many.
};

/// Parses XML 1.0 (its productions for documents without a DOCTYPE) in UTF-8. It does not recurse.
/// Throws XmlFault at the first violation, at a DOCTYPE, and at a limit.
XmlDocument ParseXml(std::string_view text, const XmlLimits& limits = {});

/// "/robot/joint[@name='hinge']/limit": unique names stand for themselves, others have their number
/// among the siblings of that name.
std::string XPathOf(const XmlElement& element);

}  // namespace doorforge::foreign
