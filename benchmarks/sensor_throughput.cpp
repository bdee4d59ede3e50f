// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// How fast the camera sees, as ratios against a bare packet loop over the same scene in the same
// run. All times are CPU time of this thread, medians
// of several. raycast_peer.py lets Open3D look at the same scenes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "doorforge/core/hash.h"
#include "doorforge/core/rng.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/farthest_point_sampling.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {
namespace {

constexpr int kLinks = 16;

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Work>
double Milliseconds(const Work& work) {
  timespec before{};
  timespec after{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  work();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  return 1e3 * static_cast<double>(after.tv_sec - before.tv_sec) +
         1e-6 * static_cast<double>(after.tv_nsec - before.tv_nsec);
}

template <class Work>
double MedianMilliseconds(int repeats, const Work& work) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) times.push_back(Milliseconds([&] { work(i); }));
  return Median(times);
}

// A lumpy capsule about the z axis, 2 * around * along triangles.
TriangleMesh Capsule(int around, int along, double radius, double length) {
  constexpr double kTwoPi = 6.283185307179586;
  TriangleMesh mesh;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = kTwoPi * i / around;
      const double t = 2.0 * j / along - 1;
      const double r = radius * std::sqrt(std::max(0.0, 1 - std::pow(std::fabs(t), 8.0))) *
                       (1 + 0.1 * std::sin(6 * angle + 4 * t));
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), length * t / 2);
    }
  }
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i;
      const int b = j * around + (i + 1) % around;
      mesh.triangles.emplace_back(a, b, a + around);
      mesh.triangles.emplace_back(b, b + around, a + around);
    }
  }
  return mesh;
}

std::vector<VisibleMesh> MakeScene(int around, int along) {
  std::vector<VisibleMesh> meshes;
  for (int link = 0; link + 3 < kLinks; ++link)
    meshes.push_back({Capsule(around, along, 0.09, 0.4), link, PointLabel::kRobot});
  TriangleMesh leaf;
  leaf.vertices = {{0, -0.5, 0}, {0, 0.5, 0}, {0, 0.5, 2.1}, {0, -0.5, 2.1}};
  leaf.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int link = kLinks - 3; link < kLinks; ++link)
    meshes.push_back({leaf, link, PointLabel::kBody});
  return meshes;
}

// The arm's links wave in front of the door; frame number `frame`.
std::vector<RigidTransform> PosesAt(int frame) {
  std::vector<RigidTransform> poses;
  for (int link = 0; link + 3 < kLinks; ++link)
    poses.push_back(Translation({0.5 + 0.1 * std::sin(link + 0.1 * frame), -0.6 + 0.3 * (link % 5),
                                 0.9 + 0.35 * (link / 5)}) *
                    RotationAbout(Eigen::Vector3d::UnitX(), 0.2 * link + 0.05 * frame));
  for (int i = 0; i < 3; ++i) poses.push_back(Translation({-0.1 * i, 0.9 * (i - 1), 0}));
  return poses;
}

// The least that a depth image costs: rays in packets of 16 with prepared directions.
class BareLoop {
 public:
  BareLoop(const std::vector<VisibleMesh>& meshes, const CameraModel& camera, RayIsa isa)
      : camera_(camera), depth_(static_cast<std::size_t>(camera.width * camera.height)) {
    device_ = rtcNewDevice(("threads=1,set_affinity=0,isa=" + std::string(NameOf(isa))).c_str());
    top_ = rtcNewScene(device_);
    rtcSetSceneFlags(top_, RTC_SCENE_FLAG_DYNAMIC);
    for (const VisibleMesh& visible : meshes) AddInstance(visible.mesh);
    PrepareDirections();
  }
  ~BareLoop() {
    rtcReleaseScene(top_);
    rtcReleaseDevice(device_);
  }
  BareLoop(const BareLoop&) = delete;
  BareLoop& operator=(const BareLoop&) = delete;

  void Move(const std::vector<RigidTransform>& poses) {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      float columns[12];
      for (int k = 0; k < 12; ++k) columns[k] = static_cast<float>(poses[i].matrix()(k % 3, k / 3));
      rtcSetGeometryTransform(instances_[i], 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
      rtcCommitGeometry(instances_[i]);
    }
    rtcCommitScene(top_);
  }

  double Trace() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[16];
    std::fill_n(valid, 16, -1);
    RTCRayHit16 packet{};
    for (int lane = 0; lane < 16; ++lane) {
      packet.ray.org_x[lane] = static_cast<float>(camera_.position_m.x());
      packet.ray.org_y[lane] = static_cast<float>(camera_.position_m.y());
      packet.ray.org_z[lane] = static_cast<float>(camera_.position_m.z());
      packet.ray.mask[lane] = 0xFFFFFFFFU;
    }
    for (std::size_t first = 0; first < depth_.size(); first += 16) {
      for (std::size_t lane = 0; lane < 16; ++lane) {
        packet.ray.dir_x[lane] = x_[first + lane];
        packet.ray.dir_y[lane] = y_[first + lane];
        packet.ray.dir_z[lane] = z_[first + lane];
        packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid, top_, &context, &packet);
      std::copy_n(packet.ray.tfar, 16, depth_.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return depth_[depth_.size() / 2];
  }

 private:
  void AddInstance(const TriangleMesh& mesh) {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    for (const auto& v : mesh.vertices)
      for (const double c : v) *vertex++ = static_cast<float>(c);
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    for (const auto& t : mesh.triangles)
      for (const int i : t) *index++ = static_cast<unsigned>(i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, scene);
    rtcSetGeometryTimeStepCount(instance, 1);
    rtcCommitGeometry(instance);
    rtcAttachGeometry(top_, instance);
    instances_.push_back(instance);
    rtcReleaseGeometry(instance);
    rtcReleaseScene(scene);
  }

  void PrepareDirections() {
    const RigidTransform pose = WorldFromCamera(camera_);
    const Eigen::Matrix3d inverse = IntrinsicMatrix(camera_).inverse();
    for (int top = 0; top < camera_.height; top += 4) {
      for (int left = 0; left < camera_.width; left += 4) {
        for (int lane = 0; lane < 16; ++lane) {
          const Eigen::Vector3d d =
              pose.linear() *
              (inverse * Eigen::Vector3d(left + lane % 4 + 0.5, top + lane / 4 + 0.5, 1));
          x_.push_back(static_cast<float>(d.x()));
          y_.push_back(static_cast<float>(d.y()));
          z_.push_back(static_cast<float>(d.z()));
        }
      }
    }
  }

  CameraModel camera_;
  std::vector<float> depth_;
  std::vector<float> x_, y_, z_;
  RTCDevice device_;
  RTCScene top_;
  std::vector<RTCGeometry> instances_;
};

void MeasureCamera(const char* name, const std::vector<VisibleMesh>& meshes) {
  const CameraModel camera;
  const double rays = 1e-3 * camera.width * camera.height;  // thousands, as times are ms
  std::size_t triangles = 0;
  for (const VisibleMesh& visible : meshes) triangles += visible.mesh.triangles.size();
  std::printf("\n%s: %d links, %zu triangles, %d x %d rays\n", name, kLinks, triangles,
              camera.width, camera.height);
  for (const RayIsa isa : {RayIsa::kSse42, RayIsa::kAvx2, RayIsa::kAvx512}) {
    if (!IsSupported(isa)) continue;
    BareLoop bare(meshes, camera, isa);
    DepthCamera depth_camera(meshes, isa);
    const double move = MedianMilliseconds(200, [&](int i) { bare.Move(PosesAt(i)); });
    bare.Move(PosesAt(0));
    // In turns, so that both see the same clock and the same neighbours on the machine.
    std::vector<double> loops, renders, shares;
    for (int i = 0; i < 101; ++i) {
      loops.push_back(Milliseconds([&] { bare.Trace(); }));
      renders.push_back(Milliseconds([&] { depth_camera.Render(camera, PosesAt(0)); }));
      shares.push_back(100 * loops.back() / renders.back());
    }
    const DepthImage image = depth_camera.Render(camera, PosesAt(0));
    Sha256 digest;
    digest.Update(std::as_bytes(std::span(image.depth_m)));
    std::printf(
        "  %-7s bare loop %6.1f Mrays/s   Render %6.1f Mrays/s = %3.0f %%   "
        "re-commit %4.0f us   depth %s\n",
        std::string(NameOf(isa)).c_str(), rays / Median(loops), rays / Median(renders),
        Median(shares), 1e3 * move, digest.HexDigest().substr(0, 12).c_str());
  }
  DepthCamera standard(meshes);
  const double render = MedianMilliseconds(30, [&](int) { standard.Render(camera, PosesAt(0)); });
  std::printf("  default (%s): %.2f ms a frame\n",
              std::string(NameOf(standard.scene().isa())).c_str(), render);
  const DepthImage image = standard.Render(camera, PosesAt(0));
  const auto hits = std::count_if(image.depth_m.begin(), image.depth_m.end(),
                                  [](float depth) { return std::isfinite(depth); });
  std::printf("  %.1f %% hits\n", 0.1 * static_cast<double>(hits) / rays);
  LabelledCloud cloud;
  const double crop = MedianMilliseconds(30, [&](int) { cloud = CropCloud(image, camera); });
  const double sample = MedianMilliseconds(30, [&](int) { SampleCloud(cloud, {0, 0, 1}, {4096}); });
  std::printf("  crop %.2f ms to %zu points, sampling of 4096 %.2f ms\n", crop, cloud.label.size(),
              sample);
}

// The textbook algorithm as the peer.
std::vector<std::int32_t> PlainFarthestPoints(const std::vector<float>& xyz, int count) {
  const std::size_t size = xyz.size() / 3;
  std::vector<float> distance(size, std::numeric_limits<float>::infinity());
  std::vector<std::int32_t> taken = {0};
  while (taken.size() < static_cast<std::size_t>(count)) {
    const auto last = static_cast<std::size_t>(taken.back());
    distance[last] = -1;
    std::size_t best = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const float dx = xyz[3 * i] - xyz[3 * last];
      const float dy = xyz[3 * i + 1] - xyz[3 * last + 1];
      const float dz = xyz[3 * i + 2] - xyz[3 * last + 2];
      distance[i] = std::min(distance[i], (dx * dx + dy * dy) + dz * dz);
      if (distance[i] > distance[best]) best = i;
    }
    taken.push_back(static_cast<std::int32_t>(best));
  }
  return taken;
}

void MeasureSampling(int size, int count) {
  Rng rng(1, "cloud");
  std::vector<float> xyz;
  for (int i = 0; i < 3 * size; ++i)
    xyz.push_back(static_cast<float>((i % 3 == 2 ? 0.2 : 1.0) * rng.Uniform()));
  std::vector<std::int32_t> plain;
  const double peer = MedianMilliseconds(2, [&](int) { plain = PlainFarthestPoints(xyz, count); });
  for (const SimdLevel level : {SimdLevel::kBaseline, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level > BestSimdLevel()) continue;
    std::vector<std::int32_t> taken;
    const double time =
        MedianMilliseconds(20, [&](int) { taken = FarthestPoints(xyz, count, 0, level); });
    constexpr const char* kNames[] = {"baseline", "AVX2", "AVX-512"};
    std::printf("  %4d of %5d, %-8s %6.2f ms, %4.0f times the plain algorithm, %s indices\n", count,
                size, kNames[static_cast<int>(level)], time, peer / time,
                taken == plain ? "the same" : "DIFFERENT");
  }
}

}  // namespace
}  // namespace doorforge

int main() {
  doorforge::MeasureCamera("light scene", doorforge::MakeScene(48, 30));
  doorforge::MeasureCamera("dense scene", doorforge::MakeScene(160, 98));
  std::printf("\nfarthest point sampling\n");
  doorforge::MeasureSampling(4096, 1024);
  doorforge::MeasureSampling(50000, 4096);
  return 0;
}
