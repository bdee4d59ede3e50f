// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "run/read_text.h"
#include "run/second_opinion.h"

namespace doorforge::foreign {

struct TextReadApart {
  TextRead read;
  FaultList faults;
  std::optional<SecondOpinion> urdfdom;  ///< If it was to be asked, and the file is for it.
};

/// ReadText() in the program doorforge-read-model, which may open the file and what lies below the
/// places alone. urdfdom is asked by the same process, afterwards, since to start one takes longer
/// than either. Throws Error(kFormat) where the file takes more than the process may,
/// Error(kMissing) without that program.
TextReadApart ReadTextApart(const std::filesystem::path& file, const MeshFiles::Places& places,
                            bool ask_urdfdom);

}  // namespace doorforge::foreign
