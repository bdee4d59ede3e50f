// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "film_forces.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace doorforge::internal {
namespace {

constexpr double kKept = 1e-6;  // of numbers of films [s, m or rad]

constexpr const char* kJointNames[] = {"slider x", "slider y", "arm 1",  "arm 2", "arm 3",
                                       "arm 4",    "arm 5",    "arm 6",  "arm 7", "finger 1",
                                       "finger 2", "hinge",    "handle", "bolt"};

JointState StateOf(const FilmInstant& instant, const ProprioceptionPlaces& places) {
  JointState state{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places.at(i) >= 0) state.at(i) = instant.robot.at(static_cast<std::size_t>(places.at(i)));
  }
  state[kStateHinge] = instant.hinge_rad;
  state[kStateHandle] = instant.handle_rad;
  state[kStateBolt] = instant.bolt_m;
  return state;
}

std::string At(double time_s) {
  char text[40];
  std::snprintf(text, sizeof text, "at %.3f s ", time_s);
  return text;
}

// Empty where the two are equal.
std::string Difference(const JointState& filmed, const JointState& stored) {
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (std::abs(filmed.at(i) - stored.at(i)) <= kKept) continue;
    char text[160];
    std::snprintf(text, sizeof text, "its %s is %.6f where the data set has %.6f", kJointNames[i],
                  filmed.at(i), stored.at(i));
    return text;
  }
  return {};
}

// The instants of a film at the times of the frames, or why they are not those.
struct Matched {
  std::vector<const FilmInstant*> instants;
  std::string fault;
};

Matched MatchedOf(const EpisodeFilm& record, const Film& film, std::span<const JointState> states,
                  const ProprioceptionPlaces& places) {
  Matched matched;
  auto instant = record.instants.begin();
  for (std::size_t t = 0; t < states.size() && matched.fault.empty(); ++t) {
    const double time_s = film.frames[t].time_s;
    while (instant != record.instants.end() && instant->time_s < time_s - kKept) ++instant;
    if (instant == record.instants.end() || instant->time_s > time_s + kKept) {
      matched.fault = At(time_s) + "it has no instant";
      break;
    }
    const std::string difference = Difference(StateOf(*instant, places), states[t]);
    if (!difference.empty()) matched.fault = At(time_s) + difference;
    matched.instants.push_back(&*instant);
  }
  return matched;
}

}  // namespace

FilmForces::FilmForces(std::filesystem::path file, const RobotModel& robot)
    : file_(std::move(file)),
      joints_(static_cast<std::size_t>(robot.joint_count())),
      places_(ProprioceptionPlacesOf(robot)) {
  for (EpisodeFilm& film : ReadFilms(file_)) {
    const std::string address = FilmAddress(film.scene);
    films_.emplace(address, std::move(film));
  }
}

std::string FilmForces::AddTo(Film& film, const Scene& scene, std::span<const JointState> states) {
  const std::string address = FilmAddress(scene);
  std::string fault = "there is no film of " + address;
  const auto [first, end] = films_.equal_range(address);
  for (auto record = first; record != end; ++record) {
    const EpisodeFilm& filmed = record->second;
    if (filmed.scene.door_sha256 != scene.door_sha256 ||
        filmed.instants[0].robot.size() != joints_) {
      fault = "its film is of another door or robot";
      continue;
    }
    const Matched matched = MatchedOf(filmed, film, states, places_);
    if (!matched.fault.empty()) {
      fault = matched.fault;
      continue;
    }
    for (std::size_t t = 0; t < states.size(); ++t) {
      film.frames[t].force_n = matched.instants[t]->force_n;
      film.frames[t].net_force_n = matched.instants[t]->net_force_n;
    }
    film.facts.emplace_back("Forces",
                            "of " + file_.filename().string() +
                                ", simulated again: all joints are those stored, to 1e-6");
    return {};
  }
  return file_.string() + ": " + film.title + ": no forces are shown: " + fault;
}

}  // namespace doorforge::internal
