// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/core/shape_descriptor.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

/// Which part a door was made of, for whoever must tell whether two doors share one.
struct PartIdentity {
  std::string id;
  std::string sha256;          ///< ContentHash of the part.
  ShapeDescriptor shape = {};  ///< Empty in records of earlier versions.

  /// Whether both are one part, which has the same id, the same content or the same shape: a real
  /// data set repeats parts at another size under other ids.
  bool SameAs(const PartIdentity& other) const;
};

PartIdentity IdentityOf(const Part& part);

/// {"id", "sha256", "shape"}.
nlohmann::ordered_json IdentityToJson(const PartIdentity& identity);
/// Throws Error(kFormat). A record without "shape" is read as one of unknown shape.
PartIdentity IdentityFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
