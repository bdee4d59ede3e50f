// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How well a finder finds the handles of doors of a split: on each look at a closed door, before
// the robot is in view, intersection over union of found and true handle points, and the angle
// between the found and the true way into the leaf.
//
//   find_handles --doors full:validation build/doors --finder data/policies/finder

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/core/program.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/handle_finder.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/door_set.h"

namespace doorforge::benchmark {
namespace {

struct Options {
  std::vector<std::string> doors;
  std::string finder;
  int per_category = 40;
  int seeds = 1;
  double worst_below = 0;
};

/// What was found of a category.
struct Findings {
  std::vector<double> iou;
  std::vector<double> precision;
  std::vector<double> recall;
  std::vector<double> approach_deg;
  int nothing_found = 0;
};

struct Look {
  LabelledCloud visible;
  Eigen::Vector3d approach;
};

Look LookAt(const IdentifiedDoor& door, const RobotModel& robot, std::uint64_t seed) {
  const Scene scene = PlaceRobotBase(robot, SampleScene(door, seed, 0), *door);
  RememberedLook look = LookBefore(scene, *door, robot, {},
                                   {.resolution_scale = GraspCameraConfig{}.resolution_scale});
  return {std::move(look.visible), -look.snapshot.door[kHandleLink].linear().col(0)};
}

bool IsHandle(const LabelledCloud& cloud, std::size_t i) {
  return cloud.label[i] == static_cast<std::uint8_t>(PointLabel::kHandle);
}

// Says how much of what was found is the handle's, how much of the handle was found, and both in
// one.
void Compare(const LabelledCloud& truth, const std::vector<bool>& found, Findings& findings) {
  double both = 0;
  double in_truth = 0;
  double in_found = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    both += IsHandle(truth, i) && found[i] ? 1 : 0;
    in_truth += IsHandle(truth, i) ? 1 : 0;
    in_found += found[i] ? 1 : 0;
  }
  findings.iou.push_back(both / (in_truth + in_found - both));
  findings.precision.push_back(both / in_found);
  findings.recall.push_back(both / in_truth);
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

void Print(const std::string& name, const Findings& findings) {
  const auto low = std::ranges::count_if(findings.iou, [](double iou) { return iou < 0.5; });
  std::printf("%-18s %6zu %8.3f %8.3f %8.3f %8.3f %8.3f %8td %8d %8.2f %8.2f %8.2f\n", name.c_str(),
              findings.iou.size(), Mean(findings.iou), Quantile(findings.iou, 0.5),
              Quantile(findings.iou, 0.05), Mean(findings.precision), Mean(findings.recall), low,
              findings.nothing_found, Quantile(findings.approach_deg, 0.5),
              Quantile(findings.approach_deg, 0.95), Quantile(findings.approach_deg, 1));
}

void Add(const Findings& more, Findings& all) {
  all.iou.insert(all.iou.end(), more.iou.begin(), more.iou.end());
  all.precision.insert(all.precision.end(), more.precision.begin(), more.precision.end());
  all.recall.insert(all.recall.end(), more.recall.begin(), more.recall.end());
  all.approach_deg.insert(all.approach_deg.end(), more.approach_deg.begin(),
                          more.approach_deg.end());
  all.nothing_found += more.nothing_found;
}

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("How well a finder finds handles.", "find_handles");
  app.add_option("--doors", options.doors, "folders of doors, and a split")->required();
  app.add_option("--finder", options.finder, "folder of `doorforge train find`")->required();
  app.add_option("-n,--per-category", options.per_category, "doors, 0: all")->capture_default_str();
  app.add_option("--seeds", options.seeds,
                 "looks at each door, by scenes that may not differ in their camera")
      ->capture_default_str();
  app.add_option("--list-below", options.worst_below, "name looks of a lower IoU")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

void FindIn(const Look& look, const HandleFinder& finder, Findings& findings) {
  const std::optional<FoundHandle> found =
      finder.Find(look.visible, [&](const Eigen::Vector3d& start, double crop_radius_m) {
        return SampleCloud(look.visible, start, {.crop_radius_m = crop_radius_m}).cloud;
      });
  if (!found) {
    ++findings.nothing_found;
    findings.iou.push_back(0);
    return;
  }
  Compare(look.visible, found->is_handle, findings);
  const double cosine = std::clamp(found->approach.dot(look.approach), -1.0, 1.0);
  findings.approach_deg.push_back(std::acos(cosine) * 180 / std::numbers::pi);
}

int Run(const Options& options) {
  const HandleFinder finder = LoadHandleFinder(options.finder);
  DoorSelection selection = DoorSelectionOf(options.doors, "train");
  selection.per_category = options.per_category;
  const std::vector<FoundDoor> doors = FindDoorSet(selection, 1).doors;
  DoorCache shelf(doors);
  const RobotModel robot = LoadRobot({}, RobotBase::kSliders);
  std::map<std::string, Findings> by_category;
  int hidden = 0;
  for (std::size_t d = 0; d < doors.size() && StopRequested() == 0; ++d) {
    const auto door = shelf.Take(d);
    Findings& findings = by_category[std::string(NameOf(door->category))];
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const Look look = LookAt(door, robot, static_cast<std::uint64_t>(seed));
      if (std::ranges::count(look.visible.label, static_cast<std::uint8_t>(PointLabel::kHandle)) ==
          0) {
        ++hidden;
        continue;
      }
      FindIn(look, finder, findings);
      if (findings.iou.back() < options.worst_below)
        std::printf("%s, seed %d: IoU %.3f, approach %.1f deg\n", door->id.c_str(), seed,
                    findings.iou.back(),
                    findings.approach_deg.empty() ? -1 : findings.approach_deg.back());
    }
    std::fprintf(stderr, "\r%zu of %zu doors ", d + 1, doors.size());
  }
  std::printf("\n%-18s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "category", "looks", "IoU",
              "median", "5 %", "found's", "truth's", "below .5", "nothing", "approach", "95 %",
              "worst");
  Findings all;
  for (const auto& [name, findings] : by_category) {
    Print(name, findings);
    Add(findings, all);
  }
  Print("all", all);
  if (hidden > 0) std::printf("without a point of the handle in view: %d looks\n", hidden);
  return 0;
}

}  // namespace
}  // namespace doorforge::benchmark

int main(int argc, char** argv) {
  return doorforge::RunProgram(
      [&] { return doorforge::benchmark::Run(doorforge::benchmark::Parse(argc, argv)); });
}
