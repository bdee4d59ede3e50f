// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/train_config.h"

namespace doorforge {

EncoderNorm NormOf(const TrainConfig& config) {
  return config.encoder_norm == "batch" ? EncoderNorm::kBatch : EncoderNorm::kNone;
}

}  // namespace doorforge
