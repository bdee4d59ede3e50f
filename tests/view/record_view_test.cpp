// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "record_view.h"

#include <gtest/gtest.h>

namespace doorforge::internal {
namespace {

const std::vector<std::string> kNames = {"hinge", "handle_joint", "frame", "base",
                                         "leaf",  "rose",         "grip",  "handle"};

using Names = std::vector<std::string>;

TEST(PlacesOf, NamesWhatTheFindingIsAbout) {
  EXPECT_EQ(PlacesOf("door.json: meshes/visual/grip.obj", kNames), Names{"grip"});
  EXPECT_EQ(PlacesOf("door.json: links[leaf].geometry[rose]", kNames), (Names{"leaf", "rose"}));
  EXPECT_EQ(PlacesOf("model.urdf: /robot/joint[@name='hinge']/axis", kNames), Names{"hinge"});
  EXPECT_EQ(PlacesOf("door.json: handle_joint.axis", kNames), Names{"handle_joint"});
}

TEST(PlacesOf, TakesNoPartOfAWordForAName) {
  EXPECT_EQ(PlacesOf("door.json: leaflet, griper, primrose", kNames), Names{});
  EXPECT_EQ(PlacesOf("door.json: latch", kNames), Names{});
}

TEST(PlacesOf, KnowsThePieceOfACollisionShape) {
  EXPECT_EQ(PlacesOf("door.json: meshes/collision/leaf_12.obj", kNames), Names{"leaf"});
  EXPECT_EQ(PlacesOf("door.json: meshes/collision/leaf_x.obj", kNames), Names{});
}

}  // namespace
}  // namespace doorforge::internal
