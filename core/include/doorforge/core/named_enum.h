// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace doorforge {

/// A value of an enum and the word that stands for it in files and options.
template <class Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};

/// An enum with one table of words beside it, which a function finds by the enum's namespace:
///
///     enum class Shape { kRound, kFlat };
///     inline constexpr NamedValue<Shape> kShapes[] = {{Shape::kRound, "round"},
///                                                     {Shape::kFlat, "flat"}};
///     constexpr std::span<const NamedValue<Shape>> ValuesOf(Shape) { return kShapes; }
///
/// Configs may have fields of such a type: files hold the words, and any other word is refused with
/// those that there are.
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires(Enum value) {
  { ValuesOf(value) } -> std::convertible_to<std::span<const NamedValue<Enum>>>;
};

/// The word for `value`; an empty one if the table has no row for it.
template <NamedEnum Enum>
constexpr std::string_view NameOf(Enum value) {
  for (const NamedValue<Enum>& known : ValuesOf(value)) {
    if (known.value == value) return known.name;
  }
  return {};
}

/// The value that `name` stands for; nothing if no row has that word.
template <NamedEnum Enum>
constexpr std::optional<Enum> ValueNamed(std::string_view name) {
  for (const NamedValue<Enum>& known : ValuesOf(Enum{})) {
    if (known.name == name) return known.value;
  }
  return std::nullopt;
}

/// All words in the order of the table, for help and messages.
template <NamedEnum Enum>
std::vector<std::string> NamesOf() {
  std::vector<std::string> names;
  for (const NamedValue<Enum>& known : ValuesOf(Enum{})) names.emplace_back(known.name);
  return names;
}

}  // namespace doorforge
