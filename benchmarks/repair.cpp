// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How well mesh files of any state are repaired: share, deviation, budget, time; beside a peer.
//
//   repair [--every N] [--only TEXT] [--details FILE] [--set key=value]... [--peer NAME=COMMAND]...
//          FOLDER...
//
// Takes every N-th mesh file below the folders, in the order of their paths. A mesh counts as
// repaired if the result is closed and oriented and no two of its triangles cross, which CGAL's
// does_self_intersect is asked for here, whatever the report says. Deviations are parts of the
// diagonal of the input's box, over about 5,000 points a surface and as many vertices: from the
// result to the input, and from the points of the input that a ray from outside reaches (96
// directions) to the result.
//
// A peer is a command run by the shell with {in} and {out} replaced by an STL file of the input
// and the path of the mesh that it is to write; its result is judged in the same way. Peers that
// are not installed are named and left out. Times are CPU seconds; a peer's are those of its
// process, less what it spends on an empty run (a tetrahedron).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/mesh/mesh_writer.h"
#include "doorforge/mesh/repair_mesh.h"
#include "doorforge/mesh/surface_deviation.h"

#include "peer_program.h"
#include "sample_sums.h"

namespace doorforge {
namespace {

using benchmarks::Quantile;
using benchmarks::Replace;
using benchmarks::RunLimited;
using benchmarks::Sum;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kWithin = 0.01;      // of the diagonal
constexpr rlim_t kPeerTimeoutS = 60;  // processor time

struct Options {
  std::vector<fs::path> folders;
  std::vector<std::string> settings;
  std::vector<std::pair<std::string, std::string>> peers;  // name, command
  std::string only;
  std::string details;
  std::size_t every = 1;
};

Options OptionsOf(int argc, char** argv) {
  const char* usage =
      "usage: repair [--every N] [--only TEXT] [--details FILE] [--set key=value]... "
      "[--peer NAME=COMMAND]... FOLDER...";
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (!argument.starts_with("--")) {
      options.folders.emplace_back(argument);
      continue;
    }
    Require(++i < argc, ErrorCode::kInvalidArgument, usage);
    const std::string value = argv[i];
    const std::size_t equals = value.find('=');
    if (argument == "--every") {
      options.every = std::max<std::size_t>(1, std::strtoul(value.c_str(), nullptr, 10));
    } else if (argument == "--only") {
      options.only = value;
    } else if (argument == "--details") {
      options.details = value;
    } else if (argument == "--set") {
      options.settings.push_back(value);
    } else if (argument == "--peer" && equals != std::string::npos) {
      options.peers.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else {
      throw Error(ErrorCode::kInvalidArgument, usage);
    }
  }
  Require(!options.folders.empty(), ErrorCode::kInvalidArgument, usage);
  return options;
}

std::vector<fs::path> MeshFiles(const Options& options) {
  static const std::set<std::string> kEndings = {".obj", ".stl", ".ply", ".dae", ".gltf",
                                                 ".glb", ".off", ".fbx", ".3ds"};
  std::vector<fs::path> all;
  for (const fs::path& folder : options.folders) {
    Require(fs::is_directory(folder), ErrorCode::kMissing, folder.string() + ": no such folder");
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      std::string ending = entry.path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (entry.is_regular_file() && kEndings.contains(ending) &&
          entry.path().string().find(options.only) != std::string::npos)
        all.push_back(entry.path());
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<fs::path> some;
  for (std::size_t i = 0; i < all.size(); i += options.every) some.push_back(all[i]);
  return some;
}

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// ---- judging a result -------------------------------------------------------------------------

bool TrianglesCross(const TriangleMesh& mesh) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  std::vector<CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index> vertices;
  for (const Eigen::Vector3d& v : mesh.vertices)
    vertices.push_back(surface.add_vertex({v.x(), v.y(), v.z()}));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto face = surface.add_face(vertices[static_cast<std::size_t>(t[0])],
                                       vertices[static_cast<std::size_t>(t[1])],
                                       vertices[static_cast<std::size_t>(t[2])]);
    if (!face.is_valid()) return true;  // fans that meet in one vertex touch each other
  }
  return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

struct Judgement {
  bool closed = false;
  bool crosses = false;
  bool in_budget = false;
  double worst = 0;     // of the diagonal, both ways
  double to_input = 0;  // means, of the diagonal
  double from_visible = 0;
  std::size_t triangles = 0;

  bool repaired() const { return closed && !crosses; }
};

Judgement Judged(const TriangleMesh& input, const TriangleMesh& output) {
  Judgement judged;
  judged.triangles = output.triangles.size();
  judged.in_budget = judged.triangles <= 3 * input.triangles.size() + 5000;
  judged.closed = ClosedMesh::From(output).has_value();
  if (!judged.closed) return judged;
  judged.crosses = TrianglesCross(output);
  const double diagonal_m = MeasureTopology(input).bounds.diagonal().norm();
  const SurfaceDeviation out = DeviationOf(output, input, {.samples = 5000});
  const SurfaceDeviation in =
      DeviationOf(input, output, {.samples = 5000, .visible_only = true, .rays = 96});
  judged.worst = std::max(out.max_m, in.max_m) / diagonal_m;
  judged.to_input = out.mean_m / diagonal_m;
  judged.from_visible = in.mean_m / diagonal_m;
  return judged;
}

// ---- sums over the files ----------------------------------------------------------------------

class Tally {
 public:
  void Add(const std::optional<Judgement>& judged, double cpu_s) {
    ++files_;
    cpu_s_.push_back(cpu_s);
    if (!judged) return;
    ++written_;
    closed_ += judged->closed;
    if (!judged->repaired()) return;
    worst_.push_back(judged->worst);
    to_input_.push_back(judged->to_input);
    from_visible_.push_back(judged->from_visible);
    in_budget_ += judged->in_budget;
  }

  void Print(const std::string& name) const {
    const auto repaired = static_cast<int>(worst_.size());
    const auto within = static_cast<int>(
        std::count_if(worst_.begin(), worst_.end(), [](double worst) { return worst <= kWithin; }));
    std::printf("%s, %d files\n", name.c_str(), files_);
    std::printf("  closed                   %5d  %5.1f %%\n", closed_, Percent(closed_, files_));
    std::printf("  repaired                 %5d  %5.1f %%  closed and no triangles cross\n",
                repaired, Percent(repaired, files_));
    std::printf("  of those within 1 %%      %5d  %5.1f %%  of the diagonal, both ways\n", within,
                Percent(within, repaired));
    std::printf("  of those in the budget   %5d  %5.1f %%  of 3 times the input plus 5,000\n",
                in_budget_, Percent(in_budget_, repaired));
    std::printf("  mean deviation           %.3f %% to the input, %.3f %% from its outside\n",
                100 * Mean(to_input_), 100 * Mean(from_visible_));
    std::printf("  largest deviation        median %.2f %%, p95 %.2f %%, most %.2f %%\n",
                100 * Quantile(worst_, 0.5), 100 * Quantile(worst_, 0.95),
                100 * Quantile(worst_, 1));
    std::printf("  CPU time                 median %.3f s, p95 %.2f s, most %.1f s, all %.0f s\n",
                Quantile(cpu_s_, 0.5), Quantile(cpu_s_, 0.95), Quantile(cpu_s_, 1), Sum(cpu_s_));
  }

 private:
  static double Percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }
  static double Mean(const std::vector<double>& values) {
    return values.empty() ? 0 : Sum(values) / static_cast<double>(values.size());
  }

  int files_ = 0;
  int written_ = 0;
  int closed_ = 0;
  int in_budget_ = 0;
  std::vector<double> worst_, to_input_, from_visible_, cpu_s_;
};

// ---- peers ------------------------------------------------------------------------------------

class Peer {
 public:
  Peer(std::string name, std::string command)
      : name_(std::move(name)), command_(std::move(command)) {
    std::string pattern = (fs::temp_directory_path() / "doorforge_repair_XXXXXX").string();
    Require(mkdtemp(pattern.data()) != nullptr, ErrorCode::kIo, "no temporary folder");
    folder_ = pattern;
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const auto [output, cpu_s] = Run(tetrahedron);
    installed_ = output.has_value();
    idle_s_ = cpu_s;
  }
  ~Peer() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  const std::string& name() const { return name_; }
  bool installed() const { return installed_; }

  Json Repair(const TriangleMesh& input) {
    const auto [output, cpu_s] = Run(input);
    std::optional<Judgement> judged;
    if (output) judged = Judged(input, *output);
    tally_.Add(judged, std::max(0.0, cpu_s - idle_s_));
    if (!judged) return {{"written", false}};
    return {{"closed", judged->closed}, {"crosses", judged->crosses}, {"worst", judged->worst}};
  }
  void Print() const { tally_.Print(name_); }

 private:
  std::pair<std::optional<TriangleMesh>, double> Run(const TriangleMesh& input) const {
    const fs::path in = folder_ / "in.stl";
    const fs::path out = folder_ / "out.stl";
    CommitFile(in, WriterFor(in)(input), Existing::kReplace);
    fs::remove(out);
    std::string command = command_;
    Replace(command, "{in}", in.string());
    Replace(command, "{out}", out.string());
    const double cpu_s = RunLimited(command, kPeerTimeoutS);
    if (!fs::exists(out)) return {std::nullopt, cpu_s};
    try {
      return {MergedPieces(ImportMesh(out)), cpu_s};
    } catch (const Error&) {
      return {std::nullopt, cpu_s};
    }
  }

  std::string name_, command_;
  fs::path folder_;
  bool installed_ = false;
  double idle_s_ = 0;
  Tally tally_;
};

// ---- the run ----------------------------------------------------------------------------------

class Run {
 public:
  explicit Run(const Options& options)
      : config_(LoadConfig<RepairConfig>("", options.settings)), details_(options.details) {
    for (const auto& [name, command] : options.peers) {
      auto peer = std::make_unique<Peer>(name, command);
      if (peer->installed())
        peers_.push_back(std::move(peer));
      else
        std::printf("peer %s is not there, or cannot repair a tetrahedron: left out\n",
                    name.c_str());
    }
  }

  void Add(const fs::path& file) {
    TriangleMesh input;
    try {
      input = MergedPieces(ImportMesh(file));
    } catch (const Error& error) {
      ++unread_;
      Note({{"file", file.string()}, {"unread", error.what()}});
      return;
    }
    const double begin_s = CpuSeconds();
    const RepairResult result = RepairMesh(input, config_);
    const double cpu_s = CpuSeconds() - begin_s;
    std::optional<Judgement> judged;
    if (result.mesh) judged = Judged(input, result.mesh->mesh());
    tally_.Add(judged, cpu_s);
    const std::string outcome(NameOf(result.report.outcome));
    ++outcomes_[outcome];
    if (!result.mesh) ++refusals_[result.report.reason];
    Json note = {{"file", file.string()},
                 {"outcome", outcome},
                 {"cpu_s", cpu_s},
                 {"triangles", input.triangles.size()},
                 {"reason", result.report.reason},
                 {"steps", result.report.steps}};
    if (judged) {
      note["after"] = judged->triangles;
      note["crosses"] = judged->crosses;
      note["worst"] = judged->worst;
      note["to_input"] = judged->to_input;
      note["from_visible"] = judged->from_visible;
      note["max_out_m"] = result.report.output_to_input.max_m;
      note["max_in_m"] = result.report.visible_input_to_output.max_m;
    }
    for (const auto& peer : peers_) note[peer->name()] = peer->Repair(input);
    Note(note);
  }

  void Print(std::size_t files) const {
    std::printf("%zu mesh files, %d of them cannot be read (wrong format, no triangles)\n", files,
                unread_);
    tally_.Print("doorforge");
    for (const auto& [outcome, count] : outcomes_)
      std::printf("  %-24s %5d\n", outcome.c_str(), count);
    for (const auto& [reason, count] : refusals_)
      std::printf("  refused: %s: %d\n", reason.c_str(), count);
    for (const auto& peer : peers_) peer->Print();
  }

 private:
  void Note(const Json& note) {
    if (details_.is_open()) details_ << JsonText(note) << std::endl;
  }

  RepairConfig config_;
  std::ofstream details_;
  int unread_ = 0;
  Tally tally_;
  std::map<std::string, int> outcomes_, refusals_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

int Main(int argc, char** argv) {
  const Options options = OptionsOf(argc, argv);
  const std::vector<fs::path> files = MeshFiles(options);
  Require(!files.empty(), ErrorCode::kMissing, "no mesh file below the folders");
  Run run(options);
  for (const fs::path& file : files) {
    if (StopRequested() != 0) return 128 + StopRequested();
    run.Add(file);
  }
  run.Print(files.size());
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Main(argc, argv); });
}
