// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// With the simulated check; null in a build without the simulation.
std::unique_ptr<DoorValidator> OpenableValidator();

}  // namespace doorforge
