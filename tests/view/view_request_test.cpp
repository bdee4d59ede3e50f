// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/view_request.h"

#include <optional>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

std::optional<ErrorCode> RefusalOf(const ViewRequest& request) {
  try {
    MakeViewPage(request);
  } catch (const Error& error) {
    return error.code();
  }
  return std::nullopt;
}

TEST(MakeViewPage, DoorsBelongToOneDataSet) {
  ViewRequest request;
  request.paths = {"data/one", "data/two"};
  request.doors = {"doors"};
  EXPECT_EQ(RefusalOf(request), ErrorCode::kInvalidArgument);
}

TEST(MakeViewPage, APathThatIsNotThereIsMissing) {
  ViewRequest request;
  request.paths = {"no/such/folder"};
  EXPECT_EQ(RefusalOf(request), ErrorCode::kMissing);
  request.doors = {"doors"};
  EXPECT_EQ(RefusalOf(request), ErrorCode::kMissing) << "no data set either";
}

}  // namespace
}  // namespace doorforge
