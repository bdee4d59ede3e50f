// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/exporters/export_door.h"

#include <cstring>
#include <numbers>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <nlohmann/json.hpp>
#ifdef DOORFORGE_WITH_SDFORMAT
#include <sdf/sdf.hh>
#endif

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/compose/compose.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/bolt.h"

#include "scratch_folder.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

DoorAsset SmallDoor(const ComposeConfig& config = {}) {
  Part handle = SmallLever();
  handle.pieces.push_back(MakeSolid("rose", BoxMesh({0, -0.02, -0.02}, {0.005, 0.02, 0.02}), 0.1));
  return ComposeDoor(SmallBody(), handle, config);
}

/// A file compiled by MuJoCo.
class Model {
 public:
  explicit Model(const fs::path& file) {
    char error[1000] = "";
    model_ = mj_loadXML(file.c_str(), nullptr, error, sizeof error);
    if (model_ == nullptr) throw std::runtime_error(error);
    data_ = mj_makeData(model_);
    mj_forward(model_, data_);
  }
  ~Model() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  int Id(mjtObj type, const char* name) const { return mj_name2id(model_, type, name); }
  mjModel* model() const { return model_; }
  mjData* data() const { return data_; }

  double Angle(const char* joint) const {
    return data_->qpos[model_->jnt_qposadr[Id(mjOBJ_JOINT, joint)]];
  }
  void Push(const char* joint, double torque_nm) const {
    data_->qfrc_applied[model_->jnt_dofadr[Id(mjOBJ_JOINT, joint)]] = torque_nm;
  }
  void Run(double seconds) const {
    for (double until = data_->time + seconds; data_->time < until;) mj_step(model_, data_);
  }

 private:
  mjModel* model_;
  mjData* data_;
};

fs::path Exported(const DoorAsset& door, const std::string& name) {
  const fs::path folder = ScratchFolder("export") / name;
  WriteExportedDoor(door, DoorFormats(), folder, Existing::kReplace);
  return folder;
}

void ExpectSameJoint(const Model& urdf, const Model& mjcf, const char* name) {
  const int a = urdf.Id(mjOBJ_JOINT, name);
  const int b = mjcf.Id(mjOBJ_JOINT, name);
  ASSERT_EQ(a < 0, b < 0) << name;
  if (a < 0) return;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(urdf.data()->xaxis[3 * a + k], mjcf.data()->xaxis[3 * b + k], 1e-6) << name;
    EXPECT_NEAR(urdf.data()->xanchor[3 * a + k], mjcf.data()->xanchor[3 * b + k], 1e-6) << name;
  }
  for (int k = 0; k < 2; ++k)
    EXPECT_NEAR(urdf.model()->jnt_range[2 * a + k], mjcf.model()->jnt_range[2 * b + k], 1e-6);
}

void ExpectSameMass(const Model& urdf, const Model& mjcf, const char* name) {
  const int a = urdf.Id(mjOBJ_BODY, name);
  const int b = mjcf.Id(mjOBJ_BODY, name);
  ASSERT_TRUE(b >= 0) << name;
  if (a < 0) return;  // MuJoCo welds a fixed handle of a URDF to its leaf
  EXPECT_NEAR(urdf.model()->body_mass[a], mjcf.model()->body_mass[b], 1e-6) << name;
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(urdf.model()->body_inertia[3 * a + k], mjcf.model()->body_inertia[3 * b + k],
                1e-6 * urdf.model()->body_inertia[3 * a] + 1e-9)
        << name;
}

// URDF and MJCF of a door through MuJoCo's two readers
void ExpectMjcfAgrees(const DoorAsset& door, const fs::path& folder) {
  const Model urdf(folder / "model.urdf");
  const Model mjcf(folder / "model.xml");
  ExpectSameJoint(urdf, mjcf, "hinge");
  ExpectSameJoint(urdf, mjcf, "handle_joint");
  if (door.handle_joint.upper_rad > 0) {
    ExpectSameMass(urdf, mjcf, "leaf");
    ExpectSameMass(urdf, mjcf, "handle");
  }
}

#ifdef DOORFORGE_WITH_SDFORMAT
void ExpectJointAgrees(const sdf::Model& model, const DoorJoint& joint) {
  const sdf::Joint* found = model.JointByName(joint.name);
  ASSERT_NE(found, nullptr);
  if (joint.upper_rad == joint.lower_rad) {
    EXPECT_EQ(found->Type(), sdf::JointType::FIXED);
    return;
  }
  ASSERT_EQ(found->Type(), sdf::JointType::REVOLUTE);
  ignition::math::Vector3d axis;
  EXPECT_TRUE(found->Axis()->ResolveXyz(axis, "__model__").empty());
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(axis[static_cast<std::size_t>(k)], joint.axis[k], 1e-9);
  EXPECT_NEAR(found->Axis()->Lower(), joint.lower_rad, 1e-9);
  EXPECT_NEAR(found->Axis()->Upper(), joint.upper_rad, 1e-9);
  EXPECT_NEAR(found->Axis()->Effort(), joint.effort_limit_nm, 1e-9);
}

void ExpectSdfAgrees(const DoorAsset& door, const fs::path& folder) {
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder / "model.sdf").string());
  for (const sdf::Error& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_NE(root.Model(), nullptr);
  const auto poses = DoorFromLinks(door, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const sdf::Link* link = root.Model()->LinkByName(door.links[i].name);
    ASSERT_NE(link, nullptr);
    EXPECT_NEAR(link->Inertial().MassMatrix().Mass(), door.links[i].mass.mass_kg, 1e-9);
    EXPECT_NEAR(link->Inertial().MassMatrix().Ixx(), door.links[i].mass.inertia_kg_m2(0, 0), 1e-9);
    ignition::math::Pose3d pose;
    EXPECT_TRUE(link->SemanticPose().Resolve(pose, "__model__").empty());
    EXPECT_NEAR(pose.Pos().Y(), poses[i].translation().y(), 1e-9);
    EXPECT_NEAR(pose.Pos().Z(), poses[i].translation().z(), 1e-9);
  }
  ExpectJointAgrees(*root.Model(), door.hinge);
  ExpectJointAgrees(*root.Model(), door.handle_joint);
}
#endif

nlohmann::json JsonOfGlb(const std::string& glb) {
  std::uint32_t header[5];
  std::memcpy(header, glb.data(), sizeof header);
  EXPECT_EQ(header[0], 0x46546C67U);
  EXPECT_EQ(header[1], 2U);
  EXPECT_EQ(header[2], glb.size());
  EXPECT_EQ(header[3] % 4, 0U);
  EXPECT_EQ(header[4], 0x4E4F534AU);
  return nlohmann::json::parse(glb.substr(20, header[3]));
}

// what the specification asks of views and accessors
void ExpectGlbIsSound(const std::string& glb) {
  const nlohmann::json gltf = JsonOfGlb(glb);
  const std::size_t bytes = gltf["buffers"][0]["byteLength"];
  for (const auto& accessor : gltf["accessors"]) {
    const auto& view = gltf["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const std::size_t size = accessor["type"] == "VEC3" ? 12 : 4;
    EXPECT_EQ(view["byteLength"], accessor["count"].get<std::size_t>() * size);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), bytes);
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
  }
}

void ExpectGlbAgrees(const DoorAsset& door, const fs::path& file) {
  const std::string glb = ReadFile(file);
  ExpectGlbIsSound(glb);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  std::size_t triangles = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
  std::size_t expected = 0;
  for (const DoorLink& link : door.links) {
    EXPECT_NE(scene->mRootNode->FindNode(link.name.c_str()), nullptr) << link.name;
    for (const DoorGeometry& geometry : link.geometry) expected += geometry.mesh.triangles.size();
  }
  EXPECT_EQ(triangles, expected);
  for (const auto& node : JsonOfGlb(glb)["nodes"]) {
    if (node["name"] != "leaf" || !node.contains("extras")) continue;
    const auto& joint = node["extras"]["joint"];
    EXPECT_EQ(joint["upper_rad"], door.hinge.upper_rad);
    EXPECT_EQ(joint["axis"][2], door.hinge.axis.z());
    EXPECT_EQ(node["extras"]["mass"]["mass_kg"], door.links[kLeafLink].mass.mass_kg);
  }
}

std::string After(const std::string& text, const std::string& key, std::size_t from = 0) {
  const std::size_t at = text.find(key, from);
  if (at == std::string::npos) return {};
  const std::size_t end = text.find('\n', at);
  return text.substr(at + key.size(), end - at - key.size());
}

void ExpectUsdaAgrees(const DoorAsset& door, const std::string& usda) {
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'(', ')'}, {'[', ']'}})
    EXPECT_EQ(std::count(usda.begin(), usda.end(), open),
              std::count(usda.begin(), usda.end(), close));
  EXPECT_TRUE(usda.starts_with("#usda 1.0\n"));
  const std::size_t leaf = usda.find("def Xform \"leaf\"");
  EXPECT_NEAR(std::stod(After(usda, "physics:mass = ", leaf)), door.links[kLeafLink].mass.mass_kg,
              1e-9);
  const std::size_t hinge = usda.find("def PhysicsRevoluteJoint \"hinge\"");
  ASSERT_NE(hinge, std::string::npos);
  EXPECT_NEAR(std::stod(After(usda, "physics:upperLimit = ", hinge)),
              door.hinge.upper_rad * 180 / std::numbers::pi, 1e-9);
  // the joint's x, turned by localRot1, is the axis
  double w = 0;
  double x = 0;
  double y = 0;
  double z = 0;
  std::sscanf(After(usda, "physics:localRot1 = ", hinge).c_str(), "(%lf, %lf, %lf, %lf)", &w, &x,
              &y, &z);
  EXPECT_LT((Eigen::Quaterniond(w, x, y, z) * Eigen::Vector3d::UnitX() - door.hinge.axis).norm(),
            1e-9);
}

void ExpectAllAgree(const DoorAsset& door, const fs::path& folder) {
  ExpectMjcfAgrees(door, folder);
#ifdef DOORFORGE_WITH_SDFORMAT
  ExpectSdfAgrees(door, folder);
#endif
  ExpectGlbAgrees(door, folder / "model.glb");
  ExpectUsdaAgrees(door, ReadFile(folder / "model.usda"));
}

TEST(ExportDoor, EveryVariantAgreesWithItsUrdfInEveryFormat) {
  for (const ComposeConfig& config :
       {ComposeConfig{}, ComposeConfig{.hinge_side = HingeSide::kRight},
        ComposeConfig{.opening = Opening::kPush},
        ComposeConfig{.handle_turn_deg = 90, .latch = LatchChoice::kBolt}}) {
    const DoorAsset door = SmallDoor(config);
    SCOPED_TRACE(door.id);
    const fs::path folder = Exported(door, door.id);
    ExpectAllAgree(door, folder);
    fs::remove_all(folder);
  }
}

TEST(ExportDoor, SdfIsReadBySdformat) {
#ifndef DOORFORGE_WITH_SDFORMAT
  GTEST_SKIP() << "built without sdformat 12 (Debian: libsdformat-dev)";
#else
  const DoorAsset door = SmallDoor();
  const fs::path folder = Exported(door, "sdf");
  ExpectSdfAgrees(door, folder);
  fs::remove_all(folder);
#endif
}

TEST(ExportDoor, MuJoCosLatchHoldsAndLetsGoOnBothSidesAndBothWays) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      const DoorAsset door = SmallDoor({.hinge_side = side, .opening = opening});
      SCOPED_TRACE(door.id);
      const Bolt bolt = BoltOf(door);
      const fs::path folder = Exported(door, "latch_" + door.id);
      const auto hinge_after = [&](double handle_rad) {
        const Model model(folder / "model.xml");
        mju_zero(model.model()->opt.gravity, 3);
        const double drawn = bolt.travel_m_per_rad * handle_rad;
        model.Push("handle_joint",
                   handle_rad * door.latch.handle_spring_nm_per_rad +
                       bolt.travel_m_per_rad * (bolt.preload_n + bolt.stiffness_n_per_m * drawn));
        model.Run(0.8);
        EXPECT_NEAR(model.Angle("handle_joint"), handle_rad, 0.02);
        model.Push("hinge", 30);
        model.Run(0.8);
        return model.Angle("hinge") * 180 / std::numbers::pi;
      };
      EXPECT_LT(hinge_after(0), 1.5);
      EXPECT_LT(hinge_after(0.5 * door.latch.unlock_angle_rad), 1.5);
      EXPECT_GT(hinge_after(1.05 * door.latch.unlock_angle_rad), 30);
      fs::remove_all(folder);
    }
  }
}

TEST(ExportDoor, MarkupInAnIdIsEscaped) {
  DoorAsset door = SmallDoor({});
  door.id = "a<b>&\"c";  // no reader takes such a name any more
  EXPECT_NE(ToMjcf(door).find("a&lt;b&gt;&amp;&quot;c"), std::string::npos);
  EXPECT_EQ(ToSdf(door).find("a<b>"), std::string::npos);
}

TEST(ExportDoor, CatalogueDoorsOfEveryCategoryAgreeWithTheirUrdf) {
  constexpr std::size_t kDoors = 60;
  std::map<Category, std::array<std::vector<CatalogueEntry>, 2>> categories;
  for (const CatalogueEntry& entry : ListCatalogue(DataFolder()))
    categories[entry.category][static_cast<std::size_t>(entry.role)].push_back(entry);
  std::erase_if(categories, [](const auto& entry) {
    return entry.second[0].empty() || entry.second[1].empty();
  });
  const std::size_t each = (kDoors + categories.size() - 1) / categories.size();
  std::size_t checked = 0;
  for (const auto& [category, entries] : categories) {
    // a few parts, evenly over the families, in all pairs
    std::array<std::vector<Part>, 2> parts;
    const std::size_t side =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(each))));
    for (std::size_t role = 0; role < 2; ++role) {
      const std::size_t count = std::min(side + 2 * role, entries[role].size());
      for (std::size_t i = 0; i < count; ++i)
        parts[role].push_back(BuildCataloguePart(entries[role][i * entries[role].size() / count]));
    }
    for (const Part& body : parts[0]) {
      for (const Part& handle : parts[1]) {
        const DoorAsset door = ComposeDoor(body, handle, {});
        SCOPED_TRACE(door.id);
        const fs::path folder = Exported(door, "catalogue");
        ExpectAllAgree(door, folder);
        ++checked;
      }
    }
  }
  fs::remove_all(ScratchFolder("export"));
  EXPECT_GE(checked, kDoors);
}

}  // namespace
}  // namespace doorforge
