// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>

#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/schemas/door_words.h"

#include "door_formats.h"
#include "export_text.h"
#include "latch_bodies.h"

namespace doorforge {
namespace {

using internal::Decimal;
using internal::Decimals;

constexpr double kDegrees = 180 / std::numbers::pi;

std::string Tuple(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return "(" + Decimals(values, ", ") + ")";
}

std::string Quaternion(const Eigen::Quaterniond& q) {
  return Tuple(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

// names of prims are identifiers
std::string Identifier(const std::string& name) {
  std::string identifier;
  for (const char c : name)
    identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0])) != 0)
    identifier.insert(0, "_");
  return identifier;
}

/// Text with indentation by open braces.
class UsdaText {
 public:
  void Line(const std::string& text) { text_ += std::string(depth_ * 4, ' ') + text + "\n"; }

  void Open(const std::string& definition, const std::string& schemas = {},
            const std::string& metadata = {}) {
    const std::string applied = schemas.empty() ? "" : "prepend apiSchemas = [" + schemas + "]";
    if (metadata.empty()) {
      Line(definition + (applied.empty() ? "" : " (" + applied + ")"));
    } else {
      Line(definition + " (");
      if (!applied.empty()) Line("    " + applied);
      Line("    " + metadata);
      Line(")");
    }
    Line("{");
    ++depth_;
  }

  void Close() {
    --depth_;
    Line("}");
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

/// Entries with commas between them.
class List {
 public:
  void Add(const std::string& entry) { text_ += (text_.empty() ? "" : ", ") + entry; }
  std::string InBrackets() const { return "[" + text_ + "]"; }

 private:
  std::string text_;
};

// Of the face, since surfaces here are flat; to four decimals, as renderers need no more.
Eigen::Vector3d NormalOf(const std::vector<Eigen::Vector3d>& vertices, const Eigen::Vector3i& t) {
  const auto at = [&](int k) -> const Eigen::Vector3d& {
    return vertices[static_cast<std::size_t>(t[k])];
  };
  const Eigen::Vector3d across = (at(1) - at(0)).cross(at(2) - at(0));
  const double length = across.norm();
  if (!(length > 0)) return Eigen::Vector3d::UnitZ();
  return (across / length).unaryExpr([](double x) { return std::round(1e4 * x) / 1e4; });
}

void AddMesh(const std::vector<Eigen::Vector3d>& vertices,
             const std::vector<Eigen::Vector3i>& triangles, UsdaText& usda) {
  List counts;
  List indices;
  List points;
  List normals;
  for (const Eigen::Vector3i& triangle : triangles) {
    counts.Add("3");
    for (const int index : triangle) indices.Add(std::to_string(index));
    normals.Add(Tuple(NormalOf(vertices, triangle)));
  }
  for (const Eigen::Vector3d& vertex : vertices) points.Add(Tuple(vertex));
  usda.Line("int[] faceVertexCounts = " + counts.InBrackets());
  usda.Line("int[] faceVertexIndices = " + indices.InBrackets());
  usda.Line("point3f[] points = " + points.InBrackets());
  usda.Line("normal3f[] normals = " + normals.InBrackets() + " (interpolation = \"uniform\")");
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : vertices) bounds.extend(vertex);
  if (!bounds.isEmpty())
    usda.Line("float3[] extent = [" + Tuple(bounds.min()) + ", " + Tuple(bounds.max()) + "]");
  usda.Line("uniform token subdivisionScheme = \"none\"");
}

std::string LookName(const VisualSurface& surface, std::size_t number) {
  return "look_" + std::to_string(number) + "_" + Identifier(surface.material.name);
}

void AddPicture(const VisualMaterial& material, const std::string& look, UsdaText& usda) {
  const Eigen::Vector4d& c = material.color_rgba;
  usda.Open("def Shader \"coordinates\"");
  usda.Line("uniform token info:id = \"UsdPrimvarReader_float2\"");
  usda.Line("string inputs:varname = \"st\"");
  usda.Line("float2 outputs:result");
  usda.Close();
  usda.Open("def Shader \"picture\"");
  usda.Line("uniform token info:id = \"UsdUVTexture\"");
  usda.Line("asset inputs:file = @./" + AuthoredTexturePath(*material.texture) + "@");
  usda.Line("float2 inputs:st.connect = <" + look + "/coordinates.outputs:result>");
  usda.Line("float4 inputs:scale = " +
            Tuple(Eigen::Vector4d(internal::LinearLight(c[0]), internal::LinearLight(c[1]),
                                  internal::LinearLight(c[2]), 1)));
  usda.Line("token inputs:wrapS = \"repeat\"");
  usda.Line("token inputs:wrapT = \"repeat\"");
  usda.Line("float3 outputs:rgb");
  usda.Close();
}

// `schemas` are those that the material has beside that of its label.
void OpenMaterial(const std::string& look, const std::string& label, const std::string& schemas,
                  UsdaText& usda) {
  usda.Open("def Material \"" + look.substr(look.rfind('/') + 1) + "\"",
            "\"SemanticsLabelsAPI:material\"" + schemas);
  usda.Line("token[] semantics:labels:material = [\"" + Identifier(label) + "\"]");
}

void AddLook(const VisualMaterial& material, const std::string& look, UsdaText& usda) {
  const Eigen::Vector4d& c = material.color_rgba;
  OpenMaterial(look, material.name, {}, usda);
  usda.Line("token outputs:surface.connect = <" + look + "/surface.outputs:surface>");
  if (material.texture != nullptr) AddPicture(material, look, usda);
  usda.Open("def Shader \"surface\"");
  usda.Line("uniform token info:id = \"UsdPreviewSurface\"");
  if (material.texture != nullptr)
    usda.Line("color3f inputs:diffuseColor.connect = <" + look + "/picture.outputs:rgb>");
  else
    usda.Line("color3f inputs:diffuseColor = " +
              Tuple(Eigen::Vector3d(internal::LinearLight(c[0]), internal::LinearLight(c[1]),
                                    internal::LinearLight(c[2]))));
  usda.Line("float inputs:opacity = " + Decimal(c[3]));
  usda.Line("float inputs:roughness = 0.6");
  usda.Line("token outputs:surface");
  usda.Close();
  usda.Close();
}

// Texture coordinates of every corner; zeros where a surface has none.
void AddTexcoords(const VisualMesh& mesh, UsdaText& usda) {
  if (mesh.texcoords.empty()) return;
  List coordinates;
  for (const VisualSurface& surface : mesh.surfaces) {
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const bool known = !surface.texcoords.empty();
        coordinates.Add(
            Tuple(known ? mesh.texcoords[static_cast<std::size_t>(surface.texcoords[i][k])]
                        : Eigen::Vector2d(0, 0)));
      }
    }
  }
  usda.Line("texCoord2f[] primvars:st = " + coordinates.InBrackets() +
            " (interpolation = \"faceVarying\")");
}

void AddVisual(const VisualMesh& mesh, const std::string& path, UsdaText& usda) {
  std::vector<Eigen::Vector3i> triangles;
  List colors;
  List opacities;
  for (const VisualSurface& surface : mesh.surfaces) {
    triangles.insert(triangles.end(), surface.triangles.begin(), surface.triangles.end());
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      colors.Add(Tuple(surface.material.color_rgba.head<3>()));
      opacities.Add(Decimal(surface.material.color_rgba[3]));
    }
  }
  AddMesh(mesh.vertices, triangles, usda);
  AddTexcoords(mesh, usda);
  usda.Line("color3f[] primvars:displayColor = " + colors.InBrackets() +
            " (interpolation = \"uniform\")");
  usda.Line("float[] primvars:displayOpacity = " + opacities.InBrackets() +
            " (interpolation = \"uniform\")");
  usda.Line(std::string("uniform bool doubleSided = ") +
            (internal::HasTwoSides(mesh) ? "false" : "true"));
  usda.Line("uniform token subsetFamily:materialBind:familyType = \"partition\"");
  std::size_t face = 0;
  for (std::size_t i = 0; i < mesh.surfaces.size(); ++i) {
    const VisualSurface& surface = mesh.surfaces[i];
    const std::string look = path + "/" + LookName(surface, i);
    List faces;
    for (std::size_t k = 0; k < surface.triangles.size(); ++k) faces.Add(std::to_string(face++));
    usda.Open("def GeomSubset \"subset_" + std::to_string(i) + "\"", "\"MaterialBindingAPI\"");
    usda.Line("uniform token elementType = \"face\"");
    usda.Line("uniform token familyName = \"materialBind\"");
    usda.Line("int[] indices = " + faces.InBrackets());
    usda.Line("rel material:binding = <" + look + ">");
    usda.Close();
    AddLook(surface.material, look, usda);
  }
}

// `material` is the path of what the shape is made of, or empty.
void AddCollision(const std::string& name, const TriangleMesh& hull, const std::string& material,
                  UsdaText& usda) {
  usda.Open("def Mesh \"" + Identifier(name) + "_collision\"",
            std::string("\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\"") +
                (material.empty() ? "" : ", \"MaterialBindingAPI\""));
  if (!material.empty()) usda.Line("rel material:binding:physics = <" + material + ">");
  AddMesh(hull.vertices, hull.triangles, usda);
  usda.Line("uniform token physics:approximation = \"convexHull\"");
  usda.Line("uniform token purpose = \"guide\"");
  usda.Close();
}

void AddGeometry(const DoorGeometry& geometry, const std::string& link_path, UsdaText& usda) {
  const std::string name = Identifier(geometry.name);
  const bool plain = geometry.visual.empty();
  usda.Open("def Mesh \"" + name + "\"", plain ? "\"MaterialBindingAPI\"" : "");
  if (plain) {
    usda.Line("rel material:binding = <" + link_path + "/" + name + "/look>");
    AddLook({geometry.name, geometry.color_rgba, nullptr}, link_path + "/" + name + "/look", usda);
    AddMesh(geometry.mesh.vertices, geometry.mesh.triangles, usda);
    usda.Line("color3f[] primvars:displayColor = [" + Tuple(geometry.color_rgba.head<3>()) + "]");
    usda.Line("float[] primvars:displayOpacity = [" + Decimal(geometry.color_rgba[3]) + "]");
  } else {
    AddVisual(geometry.visual, link_path + "/" + name, usda);
  }
  usda.Close();
}

void AddCollisions(const DoorLink& link, UsdaText& usda) {
  for (const DoorGeometry& geometry : link.geometry) {
    for (std::size_t i = 0; i < geometry.hulls.size(); ++i)
      AddCollision(geometry.name + "_" + std::to_string(i), geometry.hulls[i], {}, usda);
  }
}

void AddMass(const MassProperties& mass, UsdaText& usda) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(mass.inertia_kg_m2);
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  usda.Line("float physics:mass = " + Decimal(mass.mass_kg));
  usda.Line("point3f physics:centerOfMass = " + Tuple(mass.center_of_mass_m));
  usda.Line("float3 physics:diagonalInertia = " + Tuple(principal.eigenvalues()));
  usda.Line("quatf physics:principalAxes = " + Quaternion(Eigen::Quaterniond(axes)));
}

void AddPose(const RigidTransform& parent_from_prim, UsdaText& usda) {
  usda.Line("double3 xformOp:translate = " + Tuple(parent_from_prim.translation()));
  usda.Line("quatd xformOp:orient = " + Quaternion(Eigen::Quaterniond(parent_from_prim.linear())));
  usda.Line("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
}

// Links that do not touch each other, as they overlap at hinge, rose and bolt.
void AddFilter(const std::vector<std::string>& links, UsdaText& usda) {
  List paths;
  for (const std::string& link : links) paths.Add("<" + link + ">");
  usda.Line("rel physics:filteredPairs = " + paths.InBrackets());
}

/// A link and where it stands in the layer.
struct Placed {
  std::string path;
  RigidTransform door_from_link;
  std::vector<std::string> untouched;  ///< Paths of links that it does not touch.
};

// Leaves the prim open for what it carries.
void OpenLink(const MassProperties& mass, const Placed& placed, UsdaText& usda) {
  const std::string name = placed.path.substr(placed.path.rfind('/') + 1);
  std::string schemas = "\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"";
  if (!placed.untouched.empty()) schemas += ", \"PhysicsFilteredPairsAPI\"";
  schemas += ", \"SemanticsLabelsAPI:class\"";
  usda.Open("def Xform \"" + name + "\"", schemas);
  AddMass(mass, usda);
  if (!placed.untouched.empty()) AddFilter(placed.untouched, usda);
  usda.Line("token[] semantics:labels:class = [\"" + name + "\"]");
  AddPose(placed.door_from_link, usda);
}

void AddGrasp(const DoorAsset& door, UsdaText& usda) {
  usda.Open("def Xform \"grasp\"");
  AddPose(door.handle_from_grasp, usda);
  usda.Line("custom double3 doorforge:halfExtentM = " + Tuple(door.grasp_half_extent_m));
  usda.Close();
}

/// A joint with what it joins.
struct Connection {
  const DoorJoint& joint;
  std::string parent;  ///< Paths of prims.
  std::string child;
  double spring_nm_per_rad;
};

void AddJoint(const Connection& connection, UsdaText& usda) {
  const DoorJoint& joint = connection.joint;
  const bool turns = internal::Turns(joint);
  usda.Open(std::string("def ") + (turns ? "PhysicsRevoluteJoint" : "PhysicsFixedJoint") + " \"" +
                Identifier(joint.name) + "\"",
            turns ? "\"PhysicsDriveAPI:angular\"" : "");
  usda.Line("rel physics:body0 = <" + connection.parent + ">");
  usda.Line("rel physics:body1 = <" + connection.child + ">");
  // the joint's x is turned onto the axis
  const Eigen::Quaterniond turn =
      turns ? Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), joint.axis)
            : Eigen::Quaterniond::Identity();
  const RigidTransform& parent = joint.parent_from_child_at_zero;
  usda.Line("point3f physics:localPos0 = " + Tuple(parent.translation()));
  usda.Line("quatf physics:localRot0 = " + Quaternion(Eigen::Quaterniond(parent.linear()) * turn));
  usda.Line("point3f physics:localPos1 = (0, 0, 0)");
  usda.Line("quatf physics:localRot1 = " + Quaternion(turn));
  if (turns) {
    usda.Line("uniform token physics:axis = \"X\"");
    usda.Line("float physics:lowerLimit = " + Decimal(joint.lower_rad * kDegrees));
    usda.Line("float physics:upperLimit = " + Decimal(joint.upper_rad * kDegrees));
    usda.Line("uniform token drive:angular:physics:type = \"force\"");
    usda.Line("float drive:angular:physics:targetPosition = 0");
    usda.Line("float drive:angular:physics:stiffness = " +
              Decimal(connection.spring_nm_per_rad / kDegrees));
    usda.Line("float drive:angular:physics:damping = " + Decimal(joint.damping_nm_s / kDegrees));
  }
  usda.Close();
}

// unlock_angle_rad is unlockAngleRad here.
std::string CamelCase(const std::string& words) {
  std::string name;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == '_' && i + 1 < words.size())
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(words[++i])));
    else
      name += words[i];
  }
  return name;
}

void AddWord(const std::string& space, const std::string& name, const std::string& text,
             UsdaText& usda) {
  const std::string attribute = "doorforge:" + space + CamelCase(name) + " = ";
  const bool number =
      !text.empty() && text.find_first_not_of("0123456789.e+-") == std::string::npos;
  if (number)
    usda.Line("custom double " + attribute + text);
  else if (text == "true" || text == "false")
    usda.Line("custom bool " + attribute + text);
  else
    usda.Line("custom string " + attribute + "\"" + text + "\"");
}

void AddWords(const DoorAsset& door, UsdaText& usda) {
  for (const auto& [name, text] : LatchWords(door.latch)) AddWord("latch:", name, text, usda);
  // a prim's name cannot hold every id
  for (const auto& [name, text] : DoorWords(door)) AddWord("", name, text, usda);
}

void AddBoltJoint(const Bolt& bolt, const std::array<std::string, 3>& paths,
                  const std::string& leader, UsdaText& usda) {
  usda.Open("def PhysicsPrismaticJoint \"bolt_joint\"",
            "\"NewtonMimicAPI\", \"PhysxMimicJointAPI:rotX\"");
  usda.Line("rel physics:body0 = <" + paths[0] + ">");
  usda.Line("rel physics:body1 = <" + paths[1] + ">");
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());
  usda.Line("point3f physics:localPos0 = " + Tuple(bolt.leaf_from_bolt.translation()));
  usda.Line("quatf physics:localRot0 = " +
            Quaternion(Eigen::Quaterniond(bolt.leaf_from_bolt.linear()) * turn));
  usda.Line("point3f physics:localPos1 = (0, 0, 0)");
  usda.Line("quatf physics:localRot1 = " + Quaternion(turn));
  usda.Line("uniform token physics:axis = \"X\"");
  usda.Line("float physics:lowerLimit = " + Decimal(-bolt.travel_m));
  usda.Line("float physics:upperLimit = 0");
  // position = coefficient * leader, in metres and radians
  usda.Line("rel newton:mimicJoint = <" + leader + ">");
  usda.Line("float newton:mimicCoef0 = 0");
  usda.Line("float newton:mimicCoef1 = " + Decimal(-bolt.travel_m_per_rad));
  // position + gearing * leader = 0
  usda.Line("rel physxMimicJoint:rotX:referenceJoint = <" + leader + ">");
  usda.Line("uniform token physxMimicJoint:rotX:referenceJointAxis = \"rotX\"");
  usda.Line("float physxMimicJoint:rotX:gearing = " + Decimal(bolt.travel_m_per_rad));
  usda.Line("float physxMimicJoint:rotX:offset = 0");
  usda.Close();
}

// The contact is as hard as the engine bears: at Newton's usual stiffness a pull of 75 N pushes the
// bolt through the strike. It is dry: where the mimic is soft, a greased bolt slips back.
void AddSteel(const std::string& steel, UsdaText& usda) {
  OpenMaterial(steel, "steel", ", \"PhysicsMaterialAPI\", \"NewtonMaterialAPI\"", usda);
  usda.Line("float physics:staticFriction = 1");
  usda.Line("float physics:dynamicFriction = 1");
  usda.Line("float newton:contactStiffness = 1000000");
  usda.Line("float newton:contactDamping = 2000");
  usda.Line("token outputs:surface.connect = <" + steel + "/surface.outputs:surface>");
  usda.Open("def Shader \"surface\"");
  usda.Line("uniform token info:id = \"UsdPreviewSurface\"");
  usda.Line("color3f inputs:diffuseColor = (0.52, 0.52, 0.57)");
  usda.Line("float inputs:metallic = 1");
  usda.Line("float inputs:roughness = 0.4");
  usda.Line("token outputs:surface");
  usda.Close();
  usda.Close();
}

void AddBoltLink(const Bolt& bolt, const Placed& placed, const std::string& steel, UsdaText& usda) {
  OpenLink(internal::BoltMass(bolt), placed, usda);
  // one mesh is seen and touches: two would be one on the other
  usda.Open("def Mesh \"bolt_shape\"",
            "\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\", \"MaterialBindingAPI\"");
  usda.Line("rel material:binding = <" + steel + ">");
  usda.Line("rel material:binding:physics = <" + steel + ">");
  AddMesh(bolt.bolt_hull.vertices, bolt.bolt_hull.triangles, usda);
  usda.Line("color3f[] primvars:displayColor = [(0.75, 0.75, 0.78)]");
  usda.Line("uniform token physics:approximation = \"convexHull\"");
  usda.Close();
  usda.Close();
}

std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) quoted += c == '"' || c == '\\' ? '\'' : c;
  return '"' + quoted + '"';
}

// What SimReady's rule SR.004 asks of a catalogue's entry.
void AddCatalogueEntry(const DoorAsset& door, double bolt_kg, UsdaText& usda) {
  const std::array<RigidTransform, 3> poses = DoorFromLinks(door, 0, 0);
  Eigen::AlignedBox3d box;
  double mass_kg = bolt_kg;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    mass_kg += door.links[i].mass.mass_kg;
    for (const DoorGeometry& geometry : door.links[i].geometry) {
      for (const TriangleMesh& hull : geometry.hulls) {
        for (const Eigen::Vector3d& vertex : hull.vertices) box.extend(poses[i] * vertex);
      }
    }
  }
  const Eigen::Vector3d size = box.isEmpty() ? Eigen::Vector3d::Zero() : box.sizes().eval();
  const auto word = [&](const char* name, const std::string& text) {
    usda.Line("            string " + std::string(name) + " = " + Quoted(text));
  };
  usda.Line("    customLayerData = {");
  usda.Line("        dictionary SimReady_Metadata = {");
  word("author", "doorforge");
  word("asset_name", door.id);
  word("asset_type", "articulated prop");
  word("asset_license", door.license.empty() ? "NOASSERTION" : door.license);
  word("category", std::string(NameOf(door.category)) + " door");
  word("source_file", "door.json");
  // the same door gives the same bytes on any day
  word("usd_date_generated", "not stated");
  word("qcode", "Q36794");  // door, in Wikidata
  usda.Line("            int rigid_body_count = " + std::to_string(bolt_kg > 0 ? 4 : 3));
  usda.Line("            double mass = " + Decimal(mass_kg));
  usda.Line("            float3 asset_extents = " + Tuple(size));
  usda.Line("        }");
  usda.Line("    }");
}

void AddAnchor(const std::string& base, UsdaText& usda) {
  usda.Open("def PhysicsFixedJoint \"world_joint\"");
  usda.Line("rel physics:body1 = <" + base + ">");
  usda.Close();
}

}  // namespace

std::string ToUsda(const DoorAsset& door, const ExportSettings& settings) {
  std::optional<internal::LatchBodies> latch;
  if (settings.latch == LatchExport::kBolt) latch = internal::LatchBodiesOf(door);
  UsdaText usda;
  const std::string name = Identifier(door.id);
  usda.Line("#usda 1.0");
  usda.Line("(");
  AddCatalogueEntry(door, latch ? internal::BoltMass(latch->bolt).mass_kg : 0, usda);
  usda.Line("    defaultPrim = \"" + name + "\"");
  usda.Line("    metersPerUnit = 1");
  usda.Line("    kilogramsPerUnit = 1");
  usda.Line("    upAxis = \"Z\"");
  usda.Line(")");
  usda.Line("");
  usda.Open("def Xform \"" + name + "\"",
            "\"PhysicsArticulationRootAPI\", \"PhysxArticulationAPI\", "
            "\"SemanticsLabelsAPI:class\"",
            "kind = \"component\"");
  usda.Line("token[] semantics:labels:class = [\"door\"]");
  // what holds the door is a contact of two of its links
  if (latch) usda.Line("bool physxArticulation:enabledSelfCollisions = 1");
  AddWords(door, usda);
  const std::array<RigidTransform, 3> poses = DoorFromLinks(door, 0, 0);
  std::array<std::string, 3> paths;
  for (std::size_t i = 0; i < poses.size(); ++i)
    paths[i] = "/" + name + "/" + Identifier(door.links[i].name);
  const std::string bolt_path = "/" + name + "/" + internal::kBoltLink;
  const std::string steel = "/" + name + "/latch_steel";
  if (latch) AddSteel(steel, usda);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const DoorLink& link = door.links[i];
    Placed placed{paths[i], poses[i], {}};
    for (std::size_t k = 0; latch && k < i; ++k) placed.untouched.push_back(paths[k]);
    OpenLink(link.mass, placed, usda);
    for (const DoorGeometry& geometry : link.geometry) AddGeometry(geometry, paths[i], usda);
    if (latch && i == kBaseLink)
      for (const internal::FramePiece& piece : latch->frame)
        AddCollision(piece.name, piece.hull,
                     piece.file == internal::kStrikeMeshPath ? steel : std::string(), usda);
    else
      AddCollisions(link, usda);
    if (i == kHandleLink) AddGrasp(door, usda);
    usda.Close();
  }
  if (latch)
    AddBoltLink(latch->bolt,
                {bolt_path,
                 poses[kLeafLink] * latch->bolt.leaf_from_bolt,
                 {paths[kLeafLink], paths[kHandleLink]}},
                steel, usda);
  AddAnchor(paths[kBaseLink], usda);
  AddJoint({door.hinge, paths[kBaseLink], paths[kLeafLink], door.latch.hinge_spring_nm_per_rad},
           usda);
  AddJoint({door.handle_joint, paths[kLeafLink], paths[kHandleLink],
            door.latch.handle_spring_nm_per_rad},
           usda);
  if (latch)
    AddBoltJoint(latch->bolt, {paths[kLeafLink], bolt_path, {}},
                 "/" + name + "/" + Identifier(door.handle_joint.name), usda);
  usda.Close();
  return usda.text();
}

namespace internal {
namespace {

// Beside a USD layer, which holds all else.
void WriteTextures(const DoorAsset& door, const std::filesystem::path& folder) {
  for (const DoorLink& link : door.links) {
    for (const DoorGeometry& geometry : link.geometry) {
      for (const auto& texture : TexturesOf(geometry.visual))
        CommitFile(folder / AuthoredTexturePath(*texture), texture->bytes);
    }
  }
}

}  // namespace

void WriteUsda(const DoorAsset& door, const ExportSettings& settings,
               const std::filesystem::path& folder) {
  CommitFile(folder / "model.usda", ToUsda(door, settings));
  WriteTextures(door, folder);
}

}  // namespace internal
}  // namespace doorforge
