// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// doorforge-second-opinion, which asks another program's library about a file; see
// second_opinion.h.

#include "doorforge/foreign/second_opinion_process.h"

int main(int argc, char** argv) {
  return doorforge::foreign::GiveOpinion({argv, static_cast<std::size_t>(argc)});
}
