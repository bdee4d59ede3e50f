// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/mesh/mesh_writer.h"
#include "doorforge/mesh/repair_mesh.h"

#include "../program_answer.h"
#include "shapes.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class RepairProgram : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(DOORFORGE_BINARY_DIR) / "repair_program_test" / test->name();
    fs::remove_all(folder_);
    CommitFile(folder_ / "torus.stl", WriterFor("x.stl")(Torus(1, 0.3, 24, 12)));
    TriangleMesh crossing = Torus(1, 0.3, 60, 60);
    crossing.vertices[0] = {-2, 0.1, 0.1};
    CommitFile(folder_ / "crossing.ply", WriterFor("x.ply")(crossing));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string In(const std::string& name) const { return (folder_ / name).string(); }

  static int Run(const std::vector<std::string>& arguments) {
    std::string command = std::string(DOORFORGE_BINARY_DIR) + "/bin/doorforge-assets repair";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    return AnswerOf(command + " 2>&1").code;
  }

  fs::path folder_;
};

TEST_F(RepairProgram, WritesAClosedMeshOfEachFormatWithItsReport) {
  for (const char* out : {"a.obj", "b.stl", "c.PLY"}) {
    ASSERT_EQ(Run({In("torus.stl"), In(out)}), 0);
    EXPECT_TRUE(ClosedMesh::From(MergedPieces(ImportMesh(In(out)))));
    const auto record = ReadJsonFile(In(out) + ".report.json");
    EXPECT_EQ(RepairReportFromJson(record, "report").outcome, RepairOutcome::kAlreadyClosed);
    EXPECT_EQ(record["config"]["max_triangles"], 6000);
  }
}

TEST_F(RepairProgram, ReportsAMeshThatCannotBeClosedAndWritesNothing) {
  EXPECT_EQ(Run({In("crossing.ply"), In("a.obj"), "--wrap", "never"}), 1);
  EXPECT_FALSE(fs::exists(In("a.obj")));
  EXPECT_FALSE(fs::exists(In("a.obj.report.json")));
}

TEST_F(RepairProgram, OverwritesOnlyWhenAsked) {
  ASSERT_EQ(Run({In("torus.stl"), In("a.obj")}), 0);
  EXPECT_EQ(Run({In("torus.stl"), In("a.obj")}), 2);
  EXPECT_EQ(Run({In("torus.stl"), In("a.obj"), "--overwrite", "--set", "max_triangles=200"}), 0);
  EXPECT_LE(MergedPieces(ImportMesh(In("a.obj"))).triangles.size(), 200U);
}

TEST_F(RepairProgram, TellsWrongUseFromUnreadableInput) {
  EXPECT_EQ(Run({In("torus.stl")}), 2);
  EXPECT_EQ(Run({In("torus.stl"), In("a.obj"), "--wrap", "perhaps"}), 2);
  EXPECT_EQ(Run({In("torus.stl"), In("a.obj"), "--set", "max_triangle=1"}), 2);
  EXPECT_EQ(Run({In("torus.stl"), In("a.png")}), 2);
  EXPECT_EQ(Run({In("none.stl"), In("a.obj")}), 3);
  EXPECT_EQ(Run({folder_.string(), In("a.obj")}), 3);
}

}  // namespace
}  // namespace doorforge
