// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <deque>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "read/readers.h"
#include "read/xml_source.h"

namespace doorforge::foreign {
namespace {

namespace fs = std::filesystem;

// MuJoCo's XML reference; of the elements that objects are made of
const std::vector<KnownElement>& MjcfElements() {
  static const std::vector<std::string> in_body = {
      "body",  "joint",     "freejoint", "geom",   "site",   "inertial",  "camera",
      "light", "composite", "frame",     "plugin", "attach", "replicate", "flexcomp"};
  static const std::vector<KnownElement> known = {
      {"mujoco",
       {"model"},
       {"compiler", "option", "size", "visual", "statistic", "default", "custom", "asset",
        "worldbody", "contact", "equality", "tendon", "actuator", "sensor", "keyframe", "include",
        "extension", "deformable"}},
      {"worldbody", {}, in_body},
      {"body",
       {"name", "childclass", "mocap", "pos", "quat", "axisangle", "xyaxes", "zaxis", "euler",
        "gravcomp", "user", "sleep"},
       in_body},
      {"joint",
       {"name",
        "class",
        "type",
        "group",
        "pos",
        "axis",
        "springdamper",
        "limited",
        "actuatorfrclimited",
        "solreflimit",
        "solimplimit",
        "solreffriction",
        "solimpfriction",
        "stiffness",
        "range",
        "actuatorfrcrange",
        "margin",
        "ref",
        "springref",
        "armature",
        "damping",
        "frictionloss",
        "user",
        "actuatorgravcomp"},
       {}},
      {"inertial",
       {"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "mass", "diaginertia",
        "fullinertia"},
       {}},
      {"geom",
       {"name",         "class",    "type",      "contype",    "conaffinity", "condim", "group",
        "priority",     "size",     "material",  "rgba",       "friction",    "mass",   "density",
        "shellinertia", "solmix",   "solref",    "solimp",     "margin",      "gap",    "fromto",
        "pos",          "quat",     "axisangle", "xyaxes",     "zaxis",       "euler",  "hfield",
        "mesh",         "fitscale", "user",      "fluidshape", "fluidcoef"},
       {}},
  };
  return known;
}

const std::set<std::string>& GeomTypes() {
  static const std::set<std::string> types = {"plane",    "hfield",    "sphere", "capsule", "sdf",
                                              "cylinder", "ellipsoid", "box",    "mesh"};
  return types;
}

/// The attributes that each class gives to each kind of element. A class knows the one around it
/// and what it says itself: copies of all that those around it say would grow with their product.
class MjcfDefaults {
 public:
  void Read(const XmlElement& element, const std::string& name, const XmlSource& source) {
    Read(element, name, nullptr, source);
  }

  bool Has(const std::string& name) const { return name == "main" || named_.contains(name); }

  /// The element that states an attribute of an element of a class: itself, or a default's.
  const XmlElement* StatedBy(const XmlElement& element, std::string_view attribute,
                             const std::string& name) const {
    if (element.Attribute(attribute) != nullptr) return &element;
    const auto named = named_.find(name.empty() ? "main" : name);
    const std::pair<std::string_view, std::string_view> key(element.name, attribute);
    for (const Class* at = named == named_.end() ? nullptr : named->second; at != nullptr;
         at = at->around) {
      if (const auto found = at->stated.find(key); found != at->stated.end()) return found->second;
    }
    return nullptr;
  }

 private:
  struct Class {
    const Class* around = nullptr;
    // by the name of an element and of an attribute, which the document keeps
    std::map<std::pair<std::string_view, std::string_view>, const XmlElement*> stated;
  };

  void Read(const XmlElement& element, const std::string& name, const Class* around,
            const XmlSource& source) {
    Class& made = classes_.emplace_back();
    made.around = around;
    named_[name] = &made;
    for (const XmlElement* child : element.children) {
      if (child->name == "default") {
        const XmlAttribute* named = child->Attribute("class");
        if (named == nullptr || named->value.empty())
          source.faults().Add("FIL007", source.At(*child), "no attribute class");
        Read(*child, named == nullptr ? "" : named->value, &made, source);
      } else {
        for (const XmlAttribute& attribute : child->attributes)
          made.stated[{child->name, attribute.name}] = child;
      }
    }
  }

  std::deque<Class> classes_;  // they stay where they are
  std::map<std::string, const Class*> named_;
};

struct MeshAsset {
  std::string file;
  Eigen::Vector3d scale{1, 1, 1};
  SourcePlace place;
  bool inline_vertices = false;
  bool used = false;
};

class MjcfReader {
 public:
  MjcfReader(const std::string& file, fs::path root, FaultList& faults)
      : root_(std::move(root)), faults_(faults), main_(file, faults) {}

  ArticulatedObject Read(const XmlElement& mujoco) {
    object_.place = main_.At(mujoco);
    if (const XmlAttribute* model = mujoco.Attribute("model")) object_.name = model->value;
    tops_.push_back({&mujoco, &main_});
    included_.insert(fs::absolute(main_.file()).lexically_normal().string());
    // what is included may include; the list grows while it is walked
    for (std::size_t i = 0; i < tops_.size(); ++i) FollowIncludes(i);
    for (const Top& top : tops_) top.source->CheckSpelling(*top.root, MjcfElements());
    // sections come in any order and in any of the files, while each needs what those before it say
    Each("compiler",
         [&](const XmlElement& element, const XmlSource& source) { Compiler(element, source); });
    Each("default", [&](const XmlElement& element, const XmlSource& source) {
      const XmlAttribute* named = element.Attribute("class");
      defaults_.Read(element, named == nullptr ? "main" : named->value, source);
    });
    Each("asset",
         [&](const XmlElement& element, const XmlSource& source) { Assets(element, source); });
    object_.links.push_back({"world", {}, {}, object_.place});
    Each("worldbody", [&](const XmlElement& element, const XmlSource& source) {
      Bodies(element, source, 0, "");
    });
    Each("equality",
         [&](const XmlElement& element, const XmlSource& source) { Equality(element, source); });
    for (const char* section : {"actuator", "tendon", "sensor", "contact"})
      Each(section, [&](const XmlElement& element, const XmlSource& source) {
        References(element, source);
      });
    for (const auto& [name, mesh] : meshes_) {
      if (!mesh.used && !mesh.inline_vertices)
        object_.files.push_back({mesh.file, mesh.place, false});
    }
    return std::move(object_);
  }

 private:
  struct Top {
    const XmlElement* root;
    const XmlSource* source;
  };

  template <class Use>
  void Each(std::string_view section, Use&& use) {
    for (const Top& top : tops_) {
      for (const XmlElement* child : top.root->children) {
        if (child->name == section) use(*child, *top.source);
      }
    }
  }

  // A stack of its own, here and for bodies: how deep a file goes is up to whoever wrote it.
  void FollowIncludes(std::size_t top) {
    std::vector<const XmlElement*> pending{tops_[top].root};
    while (!pending.empty()) {
      const XmlElement& element = *pending.back();
      pending.pop_back();
      for (const XmlElement* child : element.children) {
        if (child->name == "include")
          Include(*child, *tops_[top].source);
        else
          pending.push_back(child);
      }
    }
  }

  void Include(const XmlElement& include, const XmlSource& source) {
    const auto name = source.Text(include, "file");
    if (!name) return;
    const fs::path path = (fs::path(source.file()).parent_path() / *name).lexically_normal();
    const fs::path absolute = fs::absolute(path).lexically_normal();
    const fs::path relative = absolute.lexically_relative(root_);
    if (fs::path(*name).is_absolute() || relative.empty() || *relative.begin() == "..")
      return faults_.Add("GEO002", source.At(include, "file"), "\"" + *name + '"');
    std::error_code error;
    if (!fs::is_regular_file(path, error))
      return faults_.Add(
          "GEO001", source.At(include, "file"),
          '"' + *name + "\": " + (fs::exists(path, error) ? kNoRegularFile : "no such file"));
    // ends circles that the paths do not show, such as those of links
    if (documents_.size() >= 64)
      return faults_.Add("FIL003", source.At(include), "more than the 64 includes allowed");
    if (!included_.insert(absolute.string()).second) return;
    const auto text = ForeignText(path, faults_);
    if (!text) return;
    auto document = ForeignXml(*text, path.string(), faults_);
    if (!document) return;
    documents_.push_back(std::move(*document));
    sources_.emplace_back(path.string(), faults_);
    tops_.push_back({documents_.back().root, &sources_.back()});
    // what is included inside a body is not placed: its names count as there
    includes_ = includes_ || include.parent->name != "mujoco";
  }

  void Compiler(const XmlElement& element, const XmlSource& source) {
    const auto word = [&](const char* name) { return source.Text(element, name, false); };
    if (const auto angle = word("angle")) degrees_ = *angle != "radian";
    if (const auto folder = word("meshdir")) mesh_folder_ = *folder;
    if (const auto folder = word("texturedir")) texture_folder_ = *folder;
    if (const auto folder = word("assetdir")) {
      if (mesh_folder_.empty()) mesh_folder_ = *folder;
      if (texture_folder_.empty()) texture_folder_ = *folder;
    }
    if (const auto word_of = word("autolimits")) auto_limits_ = *word_of != "false";
    if (const auto sequence = word("eulerseq")) euler_ = *sequence;
    if (const auto strip = word("strippath")) strip_ = *strip == "true";
  }

  std::string InFolder(const std::string& folder, const std::string& name) const {
    const std::string file = strip_ ? fs::path(name).filename().string() : name;
    return folder.empty() ? file : (fs::path(folder) / file).string();
  }

  void Assets(const XmlElement& asset, const XmlSource& source) {
    for (const XmlElement* element : asset.children) {
      const auto file = source.Text(*element, "file", false);
      std::string name = source.Text(*element, "name", false).value_or("");
      if (name.empty() && file) name = fs::path(*file).stem().string();
      if (!name.empty() && !assets_.insert(element->name + ' ' + name).second)
        faults_.Add("TRE012", source.At(*element),
                    "a second " + element->name + " \"" + name + '"');
      if (element->name == "mesh") {
        MeshAsset& mesh = meshes_[name];
        mesh.place = source.At(*element, "file");
        if (file) mesh.file = InFolder(mesh_folder_, *file);
        mesh.inline_vertices = !file;
        const XmlElement* scale =
            defaults_.StatedBy(*element, "scale", ClassOf(*element, "", source));
        if (scale != nullptr) mesh.scale = source.Vector(*scale, "scale").value_or(mesh.scale);
        if (!file && element->Attribute("vertex") == nullptr &&
            element->Attribute("builtin") == nullptr && element->children.empty())
          faults_.Add("FIL007", source.At(*element), "neither file nor vertex");
      }
      if (element->name == "texture" && file)
        object_.files.push_back(
            {InFolder(texture_folder_, *file), source.At(*element, "file"), false});
      if (element->name == "material") {
        const auto texture = source.Text(*element, "texture", false);
        if (texture) textures_used_.push_back({*texture, source.At(*element, "texture"), false});
      }
    }
    for (const ForeignFileName& used : textures_used_) {
      if (!assets_.contains("texture " + used.name) && !includes_)
        faults_.Add("TRE011", used.place, "texture \"" + used.name + '"');
    }
    textures_used_.clear();
  }

  std::string ClassOf(const XmlElement& element, const std::string& of_body,
                      const XmlSource& source) {
    const XmlAttribute* named = element.Attribute("class");
    if (named == nullptr) return of_body;
    if (!defaults_.Has(named->value))
      faults_.Add("TRE011", PlaceOf(source.file(), element, *named),
                  "default class \"" + named->value + '"');
    return named->value;
  }

  RigidTransform Frame(const XmlElement& element, const XmlSource& source,
                       const std::string& name) {
    RigidTransform frame = RigidTransform::Identity();
    const auto stated = [&](const char* attribute) {
      return defaults_.StatedBy(element, attribute, name);
    };
    if (const XmlElement* by = stated("pos"))
      frame.translation() = source.Vector(*by, "pos").value_or(Eigen::Vector3d::Zero());
    if (const XmlElement* by = stated("quat")) {
      const auto q = source.Numbers(*by, "quat", 4, 4);
      if (q) {
        const Eigen::Quaterniond turn((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
        if (turn.norm() > 1e-9)
          frame.linear() = turn.normalized().toRotationMatrix();
        else
          faults_.Add("FIL006", source.At(*by, "quat"), "a quaternion of length 0");
      }
    } else if (const XmlElement* euler = stated("euler")) {
      if (const auto angles = source.Vector(*euler, "euler")) frame.linear() = Euler(*angles);
    }
    return frame;
  }

  Eigen::Matrix3d Euler(const Eigen::Vector3d& angles) const {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (std::size_t i = 0; i < 3 && i < euler_.size(); ++i) {
      const char axis = euler_[i];
      const bool fixed = axis >= 'X' && axis <= 'Z';
      const int k = fixed ? axis - 'X' : axis - 'x';
      if (k < 0 || k > 2) continue;
      const Eigen::Matrix3d one =
          Eigen::AngleAxisd(InRadians(angles[static_cast<int>(i)]), Eigen::Vector3d::Unit(k))
              .toRotationMatrix();
      turn = fixed ? Eigen::Matrix3d(one * turn) : Eigen::Matrix3d(turn * one);
    }
    return turn;
  }

  double InRadians(double angle) const { return degrees_ ? angle * std::numbers::pi / 180 : angle; }

  struct Visit {
    const XmlElement* body;
    std::size_t parent;
    std::string of_class;
    RigidTransform frame = RigidTransform::Identity();  // of <frame> around it
  };

  void Bodies(const XmlElement& world, const XmlSource& source, std::size_t parent,
              const std::string& of_class) {
    std::vector<Visit> pending;
    Content({&world, parent, of_class}, source, pending);
    while (!pending.empty()) {
      const Visit visit = pending.back();
      pending.pop_back();
      if (visit.body->name == "frame") {
        Content(visit, source, pending);
      } else {
        Body(visit, source, pending);
      }
    }
  }

  void Body(const Visit& visit, const XmlSource& source, std::vector<Visit>& pending) {
    const XmlElement& body = *visit.body;
    ForeignLink link;
    link.place = source.At(body);
    link.name = source.Text(body, "name", false).value_or("");
    if (link.name.empty()) link.name = "body on line " + std::to_string(body.line);
    std::string of_class = visit.of_class;
    if (const XmlAttribute* child_class = body.Attribute("childclass")) {
      of_class = child_class->value;
      if (!defaults_.Has(of_class))
        faults_.Add("TRE011", source.At(body, "childclass"), "default class \"" + of_class + '"');
    }
    const std::size_t parent = visit.parent;
    // classes say nothing of bodies, only of what is in them
    const RigidTransform frame = visit.frame * Frame(body, source, "");
    const std::string parent_name = object_.links[parent].name;
    const std::string name = link.name;
    Joints(body, source, {parent_name, name, of_class, frame});
    object_.links.push_back(std::move(link));
    Content({&body, object_.links.size() - 1, of_class}, source, pending);
  }

  // Shapes and inertia of a body, or of the world; its bodies are put aside.
  void Content(const Visit& visit, const XmlSource& source, std::vector<Visit>& pending) {
    const std::size_t link = visit.parent;
    for (const XmlElement* child : visit.body->children) {
      if (child->name == "geom") {
        ForeignShape shape = Geom(*child, source, visit.of_class);
        shape.link_from_shape = visit.frame * shape.link_from_shape;
        object_.links[link].shapes.push_back(std::move(shape));
      }
      if (child->name == "inertial") object_.links[link].inertial = Inertial(*child, source);
      if (child->name == "site" || child->name == "camera") Remember(*child, source);
      const bool frame = child->name == "frame";
      if (!frame && child->name != "body") continue;
      pending.push_back(
          {child, link, visit.of_class,
           frame ? RigidTransform(visit.frame * Frame(*child, source, "")) : visit.frame});
    }
  }

  void Remember(const XmlElement& element, const XmlSource& source) {
    const auto name = source.Text(element, "name", false);
    if (name && !assets_.insert(element.name + ' ' + *name).second)
      faults_.Add("TRE012", source.At(element), "a second " + element.name + " \"" + *name + '"');
  }

  struct Ends {
    std::string parent;
    std::string child;
    std::string of_class;
    RigidTransform frame;
  };

  // A body of several joints hangs on links without shape, one for each joint but the last.
  void Joints(const XmlElement& body, const XmlSource& source, Ends ends) {
    std::vector<const XmlElement*> joints;
    for (const XmlElement* child : body.children) {
      if (child->name == "joint" || child->name == "freejoint") joints.push_back(child);
    }
    if (joints.empty()) {
      ForeignJoint fixed;
      fixed.place = fixed.axis_place = fixed.dynamics_place = source.At(body);
      fixed.name = "of " + ends.child + " on line " + std::to_string(body.line);
      fixed.parent = ends.parent;
      fixed.child = ends.child;
      fixed.parent_from_joint = ends.frame;
      object_.joints.push_back(fixed);
    }
    const std::string last = ends.child;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      ends.child = i + 1 == joints.size() ? last : last + " before joint " + std::to_string(i + 2);
      if (i + 1 < joints.size())
        object_.links.push_back({ends.child, {}, {}, source.At(*joints[i])});
      object_.joints.push_back(Joint(*joints[i], source, ends));
      ends.parent = ends.child;
      ends.frame = RigidTransform::Identity();
    }
  }

  ForeignJoint Joint(const XmlElement& element, const XmlSource& source, const Ends& ends) {
    const std::string of_class = ClassOf(element, ends.of_class, source);
    const auto stated = [&](const char* attribute) {
      return defaults_.StatedBy(element, attribute, of_class);
    };
    ForeignJoint joint;
    joint.place = joint.axis_place = joint.dynamics_place = source.At(element);
    joint.name = source.Text(element, "name", false).value_or("");
    if (joint.name.empty()) joint.name = "joint on line " + std::to_string(element.line);
    joint_names_.insert(joint.name);
    joint.parent = ends.parent;
    joint.child = ends.child;
    joint.parent_from_joint = ends.frame;
    joint.type = JointType(element, stated("type"), source);
    if (const XmlElement* by = stated("pos")) {
      const RigidTransform at =
          Translation(source.Vector(*by, "pos").value_or(Eigen::Vector3d::Zero()));
      joint.parent_from_joint = ends.frame * at;
      joint.child_from_joint = at;
    }
    joint.axis = Eigen::Vector3d::UnitZ();
    if (const XmlElement* by = stated("axis")) {
      joint.axis_place = source.At(*by, "axis");
      joint.axis = source.Vector(*by, "axis");
    }
    Range(element, source, of_class, joint);
    if (const XmlElement* by = stated("damping"))
      if (const auto numbers = source.Numbers(*by, "damping", 1, 3))
        joint.damping = numbers->front();
    if (const XmlElement* by = stated("frictionloss"))
      joint.friction = source.Number(*by, "frictionloss");
    return joint;
  }

  ForeignJointType JointType(const XmlElement& element, const XmlElement* by,
                             const XmlSource& source) {
    if (element.name == "freejoint") return ForeignJointType::kOther;
    const std::string word = by == nullptr ? "hinge" : by->Attribute("type")->value;
    if (word == "hinge") return ForeignJointType::kContinuous;
    if (word == "slide") return ForeignJointType::kPrismatic;
    if (word != "ball" && word != "free")
      faults_.Add("FIL008", source.At(*by, "type"),
                  "\"" + word + "\", expected hinge, slide, ball or free");
    return ForeignJointType::kOther;
  }

  // A range holds where it is said to, or where nothing is said and the compiler does not mind.
  void Range(const XmlElement& element, const XmlSource& source, const std::string& of_class,
             ForeignJoint& joint) {
    const XmlElement* by = defaults_.StatedBy(element, "range", of_class);
    const XmlElement* limited = defaults_.StatedBy(element, "limited", of_class);
    const std::string word = limited == nullptr ? "auto" : limited->Attribute("limited")->value;
    const bool holds = word == "true" || (word == "auto" && auto_limits_ && by != nullptr);
    if (!holds) return;
    if (by == nullptr) return faults_.Add("FIL007", source.At(element), "limited, and no range");
    const auto range = source.Numbers(*by, "range", 2, 2);
    if (!range) return;
    const bool turns = joint.type == ForeignJointType::kContinuous;
    const auto value = [&](std::size_t i) { return turns ? InRadians((*range)[i]) : (*range)[i]; };
    joint.limit = {value(0), value(1), {}, {}, source.At(*by, "range")};
    if (turns) joint.type = ForeignJointType::kRevolute;
  }

  std::optional<ForeignInertial> Inertial(const XmlElement& element, const XmlSource& source) {
    ForeignInertial inertial;
    inertial.place = inertial.inertia_place = source.At(element);
    inertial.mass_place = source.At(element, "mass");
    const RigidTransform frame = Frame(element, source, "");
    inertial.center_m = frame.translation();
    source.Text(element, "pos");
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    if (const auto full = source.Numbers(element, "fullinertia", 6, 6)) {
      matrix << (*full)[0], (*full)[3], (*full)[4], (*full)[3], (*full)[1], (*full)[5], (*full)[4],
          (*full)[5], (*full)[2];
      inertial.inertia_kg_m2 = frame.linear() * matrix * frame.linear().transpose();
      inertial.inertia_place = source.At(element, "fullinertia");
    } else if (const auto diagonal = source.Vector(element, "diaginertia")) {
      matrix.diagonal() = *diagonal;
      inertial.inertia_kg_m2 = frame.linear() * matrix * frame.linear().transpose();
      inertial.inertia_place = source.At(element, "diaginertia");
    }
    const auto mass = source.RequiredNumber(element, "mass");
    inertial.mass_kg = mass.value_or(std::numeric_limits<double>::quiet_NaN());
    return inertial;
  }

  ForeignShape Geom(const XmlElement& element, const XmlSource& source,
                    const std::string& body_class) {
    const std::string of_class = ClassOf(element, body_class, source);
    const auto stated = [&](const char* attribute) {
      return defaults_.StatedBy(element, attribute, of_class);
    };
    ForeignShape shape;
    shape.place = source.At(element);
    shape.name = source.Text(element, "name", false).value_or("");
    Remember(element, source);
    shape.link_from_shape = Frame(element, source, of_class);
    const auto off = [&](const char* attribute) {
      const XmlElement* by = stated(attribute);
      return by != nullptr && by->Attribute(attribute)->value == "0";
    };
    // what may touch nothing is there to be seen
    shape.use = off("contype") && off("conaffinity") ? ShapeUse::kVisual : ShapeUse::kBoth;
    if (const XmlElement* by = stated("mass"); by != nullptr) {
      const auto mass = source.Number(*by, "mass");
      if (mass && *mass < 0) faults_.Add("INR001", source.At(*by, "mass"), Measured(*mass, "kg"));
    }
    if (const XmlElement* by = stated("material")) {
      const std::string& name = by->Attribute("material")->value;
      if (!assets_.contains("material " + name) && !includes_)
        faults_.Add("TRE011", source.At(*by, "material"), "material \"" + name + '"');
    }
    shape.geometry = Geometry(element, source, of_class, shape);
    return shape;
  }

  ForeignGeometry Geometry(const XmlElement& element, const XmlSource& source,
                           const std::string& of_class, ForeignShape& shape) {
    const auto stated = [&](const char* attribute) {
      return defaults_.StatedBy(element, attribute, of_class);
    };
    const XmlElement* type_by = stated("type");
    const XmlElement* mesh_by = stated("mesh");
    std::string type = type_by != nullptr   ? type_by->Attribute("type")->value
                       : mesh_by != nullptr ? "mesh"
                                            : "sphere";
    if (!GeomTypes().contains(type)) {
      faults_.Add("FIL008", source.At(*type_by, "type"),
                  "\"" + type + "\", expected a geom's type");
      return {};
    }
    if (type == "mesh" || type == "sdf" || mesh_by != nullptr)
      return MeshGeometry(element, mesh_by, source, shape);
    const XmlElement* size_by = stated("size");
    const bool from_to = stated("fromto") != nullptr;
    if (size_by == nullptr) {
      if (type != "plane" && type != "hfield" && !from_to)
        faults_.Add("FIL007", source.At(element), "no attribute size");
      return {};
    }
    shape.place = source.At(*size_by, "size");
    const auto size = source.Numbers(*size_by, "size", 1, 3);
    if (!size || type == "plane" || type == "hfield" || type == "ellipsoid" || from_to) return {};
    if (type == "sphere") return ForeignSphere{(*size)[0]};
    if (type == "box") {
      if (size->size() < 3) {
        faults_.Add("FIL006", shape.place, std::to_string(size->size()) + " numbers, expected 3");
        return {};
      }
      // sizes are halves
      return ForeignBox{2 * Eigen::Vector3d((*size)[0], (*size)[1], (*size)[2])};
    }
    if (size->size() < 2) {
      faults_.Add("FIL006", shape.place, "1 number, expected 2");
      return {};
    }
    return ForeignCylinder{(*size)[0], 2 * (*size)[1]};
  }

  ForeignGeometry MeshGeometry(const XmlElement& element, const XmlElement* by,
                               const XmlSource& source, ForeignShape& shape) {
    if (by == nullptr) {
      faults_.Add("FIL007", source.At(element), "no attribute mesh");
      return {};
    }
    const std::string& name = by->Attribute("mesh")->value;
    const auto mesh = meshes_.find(name);
    if (mesh == meshes_.end()) {
      if (!includes_) faults_.Add("TRE011", source.At(*by, "mesh"), "mesh \"" + name + '"');
      return {};
    }
    mesh->second.used = true;
    if (mesh->second.inline_vertices) return {};
    shape.place = mesh->second.place;
    // MuJoCo collides convex hulls, whether the mesh is closed or not
    shape.as_hull = true;
    return ForeignMeshFile{mesh->second.file, mesh->second.scale};
  }

  void Equality(const XmlElement& equality, const XmlSource& source) {
    for (const XmlElement* element : equality.children) {
      const std::vector<const char*> keys = element->name == "joint"
                                                ? std::vector{"joint1", "joint2"}
                                                : std::vector{"body1", "body2"};
      if (element->name != "joint" && element->name != "weld" && element->name != "connect")
        continue;
      for (const char* key : keys) {
        const auto name = source.Text(*element, key, false);
        // a name may be that of a body in a file which could not be placed
        if (!name || includes_) continue;
        const bool known = element->name == "joint" ? joint_names_.contains(*name) : HasLink(*name);
        if (!known)
          faults_.Add("TRE011", source.At(*element, key), std::string(key) + " \"" + *name + '"');
      }
    }
  }

  bool HasLink(const std::string& name) const {
    for (const ForeignLink& link : object_.links) {
      if (link.name == name) return true;
    }
    return false;
  }

  void References(const XmlElement& section, const XmlSource& source) {
    if (includes_) return;
    std::vector<const XmlElement*> pending(section.children.begin(), section.children.end());
    while (!pending.empty()) {
      const XmlElement& element = *pending.back();
      pending.pop_back();
      pending.insert(pending.end(), element.children.begin(), element.children.end());
      for (const char* end : {"geom1", "geom2"}) {
        if (const auto geom = source.Text(element, end, false)) object_.paired.insert(*geom);
      }
      const auto name = source.Text(element, "joint", false);
      if (name && !joint_names_.contains(*name))
        faults_.Add("TRE011", source.At(element, "joint"), "joint \"" + *name + '"');
    }
  }

  fs::path root_;
  FaultList& faults_;
  XmlSource main_;
  std::deque<XmlDocument> documents_;
  std::deque<XmlSource> sources_;
  std::vector<Top> tops_;
  std::set<std::string> included_;
  bool includes_ = false;

  MjcfDefaults defaults_;
  std::map<std::string, MeshAsset> meshes_;
  std::set<std::string> assets_;
  std::vector<ForeignFileName> textures_used_;
  std::set<std::string> joint_names_;
  // what MuJoCo takes where a file says nothing
  bool degrees_ = true;
  bool auto_limits_ = true;
  bool strip_ = false;
  std::string euler_ = "xyz";
  std::string mesh_folder_;
  std::string texture_folder_;
  ArticulatedObject object_;
};

}  // namespace

ArticulatedObject ReadForeignMjcf(const XmlDocument& document, const std::string& file,
                                  const std::filesystem::path& root, FaultList& faults) {
  return MjcfReader(file, root, faults).Read(*document.root);
}

}  // namespace doorforge::foreign
