// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// `doorforge doctor`; argv[0] is "doctor". Returns the exit code.
int RunDoctorVerb(int argc, char** argv);

}  // namespace doorforge
