// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// doorforge-read-model and doorforge-second-opinion, which other programs start; see
// answer_parent.h.

#include "doorforge/foreign/answer_parent.h"

int main(int argc, char** argv) {
  return doorforge::foreign::AnswerParent({argv, static_cast<std::size_t>(argc)});
}
