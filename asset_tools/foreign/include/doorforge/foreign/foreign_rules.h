// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// The rules for files from outside that doors do not have. Families: FIL the file and its words,
/// GLB and USD the structure of those, TRE links and joints as a tree, JNT joints, INR006 and
/// later masses, GEO shapes and meshes, EXT other programs, PRF
/// targets. Codes are never reused.
std::span<const ValidationRule> ForeignRules();

/// Those of doors and those for files from outside.
const std::vector<ValidationRule>& AllRules();

/// Throws Error(kInvalidArgument), with the nearest one that there is, where no rule has the code.
const ValidationRule& AnyRule(std::string_view code);

/// A page of the documentation, with the anchor of the rule's family.
std::string RuleHelpUri(std::string_view code);

}  // namespace doorforge
