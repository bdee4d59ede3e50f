// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz_target.h"

namespace doorforge::fuzz {

/// Changes the first `size` bytes of a buffer, which may grow to the whole of it, and returns how
/// many there are then. One seed makes one change, but for what libFuzzer remembers.
std::size_t Mutate(Shape shape, std::span<std::uint8_t> buffer, std::size_t size, unsigned seed);

}  // namespace doorforge::fuzz
