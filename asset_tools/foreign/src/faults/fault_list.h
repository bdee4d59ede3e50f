// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/foreign/articulated_object.h"
#include "doorforge/validate/validate_door.h"

#include "text/xml_text.h"

namespace doorforge::foreign {

/// What a finding says was measured, in words and, where it is one, as a number.
struct Measured {
  Measured(std::string says) : text(std::move(says)) {}  // NOLINT: words alone are the usual case
  Measured(const char* says) : text(says) {}             // NOLINT
  Measured(double number, std::string of_unit);

  std::string text;
  std::optional<double> value;
  std::string unit;
};

/// What is said of a name that leads to a pipe, a device or a folder.
inline constexpr const char* kNoRegularFile = "not a regular file";

/// The findings about one file. Those beyond kMost of one rule are counted and told in one.
class FaultList {
 public:
  static constexpr int kMost = 200;

  void Add(std::string_view code, const SourcePlace& place, const Measured& measured);
  /// The order is that of the codes in ForeignRules(), then of lines; nothing is repeated.
  std::vector<Finding> Sorted() const;
  bool HasError() const;
  bool Has(std::string_view code) const;
  bool Says(std::string_view words) const;  ///< Whether a finding says them of what it measured.

  /// For a list that another process sent, which is not trusted: what its rules say is put in
  /// place, and its texts are made fit for a terminal. False where a finding is of no rule.
  bool Restore();

  template <class Message>
  friend void Exchange(Message& message, FaultList& faults) {
    message(faults.findings_, faults.counts_);
  }

 private:
  std::vector<Finding> findings_;
  std::map<std::string, int, std::less<>> counts_;  // by code, of all
};

/// At most 300 bytes of a text, without what a terminal obeys.
std::string Printable(const std::string& text);

/// Six significant digits.
std::string Digits(double value);

/// "file:3: /robot/link[@name='a']", as far as the place says.
std::string WhereOf(const SourcePlace& place);

SourcePlace PlaceOf(const std::string& file, const XmlElement& element);
SourcePlace PlaceOf(const std::string& file, const XmlElement& element,
                    const XmlAttribute& attribute);

}  // namespace doorforge::foreign
