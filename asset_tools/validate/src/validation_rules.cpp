// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/error.h"
#include "doorforge/validate/validate_door.h"

#include "findings.h"

namespace doorforge {
namespace {

constexpr Severity kError = Severity::kError;
constexpr Severity kWarning = Severity::kWarning;
constexpr Severity kInfo = Severity::kInfo;

constexpr ValidationRule kRules[] = {
    {"REC001", kError, "The record can be read and follows its schema", 0,
     "a record of this version", "write it again with `doorforge compose` or `doorforge import`"},
    {"REC002", kError, "Links and their geometry have different names", 0, "each name once",
     "rename one of them"},
    {"REC003", kError, "The record can be checked with reasonable time and memory", 0,
     "pieces of at most 100 m and 300 s of processor time",
     "make the part or door again with simpler meshes, or allow more with --max-seconds"},
    {"REC004", kError, "Ids and names can name a file", 120,
     "1 to {} letters, digits, '.', '_' and '-', the first a letter, a digit or '_'",
     "give it such a name; do not use a record whose author tried another"},

    {"MSH001", kError, "Mesh files exist", 0, "a file", "compose the door again"},
    {"MSH002", kError, "Mesh files are canonical", 0,
     "only v and f lines with numbers within 100 m",
     "run `doorforge repair` on the mesh and compose again"},
    {"MSH003", kError, "Mesh paths stay inside the folder", 0, "a relative path without ..",
     "move the mesh into the folder"},
    {"MSH004", kError, "Mesh files are those that the record was written with", 0,
     "the recorded SHA-256", "compose the door again from the changed part"},
    {"MSH005", kError, "Visual meshes are closed and oriented", 0,
     "0 edges that do not join exactly two triangles in opposite directions",
     "run `doorforge repair` on the mesh"},
    {"MSH006", kError, "Visual meshes enclose a volume", 0, "a volume above 0",
     "turn the triangles inside out", true},
    {"MSH007", kWarning, "Triangles have an area", 0, "0 degenerate triangles",
     "run `doorforge repair` on the mesh", true},

    {"COL001", kError, "Every visual piece has collision shapes", 1, "at least {}",
     "import or build the part again"},
    {"COL002", kError, "Collision shapes are closed and convex", 5e-4,
     "no vertex more than {} m outside a face", "import or build the part again", true},
    {"COL003", kError, "Collision shapes cover a handle's visual mesh", 0.003,
     "at most {} m of it outside", "import the handle with finer convex parts"},
    {"COL004", kError, "Collision shapes cover a leaf's or frame's visual mesh", 0.01,
     "at most {} m of it outside", "import the body with finer convex parts"},
    {"COL005", kWarning, "A piece has few collision shapes", 32, "at most {}",
     "import the part with coarser convex parts"},
    {"COL006", kWarning, "Collision shapes have few vertices", 64, "at most {} each",
     "import the part with coarser convex parts"},

    {"INR001", kError, "Mass is positive", 0, "above 0 kg", "give the piece a density", true},
    {"INR002", kError, "Inertia is positive definite", 0, "all principal moments above 0 kg m2",
     "compute it from the mesh", true},
    {"INR003", kError, "Inertia satisfies the triangle inequality", 1e-6,
     "no principal moment above the sum of the two others (relative tolerance {})",
     "compute it from the mesh", true},
    {"INR004", kError, "The centre of mass lies within the link's bounds", 0.01,
     "at most {} m outside", "compute it from the mesh", true},
    {"INR005", kWarning, "The link's density is plausible", 20, "{} to 20000 kg/m3",
     "check the density and the scale of the meshes"},

    {"MEC001", kError, "Joint axes have unit length", 1e-6, "1 within {}", "normalise the axis",
     true},
    {"MEC002", kError, "Joint limits are ordered, finite and include 0", 6.2832,
     "lower <= 0 <= upper, within {} rad", "set the limits from the hardware"},
    {"MEC003", kError, "The hinge opens wide enough to count as open", 0.7853981634,
     "upper limit at least {} rad", "raise the hinge's upper limit"},
    {"MEC004", kError, "Positive hinge angles move the leaf towards who pulls", 0.2,
     "direction of the leaf's centre at least {} along x",
     "turn the axis round or make it vertical"},
    {"MEC005", kError, "Joints have effort and velocity limits", 0, "above 0", "set both limits",
     true},
    {"MEC006", kError, "The latch releases within the handle's range", 0,
     "0 < unlock angle <= done angle <= upper limit of the handle", "lower the unlock angle"},
    {"MEC007", kError, "A latch has a handle that turns", 0, "upper limit above 0 rad",
     "use latch type none or let the handle turn"},
    {"MEC008", kError, "Latch, spring and damping numbers are not negative", 0,
     "0 or more; a latch's lock effort above 0", "correct the number"},
    {"MEC009", kWarning, "The hinge line lies at the leaf", 0.1, "at most {} m from its bounds",
     "check the hinge's origin and the scale of the meshes"},

    {"URD001", kError, "model.urdf can be read", 0, "a URDF file", "compose the door again", true},
    {"URD002", kError, "The URDF has the links of door.json", 0, "each link once",
     "compose the door again", true},
    {"URD003", kError, "The URDF's links form one tree", 0, "one root, one parent each",
     "compose the door again", true},
    {"URD004", kError, "The URDF's joints join what door.json's do", 0,
     "the same type, parent, child", "compose the door again", true},
    {"URD005", kError, "The URDF's joints agree with door.json in origin, axis and limits", 1e-6,
     "differences up to {}", "compose the door again", true},
    {"URD006", kError, "The URDF's axes have unit length", 1e-6, "1 within {}",
     "normalise the axis", true},
    {"URD007", kError, "The URDF's limits are ordered, with effort and velocity", 0,
     "lower <= upper, effort and velocity above 0", "write all four attributes of <limit>", true},
    {"URD008", kError, "The URDF's inertials agree with door.json", 1e-6,
     "relative differences up to {}", "compose the door again", true},
    {"URD009", kError, "The URDF's mesh paths stay inside the folder", 0,
     "a relative path without .. to a file", "move the mesh into the folder", true},
    {"URD010", kError, "Scale is baked into the meshes", 0, "no scale attribute other than 1 1 1",
     "scale the mesh itself", true},
    {"URD011", kError, "The URDF names the meshes of door.json", 0,
     "the same files on the same links", "compose the door again", true},

    {"HND001", kError, "The handle is not buried in the leaf", 0.3,
     "at most {} of its surface inside", "raise the handle's seat, or check its mount"},
    {"HND002", kError, "The handle stands out from the leaf", 0.005, "at least {} m",
     "raise the handle's seat, or check its mount"},
    {"HND003", kError, "The handle lies within the leaf's outline", 0.01, "at most {} m beyond",
     "move the mount away from the edge (backset), or take a shorter handle"},
    {"HND004", kError, "The grasp frame lies on the handle", 0, "material between the fingers",
     "set the grasp frame on the grip"},
    {"HND005", kError, "The grasp approaches the leaf", 0.5, "approach along -x by at least {}",
     "turn the grasp frame: z is the approach, y the fingers' way"},
    {"HND006", kWarning, "There is room for the finger tips behind the grip", 0.002,
     "at least {} m between tips and leaf", "use a handle that stands out more"},
    {"HND007", kWarning, "The grip fits between the fingers", 0.076, "at most {} m",
     "use a narrower handle or another grasp"},
    {"HND008", kWarning, "A parallel gripper reaches the grasp and holds it", 0,
     "a free way for open fingers and enough contact on both pads", "use another grasp"},
    {"HND009", kWarning, "A handle stands out no further than handles do", 0.12,
     "at most {} m from the leaf's surface",
     "check its axes and unit: --handle-front, --handle-up and --handle-unit of compose"},
    {"HND010", kError, "The handle does not float in front of the leaf", 0.015,
     "rose, neck or grip at most {} m from the leaf's surface",
     "lower the handle's seat, or check its mount and axes: --handle-mount, --handle-front and "
     "--handle-up of compose"},
    {"HND011", kWarning, "A lever runs along the leaf", 0.349,
     "its long axis at most {} rad out of the leaf's plane",
     "check its axes: --handle-front and --handle-up of compose"},

    {"SWP001", kError, "The opening leaf meets nothing of its frame", 0.003,
     "collision shapes at most {} m deeper in each other than on the closed door",
     "set the hinge's origin and upper limit, or cut the frame back"},
    {"SWP002", kWarning, "The closed leaf does not overlap its frame", 0.01,
     "collision shapes at most {} m in each other", "leave a gap between leaf and frame"},
    {"SWP003", kWarning, "The leaf as drawn turns clear of its frame at the hinge", 0.003,
     "meshes at most {} m in each other within 0.1 m of the hinge",
     "move the hinge's axis to the leaf's front edge, or cut leaf or frame back"},

    {"OPN001", kError, "The locked door holds", 0.01,
     "below {} rad under 1.5 times the nominal pull of 50 N at the grasp",
     "raise the latch's lock effort"},
    {"OPN002", kError, "The handle unlocks the door", 6,
     "handle done and latch released by at most {} N m",
     "lower the unlock and done angles or the handle's spring"},
    {"OPN003", kError, "The handle springs back", 0.05, "at most {} rad 1 s after it was let go",
     "give the handle a spring, or less damping"},
    {"OPN004", kError, "The unlocked door opens", 0.7853981634,
     "beyond {} rad within 10 s of a pull that grows to 50 N",
     "lower the leaf's mass, the closer's spring or the damping"},
    {"OPN005", kError, "The gripper fits the handle", 5, "cost of the best grasp at most {}",
     "set the grasp frame on the grip, or use another handle"},
    {"OPN006", kError, "The simulation stays finite", 0, "finite angles, below 90 rad/s",
     "check masses, inertias and dampings"},
    {"OPN007", kInfo, "The door has been simulated", 0,
     "no error of the other families, and a door that can be simulated",
     "mend the errors, or what the message names"},

    {"LIC001", kError, "A licence is stated", 0, "an SPDX expression", "state the licence"},
    {"LIC002", kWarning, "The licence is known", 0, "an SPDX expression without NOASSERTION",
     "state that of your own file (--license of import, --handle-license of compose), or ask the "
     "author of the source"},
};

}  // namespace

std::string_view NameOf(Severity severity) {
  if (severity == Severity::kError) return "error";
  return severity == Severity::kWarning ? "warning" : "info";
}

std::span<const ValidationRule> ValidationRules() { return kRules; }

Finding FindingOf(std::string_view code, const std::string& where, const std::string& measured) {
  return internal::Found(code, where, measured);
}

std::string AllowedText(const ValidationRule& rule) { return internal::AllowedBy(rule); }

double RuleLimit(std::string_view code) { return internal::LimitOf(code); }

namespace internal {

const ValidationRule& RuleOf(std::string_view code) {
  for (const ValidationRule& rule : kRules) {
    if (rule.code == code) return rule;
  }
  throw Error(ErrorCode::kInvalidArgument, "no rule " + std::string(code));
}

double LimitOf(std::string_view code) { return RuleOf(code).limit; }

std::string Number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string AllowedBy(const ValidationRule& rule) {
  std::string text(rule.allowed);
  const std::size_t at = text.find("{}");
  return at == std::string::npos ? text : text.replace(at, 2, Number(rule.limit));
}

Finding Found(std::string_view code, const std::string& where, const std::string& measured) {
  const ValidationRule& rule = RuleOf(code);
  return {std::string(code), rule.severity,         where,       measured,
          AllowedBy(rule),   std::string(rule.fix), rule.fixable};
}

}  // namespace internal
}  // namespace doorforge
