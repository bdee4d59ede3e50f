// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/foreign/validate_foreign.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/read_beginning.h"
#include "doorforge/foreign/foreign_rules.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/mesh/work_budget.h"

#include "check/check_hinge.h"
#include "check/check_profile.h"
#include "check/checks.h"
#include "read/raw_mesh.h"
#include "run/read_object.h"
#include "run/read_text_apart.h"
#include "run/second_opinion.h"

namespace doorforge {
namespace foreign {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostLinks = 2000;

std::string LowerEndingOf(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// One file's check, from its bytes to its report.
class FileCheck {
 public:
  FileCheck(const fs::path& file, const fs::path& searched, const ForeignChecks& checks,
            MeshMemory& memory)
      : file_(file), name_(file.string()), checks_(checks), memory_(memory) {
    root_ = checks_.root.empty() ? RootAbove(file_, searched)
                                 : fs::absolute(checks_.root).lexically_normal();
  }

  ValidationReport Run() {
    const std::string ending = LowerEndingOf(file_);
    if (const std::string problem = FileProblem(); !problem.empty()) {
      faults_.Add("FIL001", Whole(), problem);
    } else if (IsMesh(ending)) {
      Mesh();
    } else if (ending == ".xacro") {
      kind_ = ValidatedKind::kUrdf;
      faults_.Add("FIL010", Whole(), "a xacro file");
    } else if (IsText(ending)) {
      kind_ = KindByEnding(ending);
      Text();
    } else {
      faults_.Add("FIL011", Whole(), "the ending \"" + ending + '"');
    }
    return Report();
  }

  static bool IsMesh(const std::string& ending) {
    static const std::set<std::string> endings = {".obj", ".stl", ".ply", ".off",
                                                  ".dae", ".fbx", ".3ds"};
    return endings.contains(ending);
  }
  ValidationReport Report() {
    ValidationReport report;
    report.folder = file_;
    report.findings = faults_.Sorted();
    report.kind = kind_;
    report.notes = notes_;
    for (const Finding& finding : report.findings) {
      report.errors += finding.severity == Severity::kError;
      report.warnings += finding.severity == Severity::kWarning;
    }
    return report;
  }

  /// To be called after Run().
  ReadObject Object() && { return {std::move(object_), Places()}; }

  FaultList& faults() { return faults_; }
  SourcePlace Whole() const { return {name_, 0, 0, {}}; }

 private:
  std::string FileProblem() const {
    std::error_code error;
    const fs::file_status status = fs::status(file_, error);
    if (!fs::exists(status)) return "no such file";
    if (!fs::is_regular_file(status)) return kNoRegularFile;
    if (fs::file_size(file_, error) == 0) return "the file is empty";
    return {};
  }

  MeshFiles::Places Places() const {
    const fs::path folder = fs::absolute(file_).lexically_normal().parent_path();
    return {folder, root_, checks_.packages};
  }
  MeshFiles Files() const { return {Places(), memory_}; }

  void Text() {
    TextReadApart apart = ReadTextApart(file_, Places(), Asks("urdfdom"));
    faults_ = std::move(apart.faults);
    notes_ = std::move(apart.read.notes);
    urdfdom_ = std::move(apart.urdfdom);
    kind_ = apart.read.kind;
    const bool judges = apart.read.after == AfterText::kJudge;
    if (kind_ == ValidatedKind::kGltf) {
      if (judges) Gltf(std::move(apart.read.mesh));
      AskAssimp();
    } else if (judges) {
      Judge(std::move(apart.read.object));
    } else if (apart.read.after == AfterText::kAsk) {
      Ask();
    }
  }

  void Judge(ArticulatedObject read) {
    object_ = std::move(read);
    const ArticulatedObject& object = object_;
    if (faults_.Has("FIL010")) return;
    if (object.links.size() > kMostLinks || object.joints.size() > kMostLinks)
      return faults_.Add("FIL003", object.place,
                         std::to_string(object.links.size()) + " links and " +
                             std::to_string(object.joints.size()) +
                             " joints, more than the 2000 allowed");
    // a stage without bodies, and a world that includes all, have no links
    const bool needs_links = kind_ == ValidatedKind::kUrdf;
    if (needs_links || !object.links.empty()) CheckTree(object, faults_);
    CheckJoints(object, faults_);
    const ObjectTree tree(object);
    MeshFiles files = Files();
    const std::vector<LinkBounds> bounds = CheckShapes(object, tree, files, faults_);
    CheckInertials(object, tree, bounds, faults_);
    CheckHinge({object, tree, bounds, files, checks_.hinge, checks_.handle}, faults_, notes_);
    CheckProfile({file_, kind_, object, tree, files}, checks_.target, faults_);
    Ask();
  }

  // What others say is a finding where our rules found nothing, else a note.
  void Say(const SecondOpinion& opinion, const char* code) {
    if (opinion.opinion == Opinion::kTakes) {
      notes_.push_back(opinion.program + " takes it");
    } else if (opinion.opinion == Opinion::kNotAsked) {
      notes_.push_back(opinion.program + " was not asked: " + opinion.words);
    } else if (faults_.HasError()) {
      notes_.push_back(opinion.program + " refuses it as well: " + opinion.words);
    } else {
      faults_.Add(code, Whole(), opinion.program + " refuses it: " + opinion.words);
    }
  }

  bool Asks(const char* program) const {
    return std::find(checks_.ask.begin(), checks_.ask.end(), program) != checks_.ask.end();
  }

  // What is beyond our limits would keep another program busy for as long as it may run, and a pipe
  // in the place of a file would keep it waiting.
  bool IsBeyondLimits() const {
    return faults_.Has("FIL003") || faults_.Has("FIL004") || faults_.Says(kNoRegularFile);
  }

  void Ask() {
    if (IsBeyondLimits()) return notes_.push_back("no other program was asked about it");
    if (kind_ == ValidatedKind::kUrdf) {
      if (urdfdom_)
        Say(*urdfdom_, "EXT001");
      else
        notes_.push_back("urdfdom was not asked");
    }
    if (kind_ == ValidatedKind::kMjcf) {
      if (Asks("mujoco"))
        Say(AskProgram("mujoco", fs::absolute(file_)), "EXT002");
      else
        notes_.push_back("MuJoCo was not asked");
    }
    if (kind_ == ValidatedKind::kSdf) {
      if (Asks("sdformat"))
        Say(AskProgram("sdformat", fs::absolute(file_)), "EXT004");
      else
        notes_.push_back("sdformat was not asked");
    }
  }

  // What doorforge's own readers import they are asked for in their process, too.
  void AskAssimp() {
    const std::string ending = LowerEndingOf(file_);
    const bool own = ending == ".obj" || ending == ".stl" || ending == ".ply";
    const std::string name = own ? "`doorforge import`" : "assimp";
    if (IsBeyondLimits()) return notes_.push_back(name + " was not asked about it");
    if (!Asks("assimp")) return notes_.push_back(name + " was not asked");
    SecondOpinion opinion{Opinion::kTakes, name, {}};
    try {
      ImportMesh(file_, {.files_below = root_});
    } catch (const Error& error) {
      opinion.opinion =
          error.code() == ErrorCode::kMissing ? Opinion::kNotAsked : Opinion::kRefuses;
      opinion.words = error.what();
    }
    Say(opinion, "EXT003");
  }

  void Gltf(TriangleMesh mesh) {
    if (!faults_.HasError() && !mesh.triangles.empty()) CheckScale(MeasureTriangles(mesh));
    Keep(std::move(mesh), true);
  }

  void Mesh() {
    kind_ = ValidatedKind::kMesh;
    try {
      std::vector<ForeignFileName> named;
      TriangleMesh mesh = TrianglesOf(file_, root_, named);
      const MeshMeasure measure = MeasureTriangles(mesh);
      Keep(std::move(mesh), false);
      CheckTriangles(measure, Whole(), "", faults_);
      CheckScale(measure);
      const MeshFiles files = Files();
      for (const ForeignFileName& name : named) files.Find(name, faults_);
    } catch (const RawMeshFault& fault) {
      faults_.Add("GEO005", {name_, fault.line, 0, {}}, fault.what());
    } catch (const Error& error) {
      faults_.Add("GEO005", Whole(), error.what());
    }
    AskAssimp();
  }

  // Triangles alone are an object of one shape.
  void Keep(TriangleMesh mesh, bool y_up) {
    ForeignShape shape;
    shape.name = file_.filename().string();
    shape.use = ShapeUse::kBoth;
    shape.geometry = std::move(mesh);
    shape.place = Whole();
    ForeignLink link;
    link.name = file_.stem().string();
    link.shapes.push_back(std::move(shape));
    link.place = Whole();
    object_.links.push_back(std::move(link));
    object_.place = Whole();
    object_.y_up = y_up;
  }

  void CheckScale(const MeshMeasure& measure) {
    const double diagonal = measure.topology.bounds.diagonal().norm();
    constexpr double kSmallest = 0.001;
    if (diagonal > AnyRule("GEO008").limit || diagonal < kSmallest)
      faults_.Add("GEO008", Whole(), Measured(diagonal, "m"));
  }

  fs::path file_;
  std::string name_;
  const ForeignChecks& checks_;
  MeshMemory& memory_;
  fs::path root_;
  ValidatedKind kind_ = ValidatedKind::kUnknown;
  std::vector<std::string> notes_;
  FaultList faults_;
  ArticulatedObject object_;
  std::optional<SecondOpinion> urdfdom_;
};

}  // namespace

ReadObject ReadObjectOf(const fs::path& file, const fs::path& searched,
                        const ForeignChecks& checks) {
  ForeignChecks ours = checks;
  ours.ask.clear();
  MeshMemory memory;
  FileCheck check(file, searched, ours, memory);
  check.Run();
  return std::move(check).Object();
}

}  // namespace foreign

struct ForeignValidator::Memory {
  foreign::MeshMemory meshes;
};

ForeignValidator::ForeignValidator(ForeignChecks checks)
    : checks_(std::move(checks)), memory_(std::make_unique<Memory>()) {}
ForeignValidator::~ForeignValidator() = default;

ValidationReport ForeignValidator::Validate(const std::filesystem::path& file,
                                            const std::filesystem::path& searched) const {
  const WorkBudget budget(file.string());
  foreign::FileCheck check(file, searched, checks_, memory_->meshes);
  try {
    return check.Run();
  } catch (const std::exception&) {
    check.faults().Add("FIL012", check.Whole(), CurrentProblem(file.string()));
    return check.Report();
  }
}

namespace {

bool BeginsWithRoot(const std::filesystem::path& file) {
  const std::string begin = ReadBeginning(file, 2048);
  const auto has = [&](std::string_view tag) {
    const std::size_t at = begin.find(tag);
    return at != std::string::npos && at + tag.size() < begin.size() &&
           std::string_view(" \t\r\n>/").find(begin[at + tag.size()]) != std::string_view::npos;
  };
  return has("<mujoco") || has("<robot") || has("<sdf");
}

enum class FileKind { kOther, kObject, kMesh };

FileKind KindOf(const std::filesystem::path& file) {
  const std::string ending = foreign::LowerEndingOf(file);
  static const std::set<std::string> objects = {".urdf", ".sdf",  ".mjcf", ".usda",
                                                ".usd",  ".usdc", ".usdz"};
  if (objects.contains(ending)) return FileKind::kObject;
  if ((ending == ".xml" || ending == ".world") && BeginsWithRoot(file)) return FileKind::kObject;
  if (ending == ".glb" || ending == ".gltf" || foreign::FileCheck::IsMesh(ending))
    return FileKind::kMesh;
  return FileKind::kOther;
}

}  // namespace

std::vector<std::filesystem::path> FindForeignFiles(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<fs::path> objects;
  std::vector<fs::path> meshes;
  auto entry = fs::recursive_directory_iterator(path, error);
  for (; !error && entry != fs::end(entry); entry.increment(error)) {
    const fs::path& at = entry->path();
    std::error_code gone;
    if (entry->is_directory(gone)) {
      const bool record = fs::exists(at / "door.json", gone) || fs::exists(at / "part.json", gone);
      if (record || at.filename().string().starts_with('.')) entry.disable_recursion_pending();
    } else if (entry->is_regular_file(gone)) {
      const FileKind kind = KindOf(at);
      if (kind == FileKind::kObject) objects.push_back(at);
      if (kind == FileKind::kMesh) meshes.push_back(at);
    }
  }
  if (error)
    throw Error(ErrorCode::kIo, path.string() + ": cannot be searched: " + error.message());
  std::vector<fs::path> found = objects.empty() ? std::move(meshes) : std::move(objects);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace doorforge
