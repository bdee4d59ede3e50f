# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D SOURCE=DIR -D VERSION=X.Y.Z -D OUTPUT=FILE -P write_code_version.cmake
# Writes the source that names this build. Run by every build: a commit after configuring must not leave data sets
# and policies that name the commit before it. The file is touched only where its text changes.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=10 HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
                OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(changes)
  string(APPEND commit "-modified")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "doorforge/core/program.h"

namespace doorforge {

std::string CodeVersion() { return "@VERSION@+@commit@"; }

}  // namespace doorforge
]])
