// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "faults/fault_list.h"

namespace doorforge::foreign {

/// What an element may hold, for the search for misspelt names.
struct KnownElement {
  std::string_view name;
  std::vector<std::string> attributes;
  std::vector<std::string> children;
};

/// An XML file that is read, and the faults of its text. What cannot be read is absent, and told.
class XmlSource {
 public:
  XmlSource(std::string file, FaultList& faults) : file_(std::move(file)), faults_(faults) {}

  const std::string& file() const { return file_; }
  FaultList& faults() const { return faults_; }
  SourcePlace At(const XmlElement& element) const { return PlaceOf(file_, element); }
  /// The attribute's place, or the element's where it has none of that name.
  SourcePlace At(const XmlElement& element, std::string_view attribute) const;

  /// FIL007 where a required one is missing.
  std::optional<std::string> Text(const XmlElement& element, std::string_view attribute,
                                  bool required = true) const;
  const XmlElement* Child(const XmlElement& element, std::string_view name) const;

  /// Finite numbers apart by blanks, at least `least` and at most `most`; FIL006 where they are
  /// not.
  std::optional<std::vector<double>> Numbers(const SourcePlace& place, std::string_view text,
                                             std::size_t least, std::size_t most) const;
  std::optional<std::vector<double>> Numbers(const XmlElement& element, std::string_view attribute,
                                             std::size_t least, std::size_t most) const;
  std::optional<double> Number(const XmlElement& element, std::string_view attribute) const;
  std::optional<double> RequiredNumber(const XmlElement& element, std::string_view attribute) const;
  std::optional<Eigen::Vector3d> Vector(const XmlElement& element,
                                        std::string_view attribute) const;

  /// FIL009 for names that are one or two letters off one that is known.
  void CheckSpelling(const XmlElement& element, std::span<const KnownElement> known) const;

 private:
  std::string file_;
  FaultList& faults_;
};

/// Letters to insert, drop or exchange between them, or 3 if more.
int LettersApart(std::string_view a, std::string_view b);

}  // namespace doorforge::foreign
