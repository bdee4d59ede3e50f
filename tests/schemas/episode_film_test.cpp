// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_film.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

EpisodeFilm SmallFilm() {
  EpisodeFilm film;
  film.scene.door_id = "a_door";
  film.scene.seed = 7;
  film.scene.episode = 2;
  film.outcome = EpisodeOutcome::kGripLost;
  film.detail = "let go";
  film.state_sha256 = std::string(64, 'a');
  film.instants = {{.time_s = 0, .phase = "start", .robot = {0.5, -0.25}},
                   {.time_s = 0.125,
                    .phase = "open",
                    .robot = {0.1234567, 1},
                    .hinge_rad = 0.5,
                    .handle_rad = 0.75,
                    .bolt_m = -0.0125,
                    .force_n = 40,
                    .net_force_n = 12.5,
                    .asked_m = Eigen::Vector3d(1, 2, 3)}};
  return film;
}

std::string FaultOf(const nlohmann::ordered_json& json) {
  try {
    FilmFromJson(json, "film");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFormat) << error.what();
    return error.what();
  }
  return "";
}

TEST(EpisodeFilm, ComesBackAsItWasToAMillionth) {
  const EpisodeFilm film = SmallFilm();
  const EpisodeFilm back = FilmFromJson(FilmToJson(film), "film");
  EXPECT_EQ(back.scene.door_id, "a_door");
  EXPECT_EQ(back.outcome, film.outcome);
  EXPECT_EQ(back.detail, film.detail);
  EXPECT_EQ(back.state_sha256, film.state_sha256);
  ASSERT_EQ(back.instants.size(), 2U);
  EXPECT_EQ(back.instants[1].phase, "open");
  EXPECT_DOUBLE_EQ(back.instants[1].robot[0], 0.123457);
  EXPECT_DOUBLE_EQ(back.instants[1].bolt_m, -0.0125);
  EXPECT_DOUBLE_EQ(back.instants[1].net_force_n, 12.5);
  EXPECT_FALSE(back.instants[0].asked_m.has_value());
  EXPECT_EQ(*back.instants[1].asked_m, Eigen::Vector3d(1, 2, 3));
}

TEST(EpisodeFilm, AddressIsDoorSeedAndNumber) {
  EXPECT_EQ(FilmAddress(SmallFilm().scene), "a_door/7/2");
}

TEST(EpisodeFilm, WhatDoesNotFitIsRefusedByName) {
  const nlohmann::ordered_json good = FilmToJson(SmallFilm());
  EXPECT_EQ(FaultOf(good), "");
  const auto with = [&](const char* key, nlohmann::ordered_json value) {
    nlohmann::ordered_json changed = good;
    changed[key] = std::move(value);
    return FaultOf(changed);
  };
  EXPECT_NE(with("hinge_rad", {0.0}).find("film.hinge_rad"), std::string::npos);
  EXPECT_NE(with("force_n", {0.0, "x"}).find("film.force_n"), std::string::npos);
  EXPECT_NE(with("robot", {{1.0}, {1.0, 2.0}}).find("film.robot"), std::string::npos);
  EXPECT_NE(with("asked_m", {nullptr, {1.0, 2.0}}).find("film.asked_m"), std::string::npos);
  EXPECT_NE(with("phase", {"open", 3}).find("film.phase"), std::string::npos);
  EXPECT_NE(with("time_s", nlohmann::ordered_json::array()).find("film.time_s"), std::string::npos);
  EXPECT_NE(with("outcome", "flew").find("film.outcome"), std::string::npos);
  EXPECT_NE(with("schema", "doorforge.report").find("no film"), std::string::npos);
  EXPECT_NE(with("schema", 3).find("no film"), std::string::npos);
  EXPECT_NE(with("schema_version", 2).find("later version"), std::string::npos);
}

TEST(EpisodeFilm, FilesHoldOneALine) {
  const std::filesystem::path path = testing::TempDir() + "films_of_a_test.jsonl";
  const EpisodeFilm films[] = {SmallFilm(), SmallFilm()};
  WriteFilms(path, films);
  EXPECT_EQ(ReadFilms(path).size(), 2U);
  std::ofstream(path, std::ios::app) << "{\n";
  try {
    ReadFilms(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("films_of_a_test.jsonl:3"), std::string::npos);
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace doorforge
