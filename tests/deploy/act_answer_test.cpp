// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/deploy/act_answer.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

TEST(SetHolds, ANumberSwitchesAHoldOnAndOffSwitchesItOff) {
  HoldConfig config{.foreign = false};
  SetHolds("95.5", "0.25", config);
  EXPECT_TRUE(config.foreign);
  EXPECT_EQ(config.foreign_percentile, 95.5);
  EXPECT_EQ(config.least_gain_rad, 0.25);
  EXPECT_EQ(config.least_door_angle_rad, 0.25);
  SetHolds("off", "", config);
  EXPECT_FALSE(config.foreign);
  EXPECT_EQ(config.foreign_percentile, 95.5);
  EXPECT_TRUE(config.gain);
}

TEST(SetHolds, WhatIsNoNumberIsRefusedWithTheOption) {
  for (const char* word : {"of", "1x", "inf", "nan"}) {
    HoldConfig config;
    try {
      SetHolds("", word, config);
      ADD_FAILURE() << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      EXPECT_NE(std::string(error.what()).find("--least-gain"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace doorforge
