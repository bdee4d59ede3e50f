// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge {

/// argv[0] is the verb, the result the exit code.
int RunTrainVerb(int argc, char** argv);   ///< `doorforge train STAGE`
int RunDoctorVerb(int argc, char** argv);  ///< `doorforge doctor`

}  // namespace doorforge
