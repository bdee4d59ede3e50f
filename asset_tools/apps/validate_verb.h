// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// `doorforge validate PATH...`. argv[0] is the verb. Returns 0 without errors, 1 with errors, 3 if
/// a path could not be read (the others are validated all the same).
int RunValidateVerb(int argc, char** argv);

/// With the simulated check; null in a build without the simulation.
std::unique_ptr<DoorValidator> OpenableValidator();

}  // namespace doorforge
