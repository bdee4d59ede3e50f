// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/handle_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/handle_points.h"
#include "doorforge/networks/heads.h"
#include "doorforge/networks/point_encoder.h"
#include "doorforge/networks/point_operators.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/schemas/stage_content.h"

namespace doorforge {
namespace {

constexpr float kLikely = 0.3F;        // a point from afar that may be a handle's
constexpr float kPlaceM = 0.15F;       // what belongs to one place
constexpr float kOfHandle = 0.5F;      // a point from near by that is a handle's
constexpr float kAboutHandleM = 0.3F;  // what of the door says which way it faces
constexpr float kInPlaneM = 0.006F;
constexpr int kPlanes = 200;
constexpr int kLooks = 2;           // from near by
constexpr std::size_t kPlaces = 3;  // that are looked at from near by
constexpr std::size_t kSurest = 20;

Eigen::Vector3f SeenAt(const std::vector<float>& xyz, std::size_t i) {
  return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
}

float Probability(float logit) { return 1.0F / (1.0F + std::exp(-logit)); }

// Says how likely the window's points that were asked for are a handle's.
std::vector<float> ProbabilitiesOf(const PointEncoder& encoder, const internal::FinderHead& head,
                                   const CloudGeometry& geometry) {
  internal::HeadInputs inputs;
  inputs.features = encoder.Forward(geometry).features;
  inputs.size = static_cast<int>(inputs.features.size()) / kFeatureSize;
  std::vector<float> probabilities = head.Score(inputs);
  std::ranges::transform(probabilities, probabilities.begin(), Probability);
  return probabilities;
}

std::vector<std::uint16_t> AllOf(std::size_t count) {
  std::vector<std::uint16_t> all(count);
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  return all;
}

// The points that may be a handle's; where none may, the one that is it likeliest.
std::vector<std::size_t> LikelyPoints(const std::vector<float>& probability) {
  std::vector<std::size_t> likely;
  for (std::size_t i = 0; i < probability.size(); ++i)
    if (probability[i] > kLikely) likely.push_back(i);
  if (likely.empty() && !probability.empty())
    likely.push_back(static_cast<std::size_t>(
        std::distance(probability.begin(), std::ranges::max_element(probability))));
  return likely;
}

// The place with the most that looks like a handle within reach of it.
Eigen::Vector3f LikeliestPlace(const std::vector<float>& xyz, const std::vector<float>& probability,
                               const std::vector<std::size_t>& likely) {
  float most = -1;
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  for (const std::size_t centre : likely) {
    float sum = 0;
    Eigen::Vector3f weighted = Eigen::Vector3f::Zero();
    for (const std::size_t i : likely) {
      if ((SeenAt(xyz, i) - SeenAt(xyz, centre)).norm() > kPlaceM) continue;
      sum += probability[i];
      weighted += probability[i] * SeenAt(xyz, i);
    }
    if (sum <= most) continue;
    most = sum;
    place = weighted / sum;
  }
  return place;
}

// Places that are apart, the likeliest first.
std::vector<Eigen::Vector3f> LikelyPlaces(const std::vector<float>& xyz,
                                          const std::vector<float>& probability) {
  std::vector<Eigen::Vector3f> places;
  std::vector<std::size_t> likely = LikelyPoints(probability);
  while (!likely.empty() && places.size() < kPlaces) {
    const Eigen::Vector3f place = LikeliestPlace(xyz, probability, likely);
    places.push_back(place);
    const std::size_t before = likely.size();
    std::erase_if(likely,
                  [&](std::size_t i) { return (SeenAt(xyz, i) - place).norm() <= 2 * kPlaceM; });
    if (likely.size() == before) break;
  }
  return places;
}

// What visible points within reach of the look take over from those of its points that were read.
class NearestOf {
 public:
  NearestOf(const std::vector<float>& xyz, const std::vector<std::size_t>& read,
            std::vector<float> probability)
      : begin_(SeenAt(xyz, 0)), probability_(std::move(probability)) {
    std::vector<float> chosen;
    for (const std::size_t i : read)
      chosen.insert(chosen.end(), xyz.begin() + static_cast<std::ptrdiff_t>(3 * i),
                    xyz.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    columns_ = ToColumns(chosen, {0, 0, 0});
  }

  float At(const Eigen::Vector3f& point) const {
    const NearestThree nearest = ThreeNearest(columns_, {point.x(), point.y(), point.z()});
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += nearest.weight.at(k) * probability_[nearest.index.at(k)];
    return sum;
  }
  const Eigen::Vector3f& begin() const { return begin_; }

  // The mean of its surest points: what is no handle has none that are as sure.
  float Sureness() const {
    std::vector<float> surest = probability_;
    const std::size_t count = std::min(surest.size(), kSurest);
    std::ranges::partial_sort(surest, surest.begin() + static_cast<std::ptrdiff_t>(count),
                              std::greater{});
    return std::accumulate(surest.begin(), surest.begin() + static_cast<std::ptrdiff_t>(count),
                           0.0F) /
           static_cast<float>(std::max(count, std::size_t{1}));
  }

 private:
  Eigen::Vector3f begin_;
  std::vector<float> probability_;
  PointColumns columns_;
};

Eigen::Vector3d Facing(const Eigen::Vector3d& normal) {
  return normal.x() > 0 ? Eigen::Vector3d(-normal) : normal;
}

int CountInPlane(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& normal,
                 float offset) {
  int count = 0;
  for (const Eigen::Vector3f& point : points)
    count += std::abs(normal.dot(point) - offset) < kInPlaneM ? 1 : 0;
  return count;
}

Eigen::Vector3d LeastSquaresNormal(const std::vector<Eigen::Vector3f>& points,
                                   const Eigen::Vector3f& normal, float offset) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const Eigen::Vector3f& single : points) {
    if (!(std::abs(normal.dot(single) - offset) < kInPlaneM)) continue;
    const Eigen::Vector3d point = single.cast<double>();
    mean += point;
    squares += point * point.transpose();
    ++count;
  }
  mean /= count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

}  // namespace

Eigen::Vector3d DominantNormal(const std::vector<Eigen::Vector3f>& points) {
  if (points.size() < 3) return -Eigen::Vector3d::UnitX();
  Rng rng(1, "finder/planes");
  const auto draw = [&] { return points[rng.Index(static_cast<std::uint32_t>(points.size()))]; };
  int most = 0;
  Eigen::Vector3f best = Eigen::Vector3f::Zero();
  float best_offset = 0;
  for (int i = 0; i < kPlanes; ++i) {
    const Eigen::Vector3f a = draw();
    const Eigen::Vector3f b = draw();
    const Eigen::Vector3f c = draw();
    const Eigen::Vector3f across = (b - a).cross(c - a);
    if (across.norm() < 1e-6F) continue;
    const Eigen::Vector3f normal = across.normalized();
    const int count = CountInPlane(points, normal, normal.dot(a));
    if (count <= most) continue;
    most = count;
    best = normal;
    best_offset = normal.dot(a);
  }
  if (most < 3) return -Eigen::Vector3d::UnitX();
  return Facing(LeastSquaresNormal(points, best, best_offset));
}

namespace {

std::vector<bool> InMask(const std::vector<float>& xyz, const NearestOf& mask, float reach_m) {
  std::vector<bool> inside(xyz.size() / 3);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Eigen::Vector3f point = SeenAt(xyz, i);
    inside[i] = (point - mask.begin()).norm() <= reach_m && mask.At(point) >= kOfHandle;
  }
  return inside;
}

std::optional<Eigen::Vector3d> MiddleOf(const std::vector<float>& xyz,
                                        const std::vector<bool>& is_handle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < is_handle.size(); ++i) {
    if (!is_handle[i]) continue;
    sum += SeenAt(xyz, i).cast<double>();
    ++count;
  }
  return count > 0 ? std::optional<Eigen::Vector3d>(sum / count) : std::nullopt;
}

std::vector<Eigen::Vector3f> BesideHandle(const std::vector<float>& xyz, const FoundHandle& found) {
  std::vector<Eigen::Vector3f> beside;
  for (std::size_t i = 0; i < found.is_handle.size(); ++i) {
    const Eigen::Vector3f point = SeenAt(xyz, i);
    if (!found.is_handle[i] && (point - found.middle_m.cast<float>()).norm() < kAboutHandleM)
      beside.push_back(point);
  }
  return beside;
}

}  // namespace

struct HandleFinder::Networks {
  explicit Networks(StageNetworks from)
      : networks(std::move(from)),
        place_encoder(networks.actor_layout(), "encoder.", networks.actor, BestInstructionSet()),
        place_head(networks.actor_layout(), networks.actor),
        mask_encoder(networks.critic_layout(), "encoder.", networks.critic, BestInstructionSet()),
        mask_head(networks.critic_layout(), networks.critic) {}

  std::vector<Eigen::Vector3f> PlacesIn(const LabelledCloud& cloud) const {
    const CloudGeometry geometry = BuildGeometry(cloud, internal::PlaceWindow(cloud.xyz),
                                                 AllOf(cloud.label.size()), BestInstructionSet());
    return LikelyPlaces(cloud.xyz, ProbabilitiesOf(place_encoder, place_head, geometry));
  }

  // Finds the place where the mask is surest of a handle.
  Eigen::Vector3d SurestOf(const std::vector<Eigen::Vector3f>& places,
                           const SampleAbout& sample) const {
    Eigen::Vector3f best = places.front();
    float most = -1;
    for (const Eigen::Vector3f& place : places) {
      if (places.size() == 1) break;
      const float sureness = MaskOf(sample(place.cast<double>(), extent_m())).Sureness();
      if (sureness <= most) continue;
      most = sureness;
      best = place;
    }
    return best.cast<double>();
  }

  NearestOf MaskOf(const LabelledCloud& cloud) const {
    const CloudWindow window = internal::GraspWindow(networks.normalisation, cloud.xyz);
    std::vector<std::size_t> all(cloud.label.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::vector<std::size_t> inside = internal::PointsInWindow(cloud.xyz, window, all);
    const std::vector<std::uint16_t> outputs(inside.begin(), inside.end());
    const CloudGeometry geometry = BuildGeometry(cloud, window, outputs, BestInstructionSet());
    return {cloud.xyz, inside, ProbabilitiesOf(mask_encoder, mask_head, geometry)};
  }

  double extent_m() const {
    return static_cast<double>(networks.normalisation.view.cloud_crop_radius_m);
  }
  float reach_m() const { return networks.normalisation.view.crop_radius_m; }

  StageNetworks networks;
  PointEncoder place_encoder;
  internal::FinderHead place_head;
  PointEncoder mask_encoder;
  internal::FinderHead mask_head;
};

HandleFinder::HandleFinder(StageNetworks networks) {
  Require(networks.family == NetworkFamily::kFind, ErrorCode::kInvalidArgument,
          "finder: the networks are those of another stage");
  networks_ = std::make_unique<const Networks>(std::move(networks));
}

HandleFinder::~HandleFinder() = default;
HandleFinder::HandleFinder(HandleFinder&&) noexcept = default;
HandleFinder& HandleFinder::operator=(HandleFinder&&) noexcept = default;

std::optional<FoundHandle> HandleFinder::Find(const LabelledCloud& visible,
                                              const SampleAbout& sample) const {
  if (visible.xyz.empty()) return std::nullopt;
  const std::vector<Eigen::Vector3f> places =
      networks_->PlacesIn(sample(SeenAt(visible.xyz, 0).cast<double>(), 0));
  FoundHandle found;
  found.middle_m = networks_->SurestOf(places, sample);
  // the first look may begin at an end of the handle, the next ones begin in its middle
  for (int look = 0; look < kLooks; ++look) {
    found.is_handle =
        InMask(visible.xyz, networks_->MaskOf(sample(found.middle_m, networks_->extent_m())),
               networks_->reach_m());
    const std::optional<Eigen::Vector3d> middle = MiddleOf(visible.xyz, found.is_handle);
    if (!middle) return std::nullopt;
    found.middle_m = *middle;
  }
  found.approach = DominantNormal(BesideHandle(visible.xyz, found));
  return found;
}

HandleFinder LoadHandleFinder(const std::filesystem::path& folder) {
  return HandleFinder(ReadPolicy(folder, kFindStage).networks);
}

namespace {

std::string_view BytesOf(const std::vector<float>& xyz, std::size_t point) {
  return {reinterpret_cast<const char*>(&xyz[3 * point]), 3 * sizeof(float)};
}

std::uint8_t LabelOf(bool is_handle) {
  return static_cast<std::uint8_t>(is_handle ? PointLabel::kHandle : PointLabel::kOther);
}

}  // namespace

std::optional<GraspAction> FindingGrasp::Choose(const GraspObservation& seen) {
  const std::optional<FoundHandle> found = finder_.Find(seen.visible, seen.sample);
  if (!found) return std::nullopt;
  GraspObservation shown = seen;
  shown.approach = found->approach;
  // points are known again by their coordinates, which sampling leaves as they are
  std::unordered_map<std::string_view, std::uint8_t> label;
  for (std::size_t i = 0; i < found->is_handle.size(); ++i) {
    shown.visible.label[i] = LabelOf(found->is_handle[i]);
    label[BytesOf(seen.visible.xyz, i)] = shown.visible.label[i];
  }
  shown.sample = [&](const Eigen::Vector3d& start, double crop_radius_m) {
    LabelledCloud cloud = seen.sample(start, crop_radius_m);
    for (std::size_t i = 0; i < cloud.label.size(); ++i) {
      const auto known = label.find(BytesOf(cloud.xyz, i));
      cloud.label[i] = known == label.end() ? LabelOf(false) : known->second;
    }
    return cloud;
  };
  return policy_->Choose(shown);
}

}  // namespace doorforge
