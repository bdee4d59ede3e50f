// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Collects a data set of the stage "open" on doors that were composed before, and checks it:
//
//   doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out doors/one
//   collect_dataset doors data
//
// The folder is the one that `doorforge datagen open` would have written with the same settings;
// given again, the program goes on where it was.

#include <cstdio>
#include <exception>

#include "doorforge/collect/collect_stage.h"
#include "doorforge/dataset/verify_dataset.h"

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: collect_dataset DOORS OUT\n"), 2;
  doorforge::CollectStageRequest request;
  request.stage.config = doorforge::DefaultsOf(doorforge::Stage::kOpen);
  request.stage.config.episodes = 4;
  request.stage.config.seed = 7;
  request.stage.config.cloud.point_count = 1024;
  request.stage.doors = {argv[1]};
  request.out = argv[2];
  request.warn = [](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); };
  const doorforge::CollectSummary summary = doorforge::CollectStage(request);
  if (summary.stopped_by_signal != 0) return 128 + summary.stopped_by_signal;

  const auto findings = doorforge::VerifyDataset({request.out, /*threads=*/0, {}});
  std::printf("%d of %d episodes opened their door\n%s", static_cast<int>(summary.written),
              static_cast<int>(summary.planned),
              doorforge::FindingsText(findings, request.out).c_str());
  return summary.written > 0 && !doorforge::AnyFault(findings) ? 0 : 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "collect_dataset: %s\n", error.what()), 3;
}
