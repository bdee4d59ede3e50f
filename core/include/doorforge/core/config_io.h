// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/named_enum.h"

// Reading and writing of config structs. Include this from source files only: config structs
// themselves need no JSON header.

namespace doorforge {

/// A config is an aggregate with defaults and one function that names its fields in order:
///
///     template <class Self, class Visitor>
///     static void VisitFields(Self& self, Visitor&& visit) {
///       visit("cell_size_m", self.cell_size_m);
///     }
template <class T>
concept Config = requires(T& t) {
  T::VisitFields(t, [](std::string_view, auto&) {});
};

namespace internal {

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

// Throws Error with kInvalidConfig; `path` names the field, such as "repair.weld.cell_size_m".
[[noreturn]] void ThrowConfigError(const std::string& path, const std::string& problem);
[[noreturn]] void ThrowUnknownKey(const std::string& path, const std::string& key,
                                  const std::vector<std::string>& known);
[[noreturn]] void ThrowUnknownName(const std::string& path, const std::string& name,
                                   const std::vector<std::string>& allowed);
// The entries of one object that another of the same keys has otherwise, of objects in it likewise.
nlohmann::ordered_json Difference(const nlohmann::ordered_json& object,
                                  const nlohmann::ordered_json& from);

}  // namespace internal

/// Throws Error(kInvalidConfig) that names the field `name` of `path`, what was found and what is
/// allowed, unless low <= value <= high.
void RequireRange(const std::string& path, const char* name, double value, double low, double high);

/// Returns every field of `value` in declaration order, defaults included.
template <class T>
nlohmann::ordered_json ToJson(const T& value) {
  if constexpr (Config<const T>) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    T::VisitFields(value, [&](std::string_view name, const auto& field) {
      json[std::string(name)] = ToJson(field);
    });
    return json;
  } else if constexpr (internal::IsVector<T>::value) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const auto& element : value) json.push_back(ToJson(element));
    return json;
  } else if constexpr (NamedEnum<T>) {
    return std::string(NameOf(value));
  } else {
    return value;
  }
}

/// Overwrites the fields named in `json`; all others keep their value.
///
/// @param path Name of `value` in error messages, such as "repair".
/// @throws Error with kInvalidConfig on an unknown key, a value of the wrong type, an integer that
///     does not fit, or a word that the table of an enum does not have.
template <class T>
void Assign(const nlohmann::ordered_json& json, T& value, const std::string& path) {
  if constexpr (Config<T>) {
    if (!json.is_object()) internal::ThrowConfigError(path, "expected an object");
    std::size_t known = 0;
    T::VisitFields(value, [&](std::string_view name, auto& field) {
      const auto entry = json.find(std::string(name));
      if (entry == json.end()) return;
      ++known;
      Assign(*entry, field, (path + ".").append(name));
    });
    if (known == json.size()) return;
    std::vector<std::string> fields;
    T::VisitFields(value, [&](std::string_view name, auto&) { fields.emplace_back(name); });
    for (const auto& [key, unused] : json.items()) {
      if (std::find(fields.begin(), fields.end(), key) == fields.end())
        internal::ThrowUnknownKey(path, key, fields);
    }
  } else if constexpr (internal::IsVector<T>::value) {
    if (!json.is_array()) internal::ThrowConfigError(path, "expected an array");
    value.assign(json.size(), {});
    for (std::size_t i = 0; i < json.size(); ++i) {
      Assign(json[i], value[i], (path + "[").append(std::to_string(i)).append("]"));
    }
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    // json.get<int>() would truncate 2.7 to 2 and wrap numbers that do not fit
    if (!json.is_number_integer()) internal::ThrowConfigError(path, "expected an integer");
    const bool fits = json.is_number_unsigned() ? std::in_range<T>(json.get<std::uint64_t>())
                                                : std::in_range<T>(json.get<std::int64_t>());
    if (!fits) internal::ThrowConfigError(path, "integer out of range");
    value = json.get<T>();
  } else if constexpr (NamedEnum<T>) {
    const std::string name = json.is_string() ? json.get<std::string>() : json.dump();
    const std::optional<T> named = ValueNamed<T>(name);
    if (!named) internal::ThrowUnknownName(path, name, NamesOf<T>());
    value = *named;
  } else {
    try {
      value = json.get<T>();
    } catch (const nlohmann::json::exception&) {
      internal::ThrowConfigError(path, "wrong type");
    }
  }
}

/// Overwrites the fields of `value` that `given` has otherwise than `unset`, a value whose fields
/// all say "not given": how the options of a command line go before a file of settings.
template <class T>
void AssignGiven(const T& given, const T& unset, T& value) {
  Assign(internal::Difference(ToJson(given), ToJson(unset)), value, "options");
}

}  // namespace doorforge
