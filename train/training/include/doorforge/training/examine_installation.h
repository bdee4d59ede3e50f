// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace doorforge {

/// What is installed and whether it is fast enough; measures a matrix product for that.
/// {"schema": "doorforge.doctor", "code_version", "processors", "instruction_sets",
/// "instruction_set", "torch_version", "blas_library", "gflops", "least_gflops", "healthy",
/// "remedy"}, where "remedy" is empty if all is well.
nlohmann::ordered_json ExamineInstallation();

/// Says for people what ExamineInstallation() found.
std::string InstallationText(const nlohmann::ordered_json& found);

}  // namespace doorforge
