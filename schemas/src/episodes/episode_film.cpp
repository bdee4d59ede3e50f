// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode_film.h"

#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFilmSchema = "doorforge.film";
constexpr std::size_t kMostInstants = 100'000;

double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

Json RoundedList(const auto& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(Rounded(value));
  return list;
}

// One list a quantity, a number an instant.
Json Quantity(const std::vector<FilmInstant>& instants, double FilmInstant::*quantity) {
  Json list = Json::array();
  for (const FilmInstant& instant : instants) list.push_back(Rounded(instant.*quantity));
  return list;
}

constexpr std::pair<const char*, double FilmInstant::*> kQuantities[] = {
    {"time_s", &FilmInstant::time_s},         {"hinge_rad", &FilmInstant::hinge_rad},
    {"handle_rad", &FilmInstant::handle_rad}, {"bolt_m", &FilmInstant::bolt_m},
    {"force_n", &FilmInstant::force_n},       {"net_force_n", &FilmInstant::net_force_n}};

[[noreturn]] void RefuseFilm(const std::string& where, const std::string& why) {
  throw Error(ErrorCode::kFormat, where + ": " + why);
}

const Json& ListOf(const Json& json, const char* key, std::size_t size, const std::string& path) {
  const Json& list = MemberOf(json, key, path);
  if (!list.is_array() || list.size() != size)
    RefuseFilm(path + "." + key, "expected a list of " + std::to_string(size));
  return list;
}

double FilmNumber(const Json& value, const std::string& where) {
  if (!value.is_number()) RefuseFilm(where, "expected a number");
  const auto number = value.get<double>();
  if (!std::isfinite(number)) RefuseFilm(where, "expected a finite number");
  return number;
}

std::vector<double> FilmNumbers(const Json& list, const std::string& where) {
  if (!list.is_array()) RefuseFilm(where, "expected a list of numbers");
  std::vector<double> numbers;
  for (const Json& value : list) numbers.push_back(FilmNumber(value, where));
  return numbers;
}

std::optional<Eigen::Vector3d> PointIn(const Json& value, const std::string& where) {
  if (value.is_null()) return std::nullopt;
  const std::vector<double> numbers = FilmNumbers(value, where);
  if (numbers.size() != 3) RefuseFilm(where, "expected three numbers or null");
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

std::vector<FilmInstant> InstantsFromJson(const Json& json, const std::string& path) {
  const Json& times = MemberOf(json, "time_s", path);
  if (!times.is_array() || times.empty() || times.size() > kMostInstants)
    RefuseFilm(path + ".time_s", "expected 1 to 100000 instants");
  std::vector<FilmInstant> instants(times.size());
  for (const auto& [key, quantity] : kQuantities) {
    const Json& list = ListOf(json, key, instants.size(), path);
    for (std::size_t i = 0; i < instants.size(); ++i)
      instants[i].*quantity = FilmNumber(list[i], path + "." + key);
  }
  const Json& phases = ListOf(json, "phase", instants.size(), path);
  const Json& robot = ListOf(json, "robot", instants.size(), path);
  const Json& asked = ListOf(json, "asked_m", instants.size(), path);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    if (!phases[i].is_string()) RefuseFilm(path + ".phase", "expected words");
    instants[i].phase = phases[i].get<std::string>();
    instants[i].robot = FilmNumbers(robot[i], path + ".robot");
    instants[i].asked_m = PointIn(asked[i], path + ".asked_m");
    if (instants[i].robot.size() != instants[0].robot.size())
      RefuseFilm(path + ".robot", "expected as many joints at each instant");
  }
  return instants;
}

}  // namespace

std::string FilmAddress(const std::string& door_id, std::uint64_t seed, std::uint64_t episode) {
  return door_id + "/" + std::to_string(seed) + "/" + std::to_string(episode);
}

std::string FilmAddress(const Scene& scene) {
  return FilmAddress(scene.door_id, scene.seed, scene.episode);
}

Json FilmToJson(const EpisodeFilm& film) {
  Json json = {{"schema", kFilmSchema},
               {"schema_version", 1},
               {"outcome", NameOf(film.outcome)},
               {"detail", film.detail},
               {"state_sha256", film.state_sha256},
               {"scene", SceneToJson(film.scene)}};
  for (const auto& [key, quantity] : kQuantities) json[key] = Quantity(film.instants, quantity);
  Json phases = Json::array();
  Json robot = Json::array();
  Json asked = Json::array();
  for (const FilmInstant& instant : film.instants) {
    phases.push_back(instant.phase);
    robot.push_back(RoundedList(instant.robot));
    asked.push_back(instant.asked_m ? RoundedList(*instant.asked_m) : Json(nullptr));
  }
  json["phase"] = std::move(phases);
  json["robot"] = std::move(robot);
  json["asked_m"] = std::move(asked);
  return json;
}

EpisodeFilm FilmFromJson(const Json& json, const std::string& path) {
  if (!json.is_object() || !json.contains("schema") || json["schema"] != kFilmSchema)
    RefuseFilm(path, "is no film: its schema is not " + std::string(kFilmSchema));
  if (ValueOf<int>(json, "schema_version", path) != 1)
    RefuseFilm(path, "a later version of the format than this build reads");
  EpisodeFilm film;
  const auto outcome = EpisodeOutcomeNamed(ValueOf<std::string>(json, "outcome", path));
  if (!outcome) RefuseFilm(path + ".outcome", "unknown");
  film.outcome = *outcome;
  film.detail = ValueOf<std::string>(json, "detail", path);
  film.state_sha256 = ValueOf<std::string>(json, "state_sha256", path);
  film.scene = SceneFromJson(MemberOf(json, "scene", path), path + ".scene");
  film.instants = InstantsFromJson(json, path);
  return film;
}

void WriteFilms(const std::filesystem::path& path, std::span<const EpisodeFilm> films) {
  std::string text;
  for (const EpisodeFilm& film : films) text += JsonText(FilmToJson(film)) + "\n";
  CommitFile(path, text);
}

std::vector<EpisodeFilm> ReadFilms(const std::filesystem::path& path) {
  std::istringstream lines(ReadFile(path));
  std::vector<EpisodeFilm> films;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string where = path.string() + ":" + std::to_string(number);
    films.push_back(FilmFromJson(ParseJson(line, where), where));
  }
  return films;
}

}  // namespace doorforge
