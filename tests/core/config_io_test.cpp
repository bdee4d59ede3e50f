// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_io.h"

#include <cmath>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

struct Inner {
  double size_m = 0.5;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("size_m", self.size_m);
  }
};

struct Outer {
  int count = 3;
  Inner inner;
  std::vector<int> ids;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("count", self.count);
    visit("inner", self.inner);
    visit("ids", self.ids);
  }
};

Outer Load(const char* text) {
  Outer outer;
  Assign(nlohmann::ordered_json::parse(text), outer, "outer");
  return outer;
}

std::string ErrorOf(const char* text) {
  try {
    Load(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ConfigIo, KeepsDefaultsThatTheFileDoesNotName) {
  const Outer outer = Load(R"({"inner": {"size_m": 2}})");
  EXPECT_EQ(outer.count, 3);
  EXPECT_EQ(outer.inner.size_m, 2);
}

TEST(ConfigIo, WritesDefaultsToo) {
  EXPECT_EQ(ToJson(Outer{}).dump(), R"({"count":3,"inner":{"size_m":0.5},"ids":[]})");
}

TEST(ConfigIo, NamesTheUnknownKey) {
  EXPECT_EQ(ErrorOf(R"({"inner": {"sise_m": 2}})"),
            "outer.inner.sise_m: unknown key; did you mean \"size_m\"?");
}

TEST(ConfigIo, RefusesAFractionForAnInteger) {
  EXPECT_EQ(ErrorOf(R"({"ids": [1, 2.5]})"), "outer.ids[1]: expected an integer");
}

TEST(ConfigIo, RefusesAnIntegerThatDoesNotFit) {
  EXPECT_EQ(ErrorOf(R"({"count": 3000000000})"), "outer.count: integer out of range");
}

TEST(ConfigIo, ARangeHoldsItsEndsAndNoNumberIsInNone) {
  EXPECT_NO_THROW(RequireRange("body", "width_m", 0.5, 0.5, 1));
  EXPECT_NO_THROW(RequireRange("body", "width_m", 1, 0.5, 1));
  EXPECT_THROW(RequireRange("body", "width_m", std::nan(""), 0.5, 1), Error);
  try {
    RequireRange("body", "width_m", 1.25, 0.5, 1);
    FAIL() << "1.25 is above 1";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_STREQ(error.what(), "body.width_m: found 1.25, allowed 0.5 to 1.0");
  }
}

enum class Shape { kRound, kFlat };
constexpr NamedValue<Shape> kShapes[] = {{Shape::kRound, "round"}, {Shape::kFlat, "flat"}};
constexpr std::span<const NamedValue<Shape>> ValuesOf(Shape) { return kShapes; }

struct Shaped {
  Shape shape = Shape::kFlat;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
  }
};

TEST(ConfigIo, AnEnumIsTheWordOfItsTable) {
  EXPECT_EQ(ToJson(Shaped{}).dump(), R"({"shape":"flat"})");
  Shaped shaped;
  Assign(nlohmann::ordered_json::parse(R"({"shape": "round"})"), shaped, "cut");
  EXPECT_EQ(shaped.shape, Shape::kRound);
}

TEST(ConfigIo, AWordThatAnEnumHasNotIsRefusedWithThoseThatThereAre) {
  for (const char* text : {R"({"shape": "square"})", R"({"shape": 1})", R"({"shape": ""})"}) {
    Shaped shaped;
    try {
      Assign(nlohmann::ordered_json::parse(text), shaped, "cut");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      const std::string message = error.what();
      EXPECT_NE(message.find("cut.shape"), std::string::npos) << message;
      EXPECT_NE(message.find("round, flat"), std::string::npos) << message;
    }
    EXPECT_EQ(shaped.shape, Shape::kFlat);
  }
}

TEST(ConfigIo, WhatOptionsGiveGoesBeforeTheFileAndWhatTheyDoNotGiveIsTheFiles) {
  Outer value = Load(R"({"count": 7, "inner": {"size_m": 0.25}, "ids": [1, 2]})");
  const Outer unset{.count = 0, .inner = {0}, .ids = {}};
  Outer given = unset;
  given.inner.size_m = 0.75;
  AssignGiven(given, unset, value);
  EXPECT_EQ(value.count, 7);
  EXPECT_EQ(value.inner.size_m, 0.75);
  EXPECT_EQ(value.ids, (std::vector<int>{1, 2}));
  given.ids = {3};
  AssignGiven(given, unset, value);
  EXPECT_EQ(value.ids, (std::vector<int>{3}));
}

}  // namespace
}  // namespace doorforge
