// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Doors and the parts that they are composed of.

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <stdlib.h>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/compose/compose.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/importers/author_place.h"
#include "doorforge/openable/openable_check.h"
#include "doorforge/preview/draw_records.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/split.h"
#include "doorforge/validate/validate_folders.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

namespace fs = std::filesystem;

Existing ExistingOf(bool overwrite) { return overwrite ? Existing::kReplace : Existing::kRefuse; }

Door Held(DoorAsset asset) { return {std::make_shared<const DoorAsset>(std::move(asset))}; }

const DoorGeometry& GeometryOf(const Door& door, const std::string& name) {
  std::string there;
  for (const DoorLink& link : door.asset->links) {
    for (const DoorGeometry& geometry : link.geometry) {
      if (geometry.name == name) return geometry;
      there += (there.empty() ? "" : ", ") + geometry.name;
    }
  }
  throw Error(ErrorCode::kInvalidArgument,
              door.asset->id + ": there is no mesh \"" + name + "\"; there are " + there);
}

const DoorLink& LinkOf(const Door& door, const std::string& name) {
  for (const DoorLink& link : door.asset->links) {
    if (link.name == name) return link;
  }
  throw Error(ErrorCode::kInvalidArgument,
              door.asset->id + ": there is no link \"" + name + "\"; there are base, leaf, handle");
}

// --- composing

struct LoadedPart {
  Part part;
  fs::path folder;  // empty: of the catalogue
};

LoadedPart LoadPart(const std::string& name) {
  if (fs::exists(fs::path(name) / "part.json")) return {ReadPart(name), name};
  if (name.find('/') != std::string::npos || fs::exists(name))
    throw Error(ErrorCode::kMissing, name +
                                         ": no part.json there; `doorforge import` and "
                                         "`doorforge catalog build` write parts");
  return {BuildCataloguePart(DataFolder(), name), {}};
}

// Where the author of an object that gave both parts had the handle.
std::optional<RigidTransform> AuthoredPlace(const LoadedPart& body, const Part& handle) {
  if (body.folder.empty()) return std::nullopt;
  const AuthorPlaces places = ReadAuthorPlaces(body.folder);
  const auto found = places.find(handle.source_sha256);
  return found == places.end() ? std::nullopt : std::optional(found->second);
}

/// A folder that is gone at the end.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "doorforge-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(ErrorCode::kIo, name + ": a folder for files in between cannot be made there");
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// A file holds positions as float and turns as quaternions. An episode has the same bits with a
// door that was never saved as with one that was.
DoorAsset AsFiled(const DoorAsset& door) {
  const Scratch scratch;
  WriteDoor(door, scratch.path());
  return ReadDoor(scratch.path());
}

Door Compose(const std::string& body, const std::string& handle, const py::object& settings) {
  const auto config = ConfigFrom<ComposeConfig>(settings, "compose");
  return Long([&] {
    const LoadedPart whole = LoadPart(body);
    const Part grip = LoadPart(handle).part;
    return Held(AsFiled(ComposeDoor(whole.part, grip, config, AuthoredPlace(whole, grip))));
  });
}

py::list Catalogue() {
  py::list rows;
  for (const CatalogueEntry& entry : ListCatalogue(DataFolder())) {
    py::dict row;
    row["id"] = entry.id;
    row["role"] = std::string(NameOf(entry.role));
    row["category"] = std::string(NameOf(entry.category));
    row["mechanism"] = std::string(NameOf(entry.mechanism));
    row["family"] = entry.family;
    rows.append(row);
  }
  return rows;
}

// --- changing

void SetNumbers(const py::dict& changes, const std::string& what,
                const std::vector<std::pair<const char*, double*>>& fields) {
  for (const auto& [key, value] : changes) {
    const auto name = key.cast<std::string>();
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const auto& row) { return name == row.first; });
    if (field == fields.end()) {
      std::string there;
      for (const auto& row : fields) there += (there.empty() ? "" : ", ") + std::string(row.first);
      throw Error(ErrorCode::kInvalidConfig,
                  what + ": unknown key \"" + name + "\"; there are " + there);
    }
    const auto number = FromPython(py::reinterpret_borrow<py::object>(value), what + "." + name);
    if (!number.is_number())
      throw Error(ErrorCode::kInvalidConfig, what + "." + name + ": expected a number");
    *field->second = number.get<double>();
  }
}

void SetJoint(const py::dict& changes, const std::string& what, DoorJoint& joint) {
  SetNumbers(changes, what,
             {{"lower_rad", &joint.lower_rad},
              {"upper_rad", &joint.upper_rad},
              {"effort_limit_nm", &joint.effort_limit_nm},
              {"velocity_limit_rad_s", &joint.velocity_limit_rad_s},
              {"damping_nm_s", &joint.damping_nm_s}});
}

void SetLatch(py::dict changes, Latch& latch) {
  const auto taken = [&changes](const char* key) {
    std::optional<py::object> value;
    if (changes.contains(key)) value = changes[key];
    return value;
  };
  const auto type = taken("type");
  const auto relatch = taken("relatch");
  const auto ajar = taken("unlocks_ajar");
  py::dict numbers;
  for (const auto& [key, value] : changes) {
    const auto name = key.cast<std::string>();
    if (name != "type" && name != "relatch" && name != "unlocks_ajar") numbers[key] = value;
  }
  if (type) {
    const auto name = py::str(*type).cast<std::string>();
    const auto known = LatchTypeNamed(name);
    if (!known)
      throw Error(ErrorCode::kInvalidConfig,
                  "latch.type: \"" + name + "\", expected none, effort or bolt");
    latch.type = *known;
  }
  if (relatch) latch.relatch = relatch->cast<bool>();
  if (ajar) latch.unlocks_ajar = ajar->cast<bool>();
  SetNumbers(numbers, "latch",
             {{"unlock_angle_rad", &latch.unlock_angle_rad},
              {"handle_done_angle_rad", &latch.handle_done_angle_rad},
              {"lock_effort_nm", &latch.lock_effort_nm},
              {"hinge_spring_nm_per_rad", &latch.hinge_spring_nm_per_rad},
              {"handle_spring_nm_per_rad", &latch.handle_spring_nm_per_rad},
              {"bolt_throw_m", &latch.bolt_throw_m}});
}

Door Change(const Door& door, const std::optional<std::string>& id, const py::dict& latch,
            const py::dict& hinge, const py::dict& handle_joint) {
  DoorAsset changed = *door.asset;
  if (id) changed.id = *id;
  SetLatch(latch, changed.latch);
  SetJoint(hinge, "hinge", changed.hinge);
  SetJoint(handle_joint, "handle_joint", changed.handle_joint);
  return Held(std::move(changed));
}

// --- out of memory

void Export(const Door& door, const fs::path& folder, const std::vector<std::string>& names,
            bool overwrite) {
  std::vector<DoorFormat> formats;
  for (const std::string& name : names) {
    const auto format = DoorFormatNamed(name);
    if (!format)
      throw Error(ErrorCode::kInvalidArgument, "export: there is no format \"" + name +
                                                   "\"; there are urdf, mjcf, sdf, glb, usda");
    formats.push_back(*format);
  }
  Require(!formats.empty(), ErrorCode::kInvalidArgument,
          "export: no format is given; there are urdf, mjcf, sdf, glb, usda");
  const py::gil_scoped_release others;
  WriteExportedDoor(*door.asset, formats, folder, ExistingOf(overwrite));
}

std::unique_ptr<DoorValidator> ValidatorOf(const std::string& profile) {
  if (profile == "urdf") return std::make_unique<DoorValidator>(ValidationProfile::kUrdf);
  if (profile == "physics") return std::make_unique<DoorValidator>(ValidationProfile::kPhysics);
  if (profile == "openable") return std::make_unique<DoorValidator>(OpenableCheck());
  throw Error(ErrorCode::kInvalidArgument, "validate: there is no profile \"" + profile +
                                               "\"; there are urdf, physics, openable");
}

py::object Validate(const std::vector<std::string>& paths, const std::string& profile,
                    int threads) {
  const auto json = Long([&] {
    const RecordsFound found = FindAllRecords(paths);
    if (!found.problems.empty()) throw Error(ErrorCode::kMissing, found.problems.front());
    const auto checked =
        ValidateFolders(*ValidatorOf(profile), found.folders, {.fix = {}, .threads = threads});
    for (const CheckedFolder& folder : checked) {
      if (!folder.problem.empty()) throw Error(ErrorCode::kIo, folder.problem);
    }
    return CheckedToJson(checked, found.missing, false);
  });
  return ToPython(json);
}

py::array_t<std::uint8_t> Preview(const std::vector<fs::path>& folders, const py::dict& settings) {
  PreviewConfig config;
  const auto number = [&settings](const char* key, auto& value) {
    if (settings.contains(key))
      value = settings[key].template cast<std::remove_reference_t<decltype(value)>>();
  };
  number("hinge_deg", config.hinge_deg);
  number("handle_deg", config.handle_deg);
  number("azimuth_deg", config.azimuth_deg);
  number("width", config.width);
  if (settings.contains("focus")) {
    config.focus = ValueNamed<PreviewFocus>(settings["focus"].cast<std::string>());
    Require(config.focus.has_value(), ErrorCode::kInvalidArgument,
            "focus: allowed all, whole, handle");
  }
  number("collision", config.collision);
  const Picture picture = Long([&] { return DrawRecords(folders, config); });
  return ArrayOf(picture.rgb.data(), {picture.height, picture.width, 3});
}

py::dict MassOf(const MassProperties& mass) {
  py::dict dict;
  dict["mass_kg"] = mass.mass_kg;
  dict["center_of_mass_m"] = ToPython(mass.center_of_mass_m);
  dict["inertia_kg_m2"] = ToPython(mass.inertia_kg_m2);
  return dict;
}

py::list FindDoors(const std::vector<std::string>& words, const std::string& default_side,
                   int per_category) {
  DoorSelection selection = DoorSelectionOf(words, default_side);
  selection.per_category = per_category;
  const DoorSet set = Long([&] { return FindDoorSet(selection, 0); });
  py::list folders;
  for (const FoundDoor& door : set.doors) folders.append(py::str(door.folder.string()));
  return folders;
}

void BindRecords(py::module_& module) {
  py::class_<DoorJoint>(module, "Joint")
      .def_readonly("name", &DoorJoint::name)
      .def_readonly("lower_rad", &DoorJoint::lower_rad)
      .def_readonly("upper_rad", &DoorJoint::upper_rad)
      .def_readonly("effort_limit_nm", &DoorJoint::effort_limit_nm)
      .def_readonly("velocity_limit_rad_s", &DoorJoint::velocity_limit_rad_s)
      .def_readonly("damping_nm_s", &DoorJoint::damping_nm_s)
      .def_property_readonly("axis", [](const DoorJoint& joint) { return ToPython(joint.axis); })
      .def_property_readonly("parent_from_child_at_zero", [](const DoorJoint& joint) {
        return ToPython(joint.parent_from_child_at_zero);
      });
  py::class_<Latch>(module, "Latch")
      .def_property_readonly("type",
                             [](const Latch& latch) { return std::string(NameOf(latch.type)); })
      .def_readonly("unlock_angle_rad", &Latch::unlock_angle_rad)
      .def_readonly("handle_done_angle_rad", &Latch::handle_done_angle_rad)
      .def_readonly("lock_effort_nm", &Latch::lock_effort_nm)
      .def_readonly("hinge_spring_nm_per_rad", &Latch::hinge_spring_nm_per_rad)
      .def_readonly("handle_spring_nm_per_rad", &Latch::handle_spring_nm_per_rad)
      .def_readonly("relatch", &Latch::relatch)
      .def_readonly("unlocks_ajar", &Latch::unlocks_ajar)
      .def_readonly("bolt_throw_m", &Latch::bolt_throw_m);
}

void BindDoor(py::module_& module) {
  const auto text = [](auto of) {
    return [of](const Door& door) { return std::string(of(door)); };
  };
  py::class_<Door>(module, "Door")
      .def_property_readonly("id", [](const Door& door) { return door.asset->id; })
      .def_property_readonly("category",
                             text([](const Door& door) { return NameOf(door.asset->category); }))
      .def_property_readonly("mechanism",
                             text([](const Door& door) { return NameOf(door.asset->mechanism); }))
      .def_property_readonly("hinge_side",
                             text([](const Door& door) { return NameOf(door.asset->hinge_side); }))
      .def_property_readonly("opening",
                             text([](const Door& door) { return NameOf(door.asset->opening); }))
      .def_property_readonly("license", [](const Door& door) { return door.asset->license; })
      .def_property_readonly("body", [](const Door& door) { return door.asset->body.id; })
      .def_property_readonly("handle", [](const Door& door) { return door.asset->handle.id; })
      .def_property_readonly("sha256", [](const Door& door) { return ContentHash(*door.asset); })
      .def_property_readonly("hinge", [](const Door& door) { return door.asset->hinge; })
      .def_property_readonly("handle_joint",
                             [](const Door& door) { return door.asset->handle_joint; })
      .def_property_readonly("latch", [](const Door& door) { return door.asset->latch; })
      .def_property_readonly(
          "handle_from_grasp",
          [](const Door& door) { return ToPython(door.asset->handle_from_grasp); })
      .def_property_readonly("links",
                             [](const Door& door) {
                               py::dict links;
                               for (const DoorLink& link : door.asset->links) {
                                 std::vector<std::string> names;
                                 for (const DoorGeometry& geometry : link.geometry)
                                   names.push_back(geometry.name);
                                 links[py::str(link.name)] = names;
                               }
                               return links;
                             })
      .def("mass", [](const Door& door,
                      const std::string& link) { return MassOf(LinkOf(door, link).mass); })
      .def("mesh", [](const Door& door,
                      const std::string& name) { return ToPython(GeometryOf(door, name).mesh); })
      .def("hulls",
           [](const Door& door, const std::string& name) {
             py::list hulls;
             for (const TriangleMesh& hull : GeometryOf(door, name).hulls)
               hulls.append(ToPython(hull));
             return hulls;
           })
      .def("color",
           [](const Door& door, const std::string& name) {
             return ArrayOf(GeometryOf(door, name).color_rgba.data(), {4});
           })
      .def("label",
           [](const Door& door, const std::string& name) {
             constexpr const char* kNames[] = {"body", "handle", "frame", "robot", "other"};
             return kNames[static_cast<std::size_t>(GeometryOf(door, name).label)];
           })
      .def(
          "poses",
          [](const Door& door, double hinge_rad, double handle_rad) {
            py::dict poses;
            const auto door_from = DoorFromLinks(*door.asset, hinge_rad, handle_rad);
            for (std::size_t link = 0; link < door_from.size(); ++link)
              poses[py::str(door.asset->links[link].name)] = ToPython(door_from[link]);
            return poses;
          },
          py::arg("hinge_rad") = 0.0, py::arg("handle_rad") = 0.0)
      .def("change", &Change, py::kw_only(), py::arg("id") = py::none(),
           py::arg("latch") = py::dict(), py::arg("hinge") = py::dict(),
           py::arg("handle_joint") = py::dict())
      .def(
          "save",
          [](const Door& door, const fs::path& folder, bool overwrite) {
            const py::gil_scoped_release others;
            WriteDoorFolder(*door.asset, folder, ExistingOf(overwrite));
          },
          py::arg("folder"), py::kw_only(), py::arg("overwrite") = false)
      .def("_export", &Export)
      .def("__repr__", [](const Door& door) { return "<doorforge.Door " + door.asset->id + ">"; });
}

}  // namespace

void BindDoors(py::module_& module) {
  BindRecords(module);
  BindDoor(module);
  module.def("read_door",
             [](const fs::path& folder) { return Long([&] { return Held(ReadDoor(folder)); }); });
  module.def("compose", &Compose);
  module.def("catalogue", &Catalogue);
  module.def("validate", &Validate);
  module.def("preview", &Preview);
  module.def("find_doors", &FindDoors);
  module.def("validation_rules", [] { return ToPython(RulesToJson()); });
  module.def("split_sides", [](const std::string& word) {
    const fs::path named = DataFolder() / "splits" / (word + ".yaml");
    py::dict sides;
    const Split split = ReadSplit(fs::exists(named) ? named : fs::path(word));
    for (const auto& [side, parts] : SidesOf(split)) sides[py::str(side)] = *parts;
    return sides;
  });
}

}  // namespace doorforge::python
