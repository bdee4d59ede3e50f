// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "doorforge/composer/composer.h"

namespace doorforge {

/// Serves the composer's page and its answers by HTTP at 127.0.0.1 until a stop is requested (see
/// StopRequested()).
///
/// Other machines cannot reach it, and pages of others may not use it: a request whose Host is not
/// 127.0.0.1 or localhost with this port, or whose Origin is another one, is refused (403), and so
/// is a body of more than 64 KiB (413), of another type than application/json (415), without a
/// length (411), compressed or in chunks (415). A dropped file comes as application/octet-stream to
/// /file?name=, of at most 64 MiB. What is wrong with a request is answered as {"error": message}
/// and ends nothing.
///
/// @param port 1024 to 65535; 0: any that is free.
/// @param ready Called once with the address, such as "http://127.0.0.1:8765/".
/// @throws Error(kIo) if the port is taken.
void ServeComposer(Composer& composer, int port,
                   const std::function<void(const std::string&)>& ready);

}  // namespace doorforge
