// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"

namespace doorforge {

/// The unit that the end of a field's name says: "m" of "width_m"; empty without one.
std::string UnitOfName(std::string_view name);

/// What Assign() takes for a value of T: types, words of enums, keys (all may be left out, no other
/// may be there), and as "default" what the fields of `defaults` hold. What a program refuses
/// beyond that, such as a number out of its range, it says where the setting is used.
template <class T>
nlohmann::ordered_json FieldSchema(const T& defaults) {
  nlohmann::ordered_json schema;
  if constexpr (Config<const T>) {
    schema = {{"type", "object"}, {"properties", nlohmann::ordered_json::object()}};
    // Reading visits fields that writing leaves out, so a copy that may be written to is visited.
    T fields = defaults;
    T::VisitFields(fields, [&](std::string_view name, const auto& field) {
      nlohmann::ordered_json& property = schema["properties"][std::string(name)];
      property = FieldSchema(field);
      const std::string unit = UnitOfName(name);
      if (!unit.empty()) property["description"] = "unit: " + unit;
    });
    schema["additionalProperties"] = false;
  } else if constexpr (internal::IsVector<T>::value) {
    schema = {{"type", "array"},
              {"items", FieldSchema(typename T::value_type{})},
              {"default", ToJson(defaults)}};
    schema["items"].erase("default");
  } else {
    if constexpr (NamedEnum<T>)
      schema = {{"type", "string"}, {"enum", NamesOf<T>()}};
    else if constexpr (std::is_same_v<T, bool>)
      schema = {{"type", "boolean"}};
    else if constexpr (std::is_integral_v<T>)
      schema = {{"type", "integer"}};
    else if constexpr (std::is_arithmetic_v<T>)
      schema = {{"type", "number"}};
    else
      schema = {{"type", "string"}};
    if constexpr (std::is_unsigned_v<T> && !std::is_same_v<T, bool>) schema["minimum"] = 0;
    schema["default"] = ToJson(defaults);
  }
  return schema;
}

/// The JSON Schema, draft 2020-12, of a file of settings that LoadConfig<T>() reads.
template <Config T>
nlohmann::ordered_json SettingsSchema(const std::string& title, const T& defaults = {}) {
  nlohmann::ordered_json whole = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                                  {"title", title}};
  whole.update(FieldSchema(defaults));
  return whole;
}

}  // namespace doorforge
