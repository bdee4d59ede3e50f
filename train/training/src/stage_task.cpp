// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "stage_task.h"

#include <algorithm>

namespace doorforge::internal {

CloudGeometry GeometryFor(const TrainConfig& config, SampleSet set, const CloudView& cloud,
                          const EncoderQuery& reading) {
  const bool whole = set == SampleSet::kTrain && config.encoder_norm == EncoderNorm::kBatch;
  const InstructionSet instructions = BestInstructionSet();
  return whole ? BuildWholeGeometry(cloud, reading.window, reading.points, instructions)
               : BuildGeometry(cloud, reading.window, reading.points, instructions);
}

std::size_t BatchSize(std::size_t samples, const TrainConfig& config) {
  return std::min(samples, static_cast<std::size_t>(config.batch_size));
}

int PhasesOf(NetworkFamily family) { return family == NetworkFamily::kMotion ? 1 : 2; }

int EpochsOfPhase(const TrainConfig& config, int phase) {
  const bool judges = config.family != NetworkFamily::kMotion && phase == 0;
  return judges && config.discriminator_epochs > 0 ? config.discriminator_epochs : config.epochs;
}

}  // namespace doorforge::internal
