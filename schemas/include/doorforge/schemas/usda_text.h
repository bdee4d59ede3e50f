// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge {

/// A value as it is written: tuples and arrays are flat.
struct UsdaValue {
  std::vector<double> numbers;
  std::vector<std::string> texts;   ///< Strings and bare words.
  std::vector<std::string> assets;  ///< Between `@`.
  std::vector<std::string> paths;   ///< Between `<` and `>`.
};

/// An attribute, a relationship or an entry of metadata, by its name without its type.
struct UsdaProperty {
  std::string name;
  UsdaValue value;
  int line = 0;
  int column = 0;
};

struct UsdaPrim {
  std::string type;  ///< "Mesh"; may be empty.
  std::string name;
  std::string path;  ///< "/door/leaf"
  std::vector<UsdaProperty> metadata;
  std::vector<UsdaProperty> properties;
  const UsdaPrim* parent = nullptr;
  bool defined = false;  ///< `def`, not `over` or `class`.
  int line = 0;
  int column = 0;

  const UsdaProperty* Property(std::string_view wanted) const;
  const UsdaProperty* Metadata(std::string_view wanted) const;
  bool HasApi(std::string_view schema) const;
};

struct UsdaStage {
  std::vector<UsdaProperty> metadata;
  std::deque<UsdaPrim> prims;  ///< Parents before children.
};

struct UsdaFault : std::runtime_error {
  UsdaFault(int at_line, int at_column, bool is_limit, const std::string& problem)
      : std::runtime_error(problem), line(at_line), column(at_column), limit(is_limit) {}
  int line;
  int column;
  bool limit;
};

/// Parses USD's text form, version 1.0: prims with their metadata and properties. What time
/// samples, variants and dictionaries hold is parsed and not kept. Throws UsdaFault at the first
/// violation.
UsdaStage ParseUsda(std::string_view text);

}  // namespace doorforge
