// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/foreign/foreign_rules.h"

#include <map>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge {
namespace {

constexpr Severity kBad = Severity::kError;
constexpr Severity kDoubtful = Severity::kWarning;

constexpr ValidationRule kForeignRules[] = {
    {"FIL001", kBad, "The file can be read", 0, "a regular file that may be opened",
     "check the path and the permissions"},
    {"FIL002", kBad, "The text is well-formed", 0, "XML 1.0 in UTF-8, JSON, or the syntax of USDA",
     "correct the text at this place"},
    {"FIL003", kBad, "The file keeps within the limits", 0,
     "16 MiB of text, 64 levels, 200000 elements, 2000 links or joints",
     "leave out what the object does not need, or give its parts as files of their own"},
    {"FIL004", kBad, "No entity or document type is declared", 0, "no <! but comments and CDATA",
     "remove the declaration"},
    {"FIL005", kBad, "The content is what the file's name says", 0,
     "the root element or header of the format", "rename the file or write its format"},
    {"FIL006", kBad, "Numbers are finite and as many as the format says", 0, "finite numbers",
     "write numbers"},
    {"FIL007", kBad, "Required elements and attributes are there", 0,
     "those that the format requires", "add it"},
    {"FIL008", kBad, "Words are those of the format", 0, "a word that the format knows",
     "use one of those named"},
    {"FIL009", kDoubtful, "No name looks like a misspelt one", 0, "names that the format knows",
     "correct the spelling; readers pass over names that they do not know"},
    {"FIL010", kBad, "xacro is expanded", 0, "no ${...}, $(...) or xacro elements",
     "expand it first: xacro FILE.xacro > FILE.urdf"},
    {"FIL011", kBad, "The format is one that is read here", 0,
     "URDF, MJCF, SDF, USDA, GLB, glTF, OBJ, STL, PLY, OFF, DAE, FBX, 3DS",
     "convert it: `usdcat -o FILE.usda FILE` for binary USD"},
    {"FIL012", kBad, "The check ends in reasonable time and memory", 0, "the time of --max-seconds",
     "make the meshes simpler, or allow more with --max-seconds"},

    {"GLB001", kBad, "The container's lengths and chunks hold", 0,
     "magic, version 2, lengths that end with the file, a JSON chunk first",
     "export the file again"},
    {"GLB002", kBad, "Indices of the document name what is there", 0, "0 to the count less 1",
     "correct the index"},
    {"GLB003", kBad, "Accessors and views lie within their buffers", 0,
     "offset and length within the buffer, offsets as the component's size asks",
     "export the file again"},
    {"GLB004", kBad, "Positions are finite and within their stated bounds", 0,
     "finite numbers between min and max", "export the file again"},
    {"GLB005", kBad, "Triangle indices name vertices", 0, "below the count of positions",
     "export the file again"},
    {"GLB006", kBad, "Nodes form trees", 0, "one parent each, no loop", "correct the children"},
    {"GLB007", kBad, "Node transforms are finite and keep volume", 0,
     "finite numbers, unit quaternions, no scale of 0", "apply the transform and export again"},

    {"USD001", kBad, "Targets of relationships and references are there", 0, "a prim of this file",
     "correct the path"},
    {"USD002", kDoubtful, "The stage states its unit and its up axis", 0,
     "metersPerUnit and upAxis in the header", "state both; readers assume centimetres and Y"},
    {"USD003", kBad, "Mesh arrays agree", 0,
     "face counts of 3 and more, as many indices as their sum, each below the count of points",
     "export the mesh again"},

    {"TRE001", kBad, "Links and joints have names", 0, "a name that is not empty", "name it"},
    {"TRE002", kBad, "Each link's name occurs once", 0, "each name once", "rename one of them"},
    {"TRE003", kBad, "Each joint's name occurs once", 0, "each name once", "rename one of them"},
    {"TRE004", kBad, "Joints join links that are there", 0, "names of links",
     "correct the name, or add the link"},
    {"TRE005", kBad, "No link has two parents", 0, "one joint to each child",
     "take away one of the joints"},
    {"TRE006", kBad, "Joints form no loop", 0, "a way from every link up to a root",
     "take away one joint of the loop"},
    {"TRE007", kBad, "The links hang together", 0, "one link that is no joint's child",
     "join the others to it, with fixed joints where nothing moves"},
    {"TRE008", kBad, "A joint joins two different links", 0, "two names",
     "correct the parent or the child"},
    {"TRE009", kBad, "A mimic follows another joint that is there", 0,
     "the name of another joint, without a loop", "correct the name"},
    {"TRE010", kBad, "There is a link", 1, "at least {}", "add links"},
    {"TRE011", kBad, "References name something that is there", 0, "a name in the file",
     "correct the name, or add what it names"},
    {"TRE012", kBad, "Each name of a material, mesh or other asset occurs once", 0,
     "each name once", "rename one of them"},
    {"TRE013", kDoubtful, "Materials that a URDF names are defined in it", 0,
     "a material of the robot or of a visual", "define it; readers draw what they like without"},

    {"JNT001", kBad, "An axis has a direction", 1e-9, "a length above {}", "write an axis"},
    {"JNT002", kDoubtful, "Axes have unit length", 1e-3, "1 within {}", "normalise the axis"},
    {"JNT003", kBad, "Revolute and prismatic joints have limits", 0,
     "limit with lower, upper, effort and velocity",
     "add <limit lower= upper= effort= velocity=>, or make the joint continuous"},
    {"JNT004", kBad, "Limits are ordered", 0, "lower at most upper", "exchange them"},
    {"JNT005", kDoubtful, "Moving joints can move", 0, "lower below upper",
     "make the joint fixed, or widen its limits"},
    {"JNT006", kBad, "Limits state effort and velocity", 0, "both attributes",
     "state them; urdfdom refuses the joint without"},
    {"JNT007", kBad, "Effort and velocity limits are not negative", 0, "0 and more",
     "turn the sign round"},
    {"JNT008", kDoubtful, "Effort and velocity limits let the joint be driven", 0, "above 0",
     "state what the drive can do"},
    {"JNT009", kDoubtful, "Angles are in radians", 12.6, "limits within {} rad",
     "convert degrees to radians, or make the joint continuous"},
    {"JNT010", kDoubtful, "Ways are in metres", 10, "limits within {} m",
     "convert millimetres to metres"},
    {"JNT011", kBad, "Damping and friction are not negative", 0, "0 and more",
     "turn the sign round"},
    {"JNT012", kDoubtful, "Joints lie near what they join", 100, "at most {} m from the parent",
     "convert millimetres to metres"},
    {"JNT013", kDoubtful, "A mimic moves its joint", 0, "a multiplier other than 0",
     "make the joint fixed, or state the multiplier"},

    {"INR006", kDoubtful, "What moves has a mass", 0, "a mass for each moving body",
     "add <inertial>; each simulator assumes another mass where there is none"},
    {"INR007", kDoubtful, "The mass is plausible for the size", 0.05,
     "{} to 20000 kg/m3 of the bounding box",
     "check the mass, the scale of the meshes and their units"},
    {"INR008", kDoubtful, "The centre of mass lies at the link's shapes", 0.1,
     "at most {} m outside", "compute it from the meshes, in metres and in the link's frame"},
    {"INR009", kDoubtful, "The inertia is plausible for mass and size", 2,
     "a radius of gyration of 0.001 to {} times the diagonal of the shapes",
     "compute it from the meshes, in kg m2"},

    {"GEO001", kBad, "Files that are named exist", 0, "a file",
     "add the file, or correct its name"},
    {"GEO002", kBad, "Paths stay inside the root", 0,
     "a relative path, or package://, that does not leave the folder",
     "move the file into the folder; --root says where that begins"},
    {"GEO003", kDoubtful, "package:// and model:// can be followed", 0,
     "a folder of that name above the file or beside one above it",
     "give --package NAME=FOLDER, or write a path that is relative to the file"},
    {"GEO004", kBad, "Mesh files are of a format that is read", 0,
     ".obj .stl .ply .off .dae .gltf .glb .fbx .3ds", "convert the mesh"},
    {"GEO005", kBad, "Mesh files can be read", 0, "content that follows its format",
     "export the mesh again"},
    {"GEO006", kBad, "Scales are not 0", 0, "three numbers other than 0", "correct the scale"},
    {"GEO007", kDoubtful, "Scales do not mirror", 0, "numbers above 0",
     "mirror the mesh itself: readers differ about which side is outside"},
    {"GEO008", kDoubtful, "Sizes are in metres", 100, "a diagonal of 0.001 to {} m",
     "state the scale: 0.001 0.001 0.001 for millimetres"},
    {"GEO009", kDoubtful, "Meshes that collide are closed", 0,
     "0 edges that do not join exactly two triangles", "close it with `doorforge repair`"},
    {"GEO010", kDoubtful, "Triangles agree about what is outside", 0,
     "0 edges that both their triangles run through the same way",
     "turn them with `doorforge repair`"},
    {"GEO011", kDoubtful, "Triangles have an area", 0, "0 degenerate triangles",
     "drop them with `doorforge repair`"},
    {"GEO012", kDoubtful, "No triangle is there twice", 0, "0 repeated triangles",
     "drop them with `doorforge repair`"},
    {"GEO013", kDoubtful, "Closed meshes are not inside out", 0, "a volume above 0",
     "turn the triangles round"},
    {"GEO014", kDoubtful, "Shapes lie near their object", 1,
     "at most {} times its size away from the others", "correct the origin, in metres"},
    {"GEO015", kBad, "Shapes have a size", 0, "numbers above 0", "correct the size"},
    {"GEO016", kDoubtful, "Materials and textures are there", 0, "a file inside the root",
     "add it, or take away its name"},
    {"GEO017", kDoubtful, "No edge joins more than two triangles", 0, "0 such edges",
     "cut it with `doorforge repair`"},

    {"EXT001", kBad, "urdfdom, which ROS uses, takes the file", 0, "a model", "see its words"},
    {"EXT002", kBad, "MuJoCo takes the file", 0, "a model", "see its words"},
    {"EXT003", kBad, "assimp, or the importer of OBJ, STL and PLY, takes the file", 0,
     "a scene with triangles", "see its words"},
    {"EXT004", kBad, "sdformat, which Gazebo uses, takes the file", 0, "a model", "see its words"},

    {"PRF001", kBad, "The format is one that the target reads", 0,
     "MJCF or URDF for mujoco, USD for isaac, SDF for gazebo, URDF for sapien",
     "export or convert the object to it"},
    {"PRF002", kBad, "What moves states mass and inertia", 0, "both for each moving body",
     "state both; targets compute, assume or refuse what is missing, each in its way"},
    {"PRF003", kDoubtful, "What moves can be touched", 0, "a collision shape for each moving body",
     "add one; nothing can hold or hit the body without"},
    {"PRF004", kBad, "Mesh files are of a format that the target reads", 0,
     "OBJ or STL for mujoco; DAE, OBJ, STL or glTF for gazebo; these or PLY for sapien",
     "convert the mesh"},
    {"PRF005", kBad, "The stage is in metres and z is up", 0, "metersPerUnit 1 and upAxis Z",
     "convert the stage; what is composed with it would be of another size"},
    {"PRF006", kBad, "The stage has a default prim", 0, "defaultPrim in the header",
     "name it; a reference to the file brings nothing without"},
    {"PRF007", kBad, "The joints form one articulation", 1,
     "{} prim with PhysicsArticulationRootAPI", "apply it to the prim above all bodies"},
    {"PRF008", kDoubtful, "Bodies have semantic labels", 0, "semantics:labels on each body",
     "label them; cameras tell them apart by it"},
    {"PRF009", kBad, "What moves collides as convex shapes", 0,
     "physics:approximation convexHull, convexDecomposition or another but none",
     "state an approximation; PhysX moves no body that collides as triangles"},
    {"PRF010", kDoubtful, "Meshes state their extent", 0, "extent on each Mesh",
     "state it; readers compute it anew each time without"},
    {"PRF011", kDoubtful, "The target's catalogue has a picture", 0,
     ".thumbs/256x256/FILE.png for isaac, thumbnails/1.png for gazebo",
     "add it: `doorforge export --profile`"},
    {"PRF012", kBad, "The model's folder says what it holds", 0, "model.config that names the file",
     "add it; Gazebo finds models by it"},
    {"PRF013", kDoubtful, "Collision meshes are nearly convex", 0.3,
     "at most {} of the convex hull filled",
     "cut the mesh into convex parts: mujoco and sapien let it collide as its hull"},
};

}  // namespace

std::span<const ValidationRule> ForeignRules() { return kForeignRules; }

const std::vector<ValidationRule>& AllRules() {
  static const std::vector<ValidationRule> all = [] {
    std::vector<ValidationRule> rules(std::begin(kForeignRules), std::end(kForeignRules));
    rules.insert(rules.end(), ValidationRules().begin(), ValidationRules().end());
    return rules;
  }();
  return all;
}

const ValidationRule& AnyRule(std::string_view code) {
  static const auto by_code = [] {
    std::map<std::string_view, const ValidationRule*> rules;
    for (const ValidationRule& rule : AllRules()) rules.emplace(rule.code, &rule);
    return rules;
  }();
  const auto found = by_code.find(code);
  if (found != by_code.end()) return *found->second;
  std::vector<std::string> codes;
  for (const ValidationRule& rule : AllRules()) codes.emplace_back(rule.code);
  throw Error(ErrorCode::kInvalidArgument, "no rule \"" + std::string(code) + "\"; did you mean " +
                                               NearestName(code, codes) +
                                               "? `doorforge validate --rules` lists all");
}

std::string RuleHelpUri(std::string_view code) {
  constexpr std::pair<std::string_view, std::string_view> kAnchors[] = {
      {"FIL", "fil-the-file"},
      {"GLB", "glb-gltf-and-glb"},
      {"USD", "usd-usda"},
      {"TRE", "tre-links-and-joints"},
      {"JNT", "jnt-joints"},
      {"GEO", "geo-shapes-and-meshes"},
      {"EXT", "ext-other-programs"},
      {"PRF", "prf-targets"},
      {"REC", "rec-records"},
      {"MSH", "msh-meshes"},
      {"COL", "col-collision-shapes"},
      {"INR", "inr-mass-and-inertia"},
      {"MEC", "mec-joints-and-latch"},
      {"URD", "urd-urdf"},
      {"HND", "hnd-handle-and-grasp"},
      {"SWP", "swp-the-moving-leaf"},
      {"OPN", "opn-the-simulated-opening"},
      {"LIC", "lic-licences"}};
  for (const auto& [family, anchor] : kAnchors) {
    if (code.starts_with(family)) return "docs/validation-rules.md#" + std::string(anchor);
  }
  return "docs/validation-rules.md";
}

}  // namespace doorforge
