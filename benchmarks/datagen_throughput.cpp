// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Recorded samples (decisions) a second and core of `doorforge datagen open` end to end, what the
// time goes into, and how it grows with samples, doors and threads.
//
//   datagen_throughput DOORS SCRATCH [--samples 1000,10000] [--plot growth.svg]
//   datagen_throughput --rows MEASURED --plot growth.svg
//
// The second draws what an earlier run has printed into the file MEASURED.
// DOORS is a folder of composed doors, SCRATCH one that datasets are written to and removed from.
// --samples 1000,10000,100000 goes further: beyond 20,000 samples with 16 doors on two threads
// alone, which takes 22 processor minutes for 100,000, and 6 GB in SCRATCH.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <time.h>

#include "doorforge/collect/stage_episode.h"
#include "doorforge/collect/stage_run.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/dataset/collect.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/episode_arrays.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

double ProcessorSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double SecondsOf(const Work& work) {
  const double start = ProcessorSeconds();
  work();
  return ProcessorSeconds() - start;
}

// The policy's camera; sampling is done a second time to be timed by itself.
class TimedCamera : public Observer {
 public:
  TimedCamera(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
              const CloudConfig& config)
      : camera_(scene, door, robot, config), point_count_(config.point_count) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    CameraFrame frame;
    look_s += SecondsOf([&] { frame = camera_.Render(snapshot); });
    sampling_s += SecondsOf([&] {
      SampleCloud(frame.visible, snapshot.robot.world_from_tcp.translation(), {point_count_});
    });
    return std::move(frame.sampled.cloud);
  }

  double look_s = 0;  // rendering and sampling
  double sampling_s = 0;

 private:
  CameraObserver camera_;
  int point_count_;
};

struct Split {
  double physics = 0;
  double rendering = 0;
  double sampling = 0;
  double records = 0;  // what is hidden, preview, meta data, scene, reading the door
  double encoding = 0;
  double writing = 0;  // CRC, SHA-256, journal, tar
  std::uint64_t samples = 0;

  double Sum() const { return physics + rendering + sampling + records + encoding + writing; }
};

StageRequest RequestFor(const std::string& doors, std::uint64_t episodes) {
  StageConfig config = DefaultsOf(Stage::kOpen);
  config.episodes = episodes;
  config.seed = 3;
  return {config, {doors}, {}, 0, {}};
}

Split MeasureSplit(const std::string& doors, const fs::path& scratch, std::uint64_t episodes) {
  const StageRequest request = RequestFor(doors, episodes);
  StageRun run(request);
  DoorCache shelf(run.doors());
  const RobotModel robot = LoadRobot("", request.config.scene.physics.base);
  ShardWriter writer(scratch / "split", {0, "open", "train", ""});
  Split split;
  for (const PlannedShard& shard : run.plan().shards) {
    for (const PlannedEpisode& planned : shard.episodes) {
      CollectedEpisode collected;
      const double whole = SecondsOf([&] { collected = run.Run(planned); });
      const auto door = shelf.Take(planned.door);
      const Scene scene = PlaceRobotBase(
          robot, SampleScene(door, request.config.seed, planned.number, request.config.scene),
          *door);
      OpeningExpert expert(request.config.expert);
      TimedCamera camera(scene, *door, robot, request.config.cloud);
      const double acting = SecondsOf([&] { RunEpisode(scene, *door, robot, expert, &camera); });
      const double physics = acting - camera.look_s - camera.sampling_s;
      split.physics += physics;
      split.rendering += camera.look_s - camera.sampling_s;
      split.sampling += camera.sampling_s;
      split.records += whole - physics - camera.look_s;
      if (collected.episode.outcome != EpisodeOutcome::kOpened) continue;
      split.samples += collected.episode.decisions.size();
      std::vector<MemberBytes> members;
      split.encoding += SecondsOf([&] { members = MembersOf(collected); });
      split.writing += SecondsOf(
          [&] { writer.Add(planned.key, collected.episode.decisions.size(), std::move(members)); });
    }
  }
  split.writing += SecondsOf([&] { writer.Commit(); });
  fs::remove_all(scratch / "split");
  return split;
}

void Print(const Split& split) {
  const auto line = [&](const char* name, double seconds) {
    std::printf("  %-11s %7.2f ms a sample  %5.1f %%\n", name,
                1e3 * seconds / static_cast<double>(split.samples), 100 * seconds / split.Sum());
  };
  std::printf("one thread, %llu samples: %.1f samples a processor second\n",
              static_cast<unsigned long long>(split.samples),
              static_cast<double>(split.samples) / split.Sum());
  line("physics", split.physics);
  line("rendering", split.rendering);
  line("sampling", split.sampling);
  line("records", split.records);
  line("encoding", split.encoding);
  line("writing", split.writing);
}

struct Run {
  std::size_t doors = 0;
  int threads = 1;
  double samples = 0;
  double processor_s = 0;
  double wall_s = 0;
};

// A whole collection into a folder of its own, doors read and records written.
Run MeasureRun(const std::string& doors, const fs::path& scratch, std::uint64_t episodes,
               int threads) {
  const fs::path folder = scratch / "run";
  fs::remove_all(folder);
  Run result;
  result.threads = threads;
  const double wall = WallSeconds();
  result.processor_s = SecondsOf([&] {
    StageRun run(RequestFor(doors, episodes));
    result.doors = run.doors().size();
    CollectRequest request = run.Request();
    request.folder = folder;
    request.threads = threads;
    Collect(
        run.plan(), [&](const PlannedEpisode& planned) { return run.Run(planned); }, request);
  });
  result.wall_s = WallSeconds() - wall;
  for (const DatasetPart& part : ReadDataset(folder).parts)
    result.samples += static_cast<double>(part.decisions);
  fs::remove_all(folder);
  return result;
}

void Print(const Run& run) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%6zu doors %2d threads %8.0f samples  %7.1f s processor  %7.1f s wall  "
      "%6.1f samples a processor second  %6.1f a second  at most %.0f MiB\n",
      run.doors, run.threads, run.samples, run.processor_s, run.wall_s,
      run.samples / run.processor_s, run.samples / run.wall_s,
      static_cast<double>(usage.ru_maxrss) / 1024);
  std::fflush(stdout);
}

std::string Counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Processor seconds over samples, both on logarithmic axes; a straight line of slope one is linear.
std::string PlotOf(const std::vector<Run>& runs) {
  constexpr double kLeft = 70;
  constexpr double kTop = 30;
  constexpr double kSize = 400;
  const auto x = [&](double samples) { return kLeft + kSize * (std::log10(samples) - 2) / 4; };
  const auto y = [&](double seconds) {
    return kTop + kSize - kSize * (std::log10(seconds) - 0) / 4;
  };
  std::ostringstream svg;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"700\" height=\"500\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n"
         "<rect width=\"700\" height=\"500\" fill=\"white\"/>\n";
  for (int decade = 0; decade <= 4; ++decade) {
    const double at_x = kLeft + kSize * decade / 4;
    const double at_y = kTop + kSize - kSize * decade / 4;
    svg << "<path d=\"M" << at_x << " " << kTop << "V" << kTop + kSize << "M" << kLeft << " "
        << at_y << "H" << kLeft + kSize << "\" stroke=\"#ddd\"/>\n<text x=\"" << at_x << "\" y=\""
        << kTop + kSize + 18 << "\" text-anchor=\"middle\">1e" << decade + 2
        << "</text>\n<text x=\"" << kLeft - 8 << "\" y=\"" << at_y + 4
        << "\" text-anchor=\"end\">1e" << decade << "</text>\n";
  }
  svg << "<text x=\"" << kLeft + kSize / 2 << "\" y=\"" << kTop + kSize + 40
      << "\" text-anchor=\"middle\">samples</text>\n<text x=\"18\" y=\"" << kTop + kSize / 2
      << "\" text-anchor=\"middle\" transform=\"rotate(-90 18 " << kTop + kSize / 2
      << ")\">processor seconds</text>\n"
      << "<path d=\"M" << x(100) << " " << y(2) << "L" << x(500000) << " " << y(10000)
      << "\" stroke=\"#888\" stroke-dasharray=\"5 4\"/>\n<text x=\"" << kLeft + kSize + 8
      << "\" y=\"" << kTop + 12 << "\" fill=\"#666\">dashed: 50 a second and core</text>\n";
  const char* const colors[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"};
  std::vector<std::string> names;
  for (const Run& run : runs) {
    const std::string name = Counted(run.doors, "door") + ", " +
                             Counted(static_cast<std::size_t>(run.threads), "thread");
    auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      names.push_back(name);
      found = names.end() - 1;
      svg << "<text x=\"" << kLeft + kSize + 8 << "\" y=\"" << kTop + 16 + 18 * names.size()
          << "\" fill=\"" << colors[(names.size() - 1) % 5] << "\">" << name << "</text>\n";
    }
    // rings of different size: the points nearly coincide
    const auto series = static_cast<std::size_t>(found - names.begin());
    svg << "<circle cx=\"" << x(run.samples) << "\" cy=\"" << y(run.processor_s) << "\" r=\""
        << 2 + 3 * series << "\" fill=\"none\" stroke-width=\"2\" stroke=\"" << colors[series % 5]
        << "\"/>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

// What Print() has printed; other lines are passed over.
std::vector<Run> ReadRuns(const fs::path& path) {
  std::ifstream file(path);
  std::vector<Run> runs;
  for (std::string line; std::getline(file, line);) {
    Run run;
    if (std::sscanf(line.c_str(), "%zu doors %d threads %lf samples %lf s processor %lf s wall",
                    &run.doors, &run.threads, &run.samples, &run.processor_s, &run.wall_s) == 5)
      runs.push_back(run);
  }
  Require(!runs.empty(), ErrorCode::kFormat, path.string() + ": holds no line of a run");
  return runs;
}

void WritePlot(const std::string& path, const std::vector<Run>& runs) {
  if (!path.empty()) std::ofstream(path) << PlotOf(runs);
}

// The categories take turns; within each, doors come as DrawDoors() draws them.
std::vector<fs::path> DrawnFolders(const fs::path& doors, std::size_t count) {
  std::map<Category, std::vector<fs::path>> categories;
  const DoorSelection selection{.folders = {doors}, .per_category = static_cast<int>(count)};
  for (const FoundDoor& door : FindDoorSet(selection, 0).doors)
    categories[door.identity.category].push_back(door.folder);
  std::vector<fs::path> drawn;
  for (std::size_t turn = 0; turn < count; ++turn) {
    for (const auto& [category, folders] : categories) {
      if (turn < folders.size() && drawn.size() < count) drawn.push_back(folders[turn]);
    }
  }
  return drawn;
}

// A folder of some of the doors, as links.
std::string SomeDoors(const fs::path& doors, const fs::path& scratch, std::size_t count) {
  const fs::path some = scratch / ("doors" + std::to_string(count));
  fs::create_directories(some);
  const auto options = fs::copy_options::recursive | fs::copy_options::create_hard_links;
  for (const fs::path& from : DrawnFolders(doors, count))
    fs::copy(from, some / from.filename(), options);
  if (fs::exists(doors / "pool")) fs::copy(doors / "pool", some / "pool", options);
  return some.string();
}

int Main(int argc, char** argv) {
  Require(argc >= 3, ErrorCode::kInvalidArgument,
          "usage: datagen_throughput DOORS SCRATCH [--samples 1000,10000] [--plot growth.svg], or "
          "--rows MEASURED --plot growth.svg");
  const fs::path doors = argv[1];
  const fs::path scratch = argv[2];
  const bool draws_only = doors == "--rows";
  std::string samples = "1000,10000";
  std::string plot;
  for (int i = 3; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--samples") samples = argv[i + 1];
    if (std::string(argv[i]) == "--plot") plot = argv[i + 1];
  }
  if (draws_only) {
    WritePlot(plot, ReadRuns(scratch));
    return 0;
  }
  fs::create_directories(scratch);
  const std::string one = SomeDoors(doors, scratch, 1);
  const std::string some = SomeDoors(doors, scratch, 16);
  const Split split = MeasureSplit(some, scratch, 32);
  Print(split);
  constexpr std::uint64_t kSamplesPerEpisode = 16;
  constexpr std::uint64_t kMostInAllWays = 20000;
  std::vector<Run> runs;
  std::istringstream list(samples);
  for (std::string word; std::getline(list, word, ',');) {
    const std::uint64_t episodes = std::stoull(word) / kSamplesPerEpisode;
    for (const auto& [which, threads] : std::vector<std::pair<std::string, int>>{
             {one, 1}, {some, 1}, {some, 2}, {doors.string(), 2}}) {
      const bool chief = which == some && threads == 2;
      if (!chief && episodes * kSamplesPerEpisode > kMostInAllWays) continue;
      runs.push_back(MeasureRun(which, scratch, episodes, threads));
      Print(runs.back());
    }
  }
  WritePlot(plot, runs);
  fs::remove_all(one);
  fs::remove_all(some);
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Main(argc, argv); });
}
