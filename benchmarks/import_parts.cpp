// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What importing real objects costs, part by part and stage by stage, and how good it comes out;
// beside other programs that make convex parts.
//
//   import_parts [--every N] [--only TEXT] [--format F] [--details FILE] [--keep DIR]
//                [--samples N] [--set read.key=value]... [--set make.key=value]...
//                [--peer NAME=COMMAND]... FOLDER...
//
// Takes every N-th part of the objects below the folders, each part once, in the order of the
// objects. Times are CPU seconds of one thread, with those of the processes that read files. A
// part's pieces (leaf and frame, grip and rose) are judged one by one: whether the repaired mesh is
// closed and its triangles cross nowhere, how far it lies from the input and the visible input from
// it (parts of the diagonal), how many convex parts there are, how far they stand out of the mesh
// and what of it they leave out. The largest of 2,000 sampled distances, as the report of a repair
// has them, is a matter of luck where little of a surface lies far off: --samples measures over N
// points instead, outside of the times. --keep writes each piece's closed mesh to DIR as OBJ.
//
// A peer is a command run by the shell with {in} and {out} replaced by an OBJ file of the closed
// mesh, in metres, and the path of the OBJ file that it is to write, one object a convex part. Its
// parts are measured as ours are. Its time is that of its process, less what it spends on a
// tetrahedron. Peers that are not installed are named and left out.

#include <algorithm>
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

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/core/program.h"
#include "doorforge/importers/import_objects.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/mesh/mesh_writer.h"
#include "doorforge/parts/grasp.h"

#include "peer_program.h"
#include "sample_sums.h"

namespace doorforge {
namespace {

using benchmarks::Quantile;
using benchmarks::Replace;
using benchmarks::RunLimited;
using benchmarks::SecondsOf;
using benchmarks::Sum;

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr rlim_t kPeerTimeoutS = 300;  // processor time
constexpr double kLongestGripM = 1.0;  // as import looks for a grasp

struct Settings {
  ReadConfig read = {.allow_missing = "frame"};
  MakePartConfig make = {};

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("read", self.read);
    visit("make", self.make);
  }
};

struct Options {
  std::vector<fs::path> folders;
  std::vector<std::string> settings;
  std::vector<std::pair<std::string, std::string>> peers;  // name, command
  std::string only, format = "auto", details, keep;
  std::size_t every = 1;
  int samples = 0;  // of deviations; 0: those of the repair's report
};

Options OptionsOf(int argc, char** argv) {
  const char* usage =
      "usage: import_parts [--every N] [--only TEXT] [--format F] [--details FILE] [--keep DIR] "
      "[--samples N] [--set key=value]... [--peer NAME=COMMAND]... FOLDER...";
  Options options;
  const std::map<std::string, std::string*> texts = {{"--only", &options.only},
                                                     {"--format", &options.format},
                                                     {"--details", &options.details},
                                                     {"--keep", &options.keep}};
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
    } else if (argument == "--samples") {
      options.samples = std::atoi(value.c_str());
      Require(options.samples > 0, ErrorCode::kInvalidArgument, usage);
    } else if (argument == "--set") {
      options.settings.push_back(value);
    } else if (argument == "--peer" && equals != std::string::npos) {
      options.peers.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else {
      Require(texts.contains(argument), ErrorCode::kInvalidArgument, usage);
      *texts.at(argument) = value;
    }
  }
  Require(!options.folders.empty(), ErrorCode::kInvalidArgument, usage);
  return options;
}

// It counts this process and those that it started and that have ended.
double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  rusage children{};
  getrusage(RUSAGE_CHILDREN, &children);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) +
         SecondsOf(children);
}

// Runs `work` and adds its CPU time to `seconds`.
template <class Work>
auto Timed(double& seconds, const Work& work) {
  const double begin_s = CpuSeconds();
  auto result = work();
  seconds += CpuSeconds() - begin_s;
  return result;
}

// ---- sums -------------------------------------------------------------------------------------

class Column {
 public:
  void Add(double value) { values_.push_back(value); }
  std::size_t count() const { return values_.size(); }

  void Print(const std::string& name, double factor, const char* unit) const {
    std::printf("  %-34s median %8.3f  p95 %8.3f  most %8.3f  mean %8.3f %s\n", name.c_str(),
                factor * Quantile(values_, 0.5), factor * Quantile(values_, 0.95),
                factor * Quantile(values_, 1),
                values_.empty() ? 0 : factor * Sum(values_) / static_cast<double>(values_.size()),
                unit);
  }

 private:
  std::vector<double> values_;
};

// How far parts stand out and what they leave out, of one kind of piece.
struct FitColumns {
  Column parts, protrusion_m, uncovered_m, cpu_s;

  void Print(const std::string& name) const {
    std::printf("%s, %zu pieces\n", name.c_str(), parts.count());
    parts.Print("convex parts", 1, "");
    protrusion_m.Print("protrusion", 1000, "mm");
    uncovered_m.Print("uncovered", 1000, "mm");
    cpu_s.Print("CPU time of the convex parts", 1, "s");
  }
};

// ---- peers ------------------------------------------------------------------------------------

// Programs write hulls whose faces are flat to within rounding only; those of their corners are
// convex. Hulls without thickness stand for nothing.
std::vector<TriangleMesh> HullsIn(const fs::path& file) {
  std::vector<TriangleMesh> hulls;
  for (const ImportedPiece& piece : ImportMesh(file).pieces) {
    try {
      hulls.push_back(ConvexHull(piece.mesh.vertices));
    } catch (const Error&) {
      continue;  // in one plane
    }
  }
  return hulls;
}

class Peer {
 public:
  Peer(std::string name, std::string command)
      : name_(std::move(name)), command_(std::move(command)) {
    std::string pattern = (fs::temp_directory_path() / "doorforge_parts_XXXXXX").string();
    Require(mkdtemp(pattern.data()) != nullptr, ErrorCode::kIo, "no temporary folder");
    folder_ = pattern;
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const auto [hulls, cpu_s] = Run(tetrahedron);
    installed_ = !hulls.empty();
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

  Json Add(const ClosedMesh& mesh, const std::string& kind) {
    const auto [hulls, cpu_s] = Run(mesh.mesh());
    if (hulls.empty()) return {{"written", false}, {"cpu_s", cpu_s}};
    const ConvexPartsFit fit = MeasureConvexParts(mesh, hulls);
    FitColumns& columns = columns_[kind];
    columns.parts.Add(static_cast<double>(hulls.size()));
    columns.protrusion_m.Add(fit.protrusion_m);
    columns.uncovered_m.Add(fit.uncovered_m);
    columns.cpu_s.Add(std::max(0.0, cpu_s - idle_s_));
    return {{"parts", hulls.size()},
            {"protrusion_m", fit.protrusion_m},
            {"uncovered_m", fit.uncovered_m},
            {"cpu_s", std::max(0.0, cpu_s - idle_s_)}};
  }

  void Print() const {
    for (const auto& [kind, columns] : columns_) columns.Print(name_ + ": " + kind);
  }

 private:
  std::pair<std::vector<TriangleMesh>, double> Run(const TriangleMesh& mesh) const {
    const fs::path in = folder_ / "in.obj";
    const fs::path out = folder_ / "out.obj";
    CommitFile(in, WriterFor(in)(mesh), Existing::kReplace);
    fs::remove(out);
    std::string command = command_;
    Replace(command, "{in}", in.string());
    Replace(command, "{out}", out.string());
    const double cpu_s = RunLimited(command, kPeerTimeoutS);
    if (!fs::exists(out)) return {{}, cpu_s};
    try {
      return {HullsIn(out), cpu_s};
    } catch (const Error&) {
      return {{}, cpu_s};
    }
  }

  std::string name_, command_;
  fs::path folder_;
  bool installed_ = false;
  double idle_s_ = 0;
  std::map<std::string, FitColumns> columns_;
};

// ---- the run ----------------------------------------------------------------------------------

struct NamedPart {
  std::string name;  // the object's and the part's
  std::string category;
  ForeignPart part;
};

std::vector<NamedPart> PartsBelow(const Options& options, const ReadConfig& config) {
  std::vector<NamedPart> all;
  std::set<std::string> known;
  for (const ForeignSource& source : FindObjects(options.folders, options.format)) {
    if (source.path.string().find(options.only) == std::string::npos) continue;
    try {
      for (const ForeignObject& object : ReadObjects(source, config)) {
        for (const ForeignPart& part : object.parts) {
          if (known.insert(part.source_sha256).second)
            all.push_back({source.path.string() + ": " + part.id, object.category, part});
        }
      }
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
  }
  std::vector<NamedPart> some;
  for (std::size_t i = 0; i < all.size(); i += options.every) some.push_back(std::move(all[i]));
  return some;
}

const ConvexPartsConfig& ConvexConfigOf(const std::string& piece, const MakePartConfig& config) {
  if (piece == "frame") return config.frame_convex;
  return piece == "leaf" ? config.leaf_convex : config.handle_convex;
}

struct StageSeconds {
  double read = 0, repair = 0, convex = 0, measure = 0, grasp = 0;

  double Total() const { return read + repair + convex + measure + grasp; }
};

class Run {
 public:
  Run(const Options& options, const Settings& settings)
      : settings_(settings),
        details_(options.details),
        keep_(options.keep),
        samples_(options.samples) {
    if (!keep_.empty()) fs::create_directories(keep_);
    for (const auto& [name, command] : options.peers) {
      auto peer = std::make_unique<Peer>(name, command);
      if (peer->installed())
        peers_.push_back(std::move(peer));
      else
        std::printf("peer %s is not there, or makes no part of a tetrahedron: left out\n",
                    name.c_str());
    }
  }

  void Add(const NamedPart& named) {
    StageSeconds seconds;
    std::optional<LoadedPart> loaded;
    try {
      loaded = Timed(seconds.read, [&] { return named.part.load(); });
    } catch (const Error& error) {
      ++unread_;
      std::fprintf(stderr, "%s: %s\n", named.name.c_str(), error.what());
      return;
    }
    std::vector<TriangleMesh> closed;
    TriangleMesh grip;
    for (const RawPiece& raw : loaded->draft.pieces) {
      const std::optional<ClosedMesh> mesh = AddPiece(named, raw, seconds);
      if (!mesh) continue;
      closed.push_back(mesh->mesh());
      if (raw.name == "grip") grip = mesh->mesh();
    }
    if (!grip.vertices.empty() && BoundsOf(grip).sizes().maxCoeff() <= kLongestGripM) {
      const RefinedGrasp grasp = Timed(seconds.grasp, [&] {
        return RefineGrasp(grip, Merged(closed), loaded->draft.facts.part_from_grasp);
      });
      ++grips_;
      held_ += grasp.fit.holds;
    }
    NoteTimes(named, seconds);
  }

  void Print() const {
    std::printf("%zu parts, %d more cannot be read\n", total_.count(), unread_);
    total_.Print("CPU time of a part", 1, "s");
    read_.Print("  reading", 1, "s");
    repair_.Print("  repair and simplification", 1, "s");
    convex_.Print("  convex parts", 1, "s");
    measure_.Print("  measuring them", 1, "s");
    grasp_.Print("  looking for the grasp", 1, "s");
    std::printf("%d pieces: %d closed, of which %d cross themselves\n", pieces_, closed_, cross_);
    for (const auto& [outcome, count] : outcomes_)
      std::printf("  %-34s %d\n", outcome.c_str(), count);
    to_input_.Print("largest deviation to the input", 100, "% of the diagonal");
    from_visible_.Print("largest deviation from its outside", 100, "% of the diagonal");
    to_input_mean_.Print("mean deviation to the input", 100, "% of the diagonal");
    from_visible_mean_.Print("mean deviation from its outside", 100, "% of the diagonal");
    std::printf("a grasp that holds on %d of %d grips\n", held_, grips_);
    for (const auto& [kind, columns] : fits_) columns.Print(kind);
    for (const auto& peer : peers_) peer->Print();
  }

 private:
  std::optional<ClosedMesh> AddPiece(const NamedPart& named, const RawPiece& raw,
                                     StageSeconds& seconds) {
    ++pieces_;
    double repair_s = 0;
    double convex_s = 0;
    const RepairResult repaired =
        Timed(repair_s, [&] { return RepairMesh(raw.mesh, settings_.make.repair); });
    seconds.repair += repair_s;
    const RepairReport& report = repaired.report;
    ++outcomes_[std::string(NameOf(report.outcome))];
    if (!repaired.mesh) return std::nullopt;
    std::optional<ClosedMesh> closed = ClosedMesh::From(RoundedToFloat(repaired.mesh->mesh()));
    if (!closed) closed = repaired.mesh;
    ++closed_;
    cross_ += report.self_intersects;
    const double diagonal_m = BoundsOf(raw.mesh).diagonal().norm();
    const auto [to_input, from_visible] = DeviationsOf(raw.mesh, repaired);
    to_input_.Add(to_input.max_m / diagonal_m);
    from_visible_.Add(from_visible.max_m / diagonal_m);
    to_input_mean_.Add(to_input.mean_m / diagonal_m);
    from_visible_mean_.Add(from_visible.mean_m / diagonal_m);
    const std::vector<TriangleMesh> parts = Timed(
        convex_s, [&] { return ConvexParts(*closed, ConvexConfigOf(raw.name, settings_.make)); });
    seconds.convex += convex_s;
    const ConvexPartsFit fit =
        Timed(seconds.measure, [&] { return MeasureConvexParts(*closed, parts); });
    FitColumns& columns = fits_[raw.name];
    columns.parts.Add(static_cast<double>(parts.size()));
    columns.protrusion_m.Add(fit.protrusion_m);
    columns.uncovered_m.Add(fit.uncovered_m);
    columns.cpu_s.Add(convex_s);
    Json note = {{"part", named.name},
                 {"piece", raw.name},
                 {"category", named.category},
                 {"outcome", NameOf(report.outcome)},
                 {"crosses", report.self_intersects},
                 {"triangles", raw.mesh.triangles.size()},
                 {"after", closed->mesh().triangles.size()},
                 {"to_input", to_input.max_m / diagonal_m},
                 {"from_visible", from_visible.max_m / diagonal_m},
                 {"to_input_mean", to_input.mean_m / diagonal_m},
                 {"from_visible_mean", from_visible.mean_m / diagonal_m},
                 {"repair_s", repair_s},
                 {"convex_s", convex_s},
                 {"parts", parts.size()},
                 {"protrusion_m", fit.protrusion_m},
                 {"uncovered_m", fit.uncovered_m},
                 {"steps", report.steps},
                 {"reason", report.reason}};
    if (!keep_.empty()) Keep(named, raw.name, *closed);
    for (const auto& peer : peers_) note[peer->name()] = peer->Add(*closed, raw.name);
    Note(note);
    return closed;
  }

  // To the input and from its outside, of the report or over as many points as were asked for.
  std::pair<SurfaceDeviation, SurfaceDeviation> DeviationsOf(const TriangleMesh& input,
                                                             const RepairResult& repaired) const {
    const RepairReport& report = repaired.report;
    if (samples_ == 0) return {report.output_to_input, report.visible_input_to_output};
    const TriangleMesh& output = repaired.mesh->mesh();
    return {DeviationOf(output, input, {.samples = samples_}),
            DeviationOf(input, output, {.samples = samples_, .visible_only = true, .rays = 48})};
  }

  void Keep(const NamedPart& named, const std::string& piece, const ClosedMesh& closed) const {
    const fs::path file = keep_ / (named.part.id + "_" + piece + ".obj");
    CommitFile(file, WriterFor(file)(closed.mesh()), Existing::kReplace);
  }

  void NoteTimes(const NamedPart& named, const StageSeconds& seconds) {
    total_.Add(seconds.Total());
    read_.Add(seconds.read);
    repair_.Add(seconds.repair);
    convex_.Add(seconds.convex);
    measure_.Add(seconds.measure);
    grasp_.Add(seconds.grasp);
    Note({{"part", named.name},
          {"total_s", seconds.Total()},
          {"read_s", seconds.read},
          {"repair_s", seconds.repair},
          {"convex_s", seconds.convex},
          {"measure_s", seconds.measure},
          {"grasp_s", seconds.grasp}});
  }

  void Note(const Json& note) {
    if (details_.is_open()) details_ << note.dump() << std::endl;
  }

  Settings settings_;
  std::ofstream details_;
  fs::path keep_;
  int samples_ = 0;
  int unread_ = 0, pieces_ = 0, closed_ = 0, cross_ = 0, grips_ = 0, held_ = 0;
  Column total_, read_, repair_, convex_, measure_, grasp_;
  Column to_input_, from_visible_, to_input_mean_, from_visible_mean_;
  std::map<std::string, int> outcomes_;
  std::map<std::string, FitColumns> fits_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

int Main(int argc, char** argv) {
  const Options options = OptionsOf(argc, argv);
  const auto settings = LoadConfig<Settings>("", options.settings);
  Run run(options, settings);
  for (const NamedPart& part : PartsBelow(options, settings.read)) {
    if (StopRequested() != 0) return 128 + StopRequested();
    run.Add(part);
  }
  run.Print();
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Main(argc, argv); });
}
