// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that authors assets. It alone links CGAL and is therefore distributed under GPL-3.

#include "doorforge/cli/verb_table.h"

#include "verbs.h"

int main(int argc, char** argv) {
  using namespace doorforge;  // NOLINT
  constexpr Verb kVerbs[] = {
      {"catalog", RunCatalogVerb},
      {"compose", RunComposeVerb},
      {"conformance", RunConformanceVerb},
      {"export", RunExportVerb},
      {"import", RunImportVerb},
#ifdef DOORFORGE_WITH_PREVIEW
      {"preview", RunPreviewVerb},
#endif
      {"repair", RunRepairVerb},
      {"validate", RunValidateVerb},
#ifdef DOORFORGE_WITH_VIEW
      {"serve", RunServeVerb},
      {"view", RunViewVerb},
#endif
  };
  return RunVerbs(kVerbs, argc, argv);
}
