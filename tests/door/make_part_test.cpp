// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/make_part.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

#include "small_parts.h"

namespace doorforge {
namespace {

// wraps coarsely, in a moment
MakePartConfig Coarse(int threads) {
  MakePartConfig config;
  config.repair.alpha_fraction = 0.1;
  config.threads = threads;
  return config;
}

PartDraft BoxBody() {
  PartDraft draft;
  draft.facts.id = "box";
  draft.facts.license = "CC0-1.0";
  draft.pieces = {{"frame", BoxMesh({-0.05, 0.81, 0}, {0.05, 0.9, 2}), {1, 0, 0, 1}},
                  {"leaf", BoxMesh({-0.02, 0, 0}, {0.02, 0.8, 2}), {0, 1, 0, 1}}};
  return draft;
}

TEST(MakePart, ClosesPiecesAndFindsMassAndHulls) {
  const MadePart made = MakePart(BoxBody(), {});
  ASSERT_TRUE(made.part.has_value()) << ProblemOf(made);
  const PartPiece& leaf = *FindPiece(*made.part, "leaf");
  // 0.04 x 0.8 x 2 m at 350 kg/m3
  EXPECT_NEAR(leaf.mass.mass_kg, 22.4, 1e-4);
  EXPECT_NEAR(leaf.mass.center_of_mass_m.y(), 0.4, 1e-6);
  EXPECT_EQ(leaf.hulls.size(), 1U);
  EXPECT_EQ(leaf.color_rgba, Eigen::Vector4d(0, 1, 0, 1));
  EXPECT_EQ(made.pieces[1].repair.outcome, RepairOutcome::kAlreadyClosed);
}

TEST(MakePart, AnOpenBoxIsClosed) {
  PartDraft draft = BoxBody();
  draft.pieces[1].mesh = BoxMesh({-0.02, 0, 0}, {0.02, 0.08, 0.1});
  draft.pieces[1].mesh.triangles.pop_back();
  const MadePart made = MakePart(draft, Coarse(0));
  ASSERT_TRUE(made.part.has_value()) << ProblemOf(made);
  EXPECT_TRUE(ClosedMesh::From(FindPiece(*made.part, "leaf")->mesh).has_value());
  EXPECT_NE(made.pieces[1].repair.outcome, RepairOutcome::kAlreadyClosed);
}

// The cap over the open edge lies 1.4 % of the diagonal from the drawn faces.
TEST(MakePart, ALeafDrawnHollowBecomesSolid) {
  PartDraft draft = BoxBody();
  draft.pieces[1].mesh = BoxMesh({-0.03, 0, 0}, {0.03, 0.6, 2});
  TriangleMesh& leaf = draft.pieces[1].mesh;
  std::erase_if(leaf.triangles, [&](const Eigen::Vector3i& t) {
    return leaf.vertices[static_cast<std::size_t>(t[0])].z() +
               leaf.vertices[static_cast<std::size_t>(t[1])].z() +
               leaf.vertices[static_cast<std::size_t>(t[2])].z() ==
           0;
  });
  ASSERT_EQ(leaf.triangles.size(), 10U);
  const MadePart made = MakePart(draft, {});
  ASSERT_TRUE(made.part.has_value()) << ProblemOf(made);
  EXPECT_EQ(made.pieces[1].repair.holes_filled, 1);
  // 0.06 x 0.6 x 2 m at 350 kg/m3
  EXPECT_NEAR(FindPiece(*made.part, "leaf")->mass.mass_kg, 25.2, 1e-3);
}

TEST(MakePart, KeepsMassesWhereARobotCanMoveThem) {
  PartDraft draft = BoxBody();
  draft.pieces[1].mesh = BoxMesh({-0.3, 0, 0}, {0.3, 2, 3});
  const MadePart made = MakePart(draft, {});
  ASSERT_TRUE(made.part.has_value());
  EXPECT_DOUBLE_EQ(FindPiece(*made.part, "leaf")->mass.mass_kg, 30);
  EXPECT_TRUE(made.pieces[1].mass_limited);
}

TEST(MakePart, APartReadBackIsThePartInMemory) {
  const std::filesystem::path folder = TestFolder("make_part_round_trip");
  PartDraft draft = BoxBody();
  for (Eigen::Vector3d& vertex : draft.pieces[1].mesh.vertices)
    vertex += Eigen::Vector3d(0.1, 1.0 / 3, 0.7);
  const MadePart made = MakePart(draft, {});
  ASSERT_TRUE(made.part.has_value());
  WritePart(*made.part, folder);
  EXPECT_EQ(ContentHash(ReadPart(folder)), ContentHash(*made.part));
}

TEST(MakePart, DoesNotDependOnTheNumberOfThreads) {
  PartDraft draft = BoxBody();
  draft.pieces[1].mesh = BoxMesh({-0.02, 0, 0}, {0.02, 0.08, 0.1});
  draft.pieces[1].mesh.triangles.pop_back();
  EXPECT_EQ(ContentHash(*MakePart(draft, Coarse(1)).part),
            ContentHash(*MakePart(draft, Coarse(2)).part));
}

TEST(MakePart, AMeshThatCannotBeClosedIsAnOutcomeWithAReason) {
  PartDraft draft = BoxBody();
  draft.pieces[0].mesh = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  MakePartConfig config;
  config.repair.wrap = WrapUse::kNever;
  const MadePart made = MakePart(draft, config);
  EXPECT_FALSE(made.part.has_value());
  EXPECT_NE(ProblemOf(made).find("frame"), std::string::npos) << ProblemOf(made);
  EXPECT_EQ(ToJson(made)["pieces"].size(), 2U);
}

TEST(MakePart, RefusesAPieceThatIsLargerThanDoorsAre) {
  PartDraft draft = BoxBody();
  draft.pieces[1].mesh.vertices[0].z() = -60;  // within reach, and no leaf
  try {
    MakePart(draft, {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("box: leaf: 62")) << what;
    EXPECT_NE(what.find("20 m"), std::string::npos) << what;
  }
}

TEST(MakePart, RefusesPiecesThatTheRoleDoesNotHave) {
  PartDraft draft = BoxBody();
  draft.pieces[0].name = "grip";
  EXPECT_THROW(MakePart(draft, {}), Error);
  draft.pieces.clear();
  EXPECT_THROW(MakePart(draft, {}), Error);
}

}  // namespace
}  // namespace doorforge
