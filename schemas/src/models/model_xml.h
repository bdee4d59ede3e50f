// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "doorforge/schemas/urdf.h"

// What the readers of URDF, MJCF and SDF share.

namespace doorforge::internal {

inline constexpr std::uint64_t kMaxModelBytes = 16ULL << 20;
inline constexpr std::size_t kMaxModelElements =
    2000;  ///< A model has at most so many links, and joints.

/// "<tag>".
std::string TagOf(const tinyxml2::XMLElement& element);

/// The file that is read, and what is wrong with it so far.
struct ModelSource {
  std::string name;
  std::vector<UrdfFault>& faults;

  /// Throws Error(kFormat), where reading on makes no sense.
  [[noreturn]] void Stop(int line, const std::string& problem) const;
  void Add(UrdfFaultKind kind, const tinyxml2::XMLElement& element,
           const std::string& problem) const;
  void Fail(const tinyxml2::XMLElement& element, const std::string& problem) const;
  void RequirePositive(const tinyxml2::XMLElement& element, const char* what, double found) const;
  void RequireNotNegative(const tinyxml2::XMLElement& element, const char* what,
                          const std::optional<double>& found) const;
  static std::string Shown(double number);
};

/// Parses a text within the limits of ReadUrdf() and gives its root, which must be called `root`.
/// Throws Error(kFormat).
const tinyxml2::XMLElement& ParseModelXml(const std::string& text, const char* root,
                                          const ModelSource& source,
                                          tinyxml2::XMLDocument& document);

/// Nothing, and a fault, where one of them is no finite number.
std::optional<std::vector<double>> NumbersIn(const tinyxml2::XMLElement& element, const char* what,
                                             const char* text, const ModelSource& source);
std::optional<std::vector<double>> Numbers(const tinyxml2::XMLElement& element,
                                           const char* attribute, const ModelSource& source);
std::optional<std::vector<double>> NumbersOfCount(const tinyxml2::XMLElement& element,
                                                  const char* attribute, std::size_t count,
                                                  const ModelSource& source);
std::optional<double> OptionalNumber(const tinyxml2::XMLElement& element, const char* attribute,
                                     const ModelSource& source);
/// 0, and a fault, where it is missing; so do all that must be there.
double Number(const tinyxml2::XMLElement& element, const char* attribute,
              const ModelSource& source);
Eigen::Vector3d Vector(const tinyxml2::XMLElement& element, const char* attribute,
                       const Eigen::Vector3d& fallback, const ModelSource& source);
std::string Text(const tinyxml2::XMLElement& element, const char* attribute,
                 const ModelSource& source);
const tinyxml2::XMLElement* Child(const tinyxml2::XMLElement& element, const char* name,
                                  const ModelSource& source);

}  // namespace doorforge::internal
