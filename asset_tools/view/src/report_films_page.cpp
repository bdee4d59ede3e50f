// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/report_films_page.h"

#include <map>
#include <optional>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/episode_film.h"

#include "door_finder.h"
#include "episode_writer.h"
#include "html_page.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = internal::PageContent::Json;

constexpr const char* kFilms = "films.jsonl";

bool IsFilms(const fs::path& path) { return path.extension() == ".jsonl"; }

fs::path ReportFileOf(const fs::path& path) {
  return fs::is_directory(path) ? path / "report.json" : path;
}

// It takes of each row what a table shows.
Json RowsOfReport(const fs::path& path) {
  const Json report = ReadJsonFile(path);
  const std::string where = path.string();
  if (!report.is_object() || !report.contains("schema") || report["schema"] != "doorforge.report")
    throw Error(ErrorCode::kFormat, where + ": is no report of doorforge eval");
  const Json& episodes = MemberOf(report, "episodes", where);
  if (!episodes.is_array()) throw Error(ErrorCode::kFormat, where + ": episodes: expected a list");
  Json rows = Json::array();
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    const std::string place = where + ": episodes[" + std::to_string(i) + "]";
    const Json& episode = episodes[i];
    const auto door = ValueOf<std::string>(episode, "door_id", place);
    rows.push_back({{"address", FilmAddress(door, ValueOf<std::uint64_t>(episode, "seed", place),
                                            ValueOf<std::uint64_t>(episode, "episode", place))},
                    {"door", door},
                    {"category", ValueOf<std::string>(episode, "category", place)},
                    {"seed", ValueOf<std::uint64_t>(episode, "seed", place)},
                    {"number", ValueOf<std::uint64_t>(episode, "episode", place)},
                    {"outcome", ValueOf<std::string>(episode, "outcome", place)},
                    {"detail", ValueOf<std::string>(episode, "detail", place)},
                    {"hinge", ValueOf<double>(episode, "peak_hinge_rad", place)}});
  }
  return rows;
}

Json RowOfFilm(const EpisodeFilm& film) {
  double hinge = 0;
  for (const FilmInstant& instant : film.instants) hinge = std::max(hinge, instant.hinge_rad);
  return {{"address", FilmAddress(film.scene)},
          {"door", film.scene.door_id},
          {"category", ""},
          {"seed", film.scene.seed},
          {"number", film.scene.episode},
          {"outcome", NameOf(film.outcome)},
          {"detail", film.detail},
          {"hinge", hinge}};
}

// Films by the number of their row.
class RowFilms {
 public:
  RowFilms(const RobotModel& robot, const ReportFilms& chosen, std::string file)
      : robot_(robot), writer_(robot, 0), chosen_(chosen), file_(std::move(file)) {}

  void Add(const EpisodeFilm& film, Json& row, std::vector<std::string>& faults) {
    if (!doors_) doors_.emplace(chosen_.doors, chosen_.threads);
    const auto door = doors_->Find(film.scene.door_sha256);
    if (!door) {
      faults.push_back(file_ + ": " + FilmAddress(film.scene) +
                       ": its door is not in the folders given with --doors, or has changed since");
      return;
    }
    try {
      internal::Film shown = internal::FilmOf(film, **door, robot_);
      shown.title = FilmAddress(film.scene);
      row["film"] = writer_.size();
      writer_.Add(**door, film.scene.door_sha256, shown);
    } catch (const Error& error) {
      row.erase("film");
      faults.push_back(file_ + ": " + error.what());
    }
  }

  internal::PageContent& content() { return writer_.content(); }

 private:
  const RobotModel& robot_;
  internal::EpisodeWriter writer_;
  const ReportFilms& chosen_;
  std::string file_;  // that messages name
  std::optional<internal::DoorFinder> doors_;
};

}  // namespace

bool IsReport(const fs::path& path) {
  if (IsFilms(path)) return true;
  const fs::path file = ReportFileOf(path);
  return file.filename() == "report.json" && fs::is_regular_file(file);
}

ViewPage MakeReportPage(const ReportFilms& chosen) {
  const bool films_alone = IsFilms(chosen.report);
  const fs::path films_file =
      films_alone ? chosen.report : ReportFileOf(chosen.report).parent_path() / kFilms;
  std::vector<EpisodeFilm> films;
  if (films_alone || fs::exists(films_file)) films = ReadFilms(films_file);
  Json rows = films_alone ? Json::array() : RowsOfReport(ReportFileOf(chosen.report));
  std::map<std::string, std::size_t> places;
  if (films_alone) {
    for (const EpisodeFilm& film : films) rows.push_back(RowOfFilm(film));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) places.emplace(rows[i]["address"], i);

  ViewPage page;
  const RobotModel robot = LoadRobot(
      chosen.robot.urdf, films.empty() ? RobotBase::kSliders : films[0].scene.physics.base,
      chosen.robot.read_mesh);
  RowFilms shown(robot, chosen, films_file.string());
  if (!films.empty() && chosen.doors.empty())
    page.faults.push_back(films_file.string() +
                          ": films are shown with --doors, the folders of the doors");
  for (const EpisodeFilm& film : films) {
    const auto place = places.find(FilmAddress(film.scene));
    if (place == places.end())
      page.faults.push_back(films_file.string() + ": " + FilmAddress(film.scene) +
                            " is no row of the report");
    else if (!chosen.doors.empty())
      shown.Add(film, rows[place->second], page.faults);
  }
  page.shown = rows.size();
  shown.content().document["kind"] = "report";
  shown.content().document["rows"] = std::move(rows);
  const fs::path named = films_alone ? chosen.report : ReportFileOf(chosen.report).parent_path();
  const std::string title = fs::absolute(named).lexically_normal().filename().string();
  shown.content().document["title"] = title;
  page.html = internal::HtmlPage("Episodes of " + title + " - doorforge", shown.content());
  return page;
}

}  // namespace doorforge
