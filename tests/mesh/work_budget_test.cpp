// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/work_budget.h"

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/repair_mesh.h"
#include "doorforge/mesh/solid_overlap.h"
#include "doorforge/mesh/surface_deviation.h"

#include "repair/collapse_edges.h"
#include "repair/surface_operations.h"
#include "shapes.h"

namespace doorforge {
namespace {

// What the work says under a budget that is used up at once; empty where it never asks.
std::string RefusalOf(const std::function<void()>& work) {
  const WorkBudget budget("parts/a.obj", 1e-9);
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat);
    return error.what();
  }
  return "";
}

TEST(WorkBudget, EndsEveryStageThatMayTakeLong) {
  const TriangleMesh torus = Torus(1, 0.3, 30, 20);
  const ClosedMesh closed = *ClosedMesh::From(torus);
  TriangleMesh open = torus;
  open.triangles.resize(open.triangles.size() - 100);
  const TriangleMesh hull = ConvexHull(torus.vertices);
  RigidTransform moved = RigidTransform::Identity();
  moved.translation() << 0.1, 0, 0;
  const std::array<std::pair<const char*, std::function<void()>>, 12> stages = {{
      {"repair", [&] { RepairMesh(open, {}); }},
      {"close", [&] { CloseSoup(open, {.max_size_m = 10, .max_cap_distance_m = 10}, open); }},
      {"cross", [&] { SelfIntersects(torus); }},
      {"crossings", [&] { CrossingTriangles(torus); }},
      {"unite",
       [&] {
         United({torus, Box({-2, -2, -0.1}, {2, 2, 0.1})}, {.shift_m = 1e-4, .turns = true});
       }},
      {"wrap", [&] { AlphaWrap(torus, 0.1, 0.01); }},
      {"simplify", [&] { Reduced(torus, 100, 0); }},
      {"slivers", [&] { WithoutSlivers(torus, 0.1); }},
      {"simplify without crossings", [&] { ReducedWithoutCrossings(torus, 100, 0); }},
      {"convex parts", [&] { ConvexParts(closed, {}); }},
      {"fit", [&] { MeasureConvexParts(closed, std::array{hull}); }},
      {"deviation", [&] { DeviationOf(torus, hull); }},
  }};
  for (const auto& [name, stage] : stages) {
    const std::string refusal = RefusalOf(stage);
    EXPECT_TRUE(refusal.starts_with("parts/a.obj: takes more than the 1e-09 s of processor time"))
        << name << ": " << refusal;
    EXPECT_NE(refusal.find("--max-seconds"), std::string::npos);
    EXPECT_NO_THROW(stage()) << name << " without a budget";
  }
}

TEST(WorkBudget, CountsTheProcessorAndNotTheClock) {
  const WorkBudget budget("a.obj", 0.1);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_NO_THROW(CheckWork());
}

TEST(WorkBudget, TheOutermostOfAThreadCountsAndNoOtherThreads) {
  const WorkBudget outer("outer", 1e-9);
  {
    const WorkBudget inner("inner", 1000);
    EXPECT_THROW(CheckWork(), Error);
  }
  EXPECT_THROW(CheckWork(), Error);
  std::jthread([] { EXPECT_NO_THROW(CheckWork()); });
}

TEST(WorkBudget, NothingCountsWithoutOne) {
  { const WorkBudget over("a.obj", 1e-9); }
  EXPECT_NO_THROW(CheckWork());
  EXPECT_THROW(WorkBudget("a.obj", 0), Error);
}

TEST(CurrentProblem, NamesTheObjectAndNoWordsOfALibrary) {
  const auto told = [](const std::function<void()>& fail) {
    try {
      fail();
    } catch (const std::exception&) {
      return CurrentProblem("parts/a.obj");
    }
    return std::string();
  };
  EXPECT_EQ(told([] { throw Error(ErrorCode::kFormat, "parts/a.obj:3: no"); }),
            "parts/a.obj:3: no");
  EXPECT_EQ(told([] { throw Error(ErrorCode::kFormat, "no"); }), "parts/a.obj: no");
  EXPECT_EQ(told([] { throw std::bad_alloc(); }), "parts/a.obj: memory ran out; simplify its mesh");
  const std::string library = told([] { throw std::length_error("vector::_M_fill_insert"); });
  EXPECT_TRUE(library.starts_with("parts/a.obj: ")) << library;
  EXPECT_EQ(library.find("vector"), std::string::npos) << library;
}

}  // namespace
}  // namespace doorforge
