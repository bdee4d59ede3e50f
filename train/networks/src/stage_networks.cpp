// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/stage_networks.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/point_encoder.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWayNumber = 17;  // of the states kHand and kGripper
constexpr float kResultScale = 0.1F;
constexpr float kNearScale =
    0.4F;  // the largest of 256 points is several deviations above the mean

void AddBranch(const std::string& name, std::initializer_list<int> sizes, ParameterLayout& layout) {
  std::size_t i = 0;
  for (const int* size = sizes.begin(); size + 1 != sizes.end(); ++size, ++i)
    layout.Add(name + "." + std::to_string(i), size[0], size[1]);
}

// The order of the layers is that of the numbers in policies on disk. Sizes of actor and critic are
// UniDoorManip's.
ParameterLayout MakeActorLayout(EncoderKind kind) {
  ParameterLayout layout;
  AddEncoderLayers("encoder.", layout, kind);
  AddBranch("action", {9, 128, 128, 64}, layout);
  AddBranch("state", {18, 128, 128, 64}, layout);
  AddBranch("posterior", {kFeatureSize + 128, 128, 128}, layout);
  layout.Add("mean", 128, kLatentSize);
  layout.Add("log_variance", 128, kLatentSize);
  AddBranch("decoder", {kLatentSize + kFeatureSize + 64, 512, 256, 9}, layout);
  return layout;
}

ParameterLayout MakeCriticLayout(EncoderKind kind) {
  ParameterLayout layout;
  AddEncoderLayers("encoder.", layout, kind);
  AddBranch("state", {18, 128, 128, 64}, layout);
  AddBranch("action", {9, 128, 128, 64}, layout);
  AddBranch("hand", {3, 128, 128, 64}, layout);
  AddBranch("base", {3, 128, 128, 64}, layout);
  AddBranch("score", {kFeatureSize + 4 * 64, 256, 128, 1}, layout);
  return layout;
}

ParameterLayout MakeAffordanceLayout(EncoderKind kind) {
  ParameterLayout layout;
  AddEncoderLayers("encoder.", layout, kind);
  AddBranch("point", {3, 128, 128, 128}, layout);
  AddBranch("score", {kFeatureSize + 128, 128, 1}, layout);
  return layout;
}

ParameterLayout MakeDiscriminatorLayout(EncoderKind kind) {
  ParameterLayout layout;
  AddEncoderLayers("encoder.", layout, kind);
  AddBranch("action", {9, 128, 128, 128}, layout);
  AddBranch("near", {3, 64, 64, 128}, layout);
  AddBranch("score", {kFeatureSize + 128 + 128, 128, 1}, layout);
  return layout;
}

ParameterLayout MakeFinderLayout(EncoderKind kind) {
  kind.width = EncoderWidth::kNarrow;
  ParameterLayout layout;
  AddEncoderLayers("encoder.", layout, kind);
  AddBranch("score", {kFeatureSize, 64, 1}, layout);
  return layout;
}

using LayoutsByKind = std::array<ParameterLayout, 4>;

LayoutsByKind OfAllKinds(ParameterLayout (*make)(EncoderKind)) {
  return {make({EncoderNorm::kNone, false}), make({EncoderNorm::kBatch, false}),
          make({EncoderNorm::kNone, true}), make({EncoderNorm::kBatch, true})};
}

std::size_t IndexOf(EncoderKind kind) {
  return static_cast<std::size_t>(kind.norm) + (kind.colors ? 2 : 0);
}

// What gives a result begins near 0, so that an untrained network answers with about the mean of
// the data; a scale of batch normalisation begins at 1.
std::vector<float> Initial(const ParameterLayout& layout, std::uint64_t seed,
                           const std::string& prefix) {
  std::vector<float> parameters = HeInitialisation(layout, seed, prefix);
  for (const DenseLayer& layer : layout.layers()) {
    const bool gives_result = &layer == &layout.layers().back();
    const bool near = layer.name.starts_with("near.");
    if (layer.name != "mean" && layer.name != "log_variance" && !gives_result && !near) continue;
    const float scale = near ? kNearScale : kResultScale;
    for (std::size_t i = layer.offset; i < layer.bias_offset(); ++i) parameters[i] *= scale;
  }
  for (std::size_t i = 0; i < layout.layers().size(); ++i) {
    const DenseLayer* norm = NormBehind(layout, i);
    if (norm != nullptr)
      std::fill_n(parameters.begin() + static_cast<std::ptrdiff_t>(norm->offset),
                  norm->weight_count(), 1.0F);
  }
  return parameters;
}

// `value(sample)` gives the array to measure. `least` is the lower bound of each deviation: a
// number that hardly varies in the data would otherwise be told in units of its noise. Two passes,
// since the difference of two large sums has no digits left.
template <std::size_t N, class Value>
Normaliser<N> Measure(std::span<const TrainingSample> samples, const std::array<float, N>& least,
                      const Value& value) {
  Normaliser<N> normaliser;
  const auto count = static_cast<double>(samples.size());
  for (std::size_t i = 0; i < N; ++i) {
    double sum = 0;
    for (const TrainingSample& sample : samples) sum += value(sample)[i];
    const double mean = sum / count;
    double squares = 0;
    for (const TrainingSample& sample : samples) {
      const double difference = value(sample)[i] - mean;
      squares += difference * difference;
    }
    normaliser.mean[i] = static_cast<float>(mean);
    normaliser.deviation[i] = std::max(static_cast<float>(std::sqrt(squares / count)), least[i]);
  }
  return normaliser;
}

std::array<float, 3> ToArray(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

template <std::size_t N>
constexpr std::array<float, N> Filled(float value) {
  std::array<float, N> array{};
  array.fill(value);
  return array;
}

// In double precision: a data set has hundreds of millions of points.
std::array<float, 3> MeanPoint(std::span<const TrainingSample> samples) {
  std::array<double, 3> sum{};
  double count = 0;
  for (const TrainingSample& sample : samples) {
    std::vector<float> mirrored;
    const std::span<const float> cloud = ShownCloud(sample, mirrored);
    for (std::size_t i = 0; i < cloud.size(); ++i) sum[i % 3] += cloud[i];
    const std::size_t points = cloud.size() / 3;
    count += static_cast<double>(points);
  }
  std::array<float, 3> mean{};
  for (std::size_t i = 0; i < 3; ++i) mean[i] = static_cast<float>(sum[i] / count);
  return mean;
}

template <std::size_t N>
std::array<float, N> ArrayFromJson(const Json& json, const std::string& path) {
  const auto refuse = [&] {
    throw Error(ErrorCode::kFormat,
                path + ": expected an array of " + std::to_string(N) + " finite numbers");
  };
  if (!json.is_array() || json.size() != N) refuse();
  std::array<float, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number()) refuse();
    values[i] = json[i].get<float>();
    if (!std::isfinite(values[i])) refuse();
  }
  return values;
}

template <std::size_t N>
Json NormaliserToJson(const Normaliser<N>& normaliser) {
  return {{"mean", normaliser.mean}, {"deviation", normaliser.deviation}};
}

template <std::size_t N>
Normaliser<N> NormaliserFromJson(const Json& parent, const std::string& key,
                                 const std::string& path) {
  const Json& json = MemberOf(parent, key, path);
  const std::string inner = path + "." + key;
  Normaliser<N> normaliser{
      ArrayFromJson<N>(MemberOf(json, "mean", inner), inner + ".mean"),
      ArrayFromJson<N>(MemberOf(json, "deviation", inner), inner + ".deviation")};
  for (const float deviation : normaliser.deviation) {
    if (deviation <= 0) throw Error(ErrorCode::kFormat, inner + ".deviation: must be positive");
  }
  return normaliser;
}

template <class Kind>
Kind NamedKind(const Json& json, const char* key, std::initializer_list<Kind> kinds,
               const std::string& path) {
  const auto name = ValueOf<std::string>(json, key, path);
  for (const Kind kind : kinds) {
    if (NameOf(kind) == name) return kind;
  }
  throw Error(ErrorCode::kFormat,
              path + "." + key + ": \"" + name + "\" is not known to this build");
}

// What the records of earlier builds lack is as the default.
NetworkView ViewFromJson(const Json& json, const std::string& path) {
  NetworkView view;
  if (json.contains("frame"))
    view.frame = NamedKind(json, "frame", {ViewFrame::kHand, ViewFrame::kWorld}, path);
  if (json.contains("state_of"))
    view.state = NamedKind(
        json, "state_of",
        {StateKind::kHand, StateKind::kJoints, StateKind::kNone, StateKind::kGripper}, path);
  if (json.contains("context_m"))
    view.crop_radius_m = static_cast<float>(ValueOf<double>(json, "context_m", path));
  if (json.contains("zoom"))
    view.point_scale = static_cast<float>(ValueOf<double>(json, "zoom", path));
  if (json.contains("cloud_within_m"))
    view.cloud_crop_radius_m = static_cast<float>(ValueOf<double>(json, "cloud_within_m", path));
  if (json.contains("remembered_finer"))
    view.remembered_finer = ValueOf<int>(json, "remembered_finer", path);
  if (json.contains("near_points")) view.near_points = ValueOf<int>(json, "near_points", path);
  if (json.contains("colors")) view.colors = ValueOf<bool>(json, "colors", path);
  Require(!view.colors || (json.contains("color_scale") &&
                           ValueOf<double>(json, "color_scale", path) == kColorScale),
          ErrorCode::kFormat,
          path +
              ".color_scale: this policy was trained by a build that showed colours to the "
              "encoders on another scale; train it again");
  return view;
}

}  // namespace

namespace {

// Six numbers of a rotation: its first two rows, from which the third follows without a jump.
void TellHand(const Proprioception& proprioception, PolicyState& state) {
  const Eigen::Matrix3f world_from_hand = HandRotationOf(proprioception).cast<float>();
  const Eigen::Vector2f fingers = FingerOpeningsOf(proprioception);
  for (std::size_t i = 0; i < 6; ++i)
    state[i] = world_from_hand(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
  for (std::size_t i = 0; i < 2; ++i) state[6 + i] = fingers[static_cast<Eigen::Index>(i)];
}

// The hand's y axis enters by its products, which are the same when the fingers change places: a
// gripper turned by half a turn about its approach is the same gripper.
void TellGripper(const Proprioception& proprioception, PolicyState& state) {
  const Eigen::Matrix3f world_from_hand = HandRotationOf(proprioception).cast<float>();
  const Eigen::Vector3f z = world_from_hand.col(2);
  const Eigen::Vector3f y = world_from_hand.col(1);
  const std::array numbers{z.x(),         z.y(),
                           z.z(),         y.x() * y.x(),
                           y.y() * y.y(), y.z() * y.z(),
                           y.x() * y.y(), y.x() * y.z(),
                           y.y() * y.z(), FingerOpeningsOf(proprioception).mean()};
  std::ranges::copy(numbers, state.begin());
}

bool TellsOfTheHand(StateKind kind) {
  return kind == StateKind::kHand || kind == StateKind::kGripper;
}

}  // namespace

PolicyState StateOf(StateKind kind, const Proprioception& proprioception, MotionWay way) {
  if (kind == StateKind::kJoints) return PolicyStateOf(proprioception);
  PolicyState state{};
  if (kind == StateKind::kNone) return state;
  if (kind == StateKind::kHand) TellHand(proprioception, state);
  if (kind == StateKind::kGripper) TellGripper(proprioception, state);
  state[kWayNumber] = way == MotionWay::kOther ? 1.0F : 0.0F;
  return state;
}

bool KnowsBothWays(const StageNormalisation& normalisation) {
  const float others = normalisation.state.mean[kWayNumber];
  return TellsOfTheHand(normalisation.view.state) && others > 0 && others < 1;
}

MotionWay WayThatIsKnown(const StageNormalisation& normalisation, MotionWay way) {
  if (KnowsBothWays(normalisation)) return way;
  return normalisation.state.mean[kWayNumber] > 0 ? MotionWay::kOther : MotionWay::kUsual;
}

CloudWindow WindowOf(const StageNormalisation& normalisation,
                     const std::array<float, 3>& hand_or_point_m) {
  CloudWindow window{normalisation.cloud_centre_m, normalisation.view.crop_radius_m,
                     normalisation.view.point_scale};
  if (normalisation.view.frame == ViewFrame::kHand) {
    for (std::size_t k = 0; k < 3; ++k) window.centre[k] += hand_or_point_m[k];
  }
  return window;
}

StageNormalisation MeasureNormalisation(std::span<const TrainingSample> samples,
                                        const NetworkView& view) {
  Require(!samples.empty(), ErrorCode::kInvalidArgument, "no sample to train from");
  // the least deviations: half a centimetre, 3 degrees
  constexpr float kPosition = 0.005F;
  constexpr float kRotation = 0.05F;
  StageNormalisation normalisation;
  normalisation.view = view;
  // in the hand's frame clouds have the hand in their middle already
  if (view.frame == ViewFrame::kWorld) normalisation.cloud_centre_m = MeanPoint(samples);
  normalisation.state = Measure<18>(
      samples, Filled<18>(TellsOfTheHand(view.state) ? 0.005F : 0.02F),
      [&](const TrainingSample& s) { return StateOf(view.state, s.proprioception, s.way); });
  normalisation.action = Measure<9>(samples,
                                    {kPosition, kPosition, kPosition, kRotation, kRotation,
                                     kRotation, kRotation, kRotation, kRotation},
                                    [](const TrainingSample& s) { return s.action; });
  normalisation.hand_m = Measure<3>(samples, Filled<3>(0.02F), [](const TrainingSample& s) {
    return ToArray(HandPositionOf(s.proprioception));
  });
  normalisation.base_m = Measure<3>(samples, Filled<3>(0.02F), [](const TrainingSample& s) {
    return ToArray(BasePositionOf(s.proprioception));
  });
  normalisation.angle_gain_rad = Measure<1>(samples, {0.005F}, [](const TrainingSample& s) {
    return std::array<float, 1>{s.angle_gain_rad};
  });
  return normalisation;
}

Json NormalisationToJson(const StageNormalisation& normalisation) {
  Json json{{"frame", NameOf(normalisation.view.frame)},
            {"state_of", NameOf(normalisation.view.state)},
            {"context_m", normalisation.view.crop_radius_m},
            {"zoom", normalisation.view.point_scale},
            {"cloud_within_m", normalisation.view.cloud_crop_radius_m},
            {"remembered_finer", normalisation.view.remembered_finer},
            {"near_points", normalisation.view.near_points},
            {"cloud_centre_m", normalisation.cloud_centre_m},
            {"cloud_scale", 1},
            {"state", NormaliserToJson(normalisation.state)},
            {"action", NormaliserToJson(normalisation.action)},
            {"hand_m", NormaliserToJson(normalisation.hand_m)},
            {"base_m", NormaliserToJson(normalisation.base_m)},
            {"score_rad", NormaliserToJson(normalisation.angle_gain_rad)}};
  if (normalisation.view.colors) {  // others are as from before there was a choice
    json["colors"] = true;
    json["color_scale"] = kColorScale;
  }
  return json;
}

StageNormalisation NormalisationFromJson(const Json& json, const std::string& path) {
  StageNormalisation normalisation;
  normalisation.view = ViewFromJson(json, path);
  normalisation.cloud_centre_m =
      ArrayFromJson<3>(MemberOf(json, "cloud_centre_m", path), path + ".cloud_centre_m");
  normalisation.state = NormaliserFromJson<18>(json, "state", path);
  normalisation.action = NormaliserFromJson<9>(json, "action", path);
  normalisation.hand_m = NormaliserFromJson<3>(json, "hand_m", path);
  normalisation.base_m = NormaliserFromJson<3>(json, "base_m", path);
  normalisation.angle_gain_rad = NormaliserFromJson<1>(json, "score_rad", path);
  return normalisation;
}

NetworkFamily FamilyOf(std::string_view stage) {
  if (stage == "find") return NetworkFamily::kFind;
  return stage == "grasp" ? NetworkFamily::kGrasp : NetworkFamily::kMotion;
}

NetworkNames NamesOf(NetworkFamily family) {
  if (family == NetworkFamily::kFind) return {"place", "mask"};
  return family == NetworkFamily::kGrasp ? NetworkNames{"affordance", "discriminator"}
                                         : NetworkNames{"actor", "critic"};
}

namespace {

// Its two networks are alike.
const ParameterLayout& FinderLayout(EncoderKind kind) {
  static const LayoutsByKind kFinder = OfAllKinds(MakeFinderLayout);
  return kFinder.at(IndexOf(kind));
}

}  // namespace

// Made once: whoever reads a policy asks for them at every layer.
const ParameterLayout& ActorLayout(NetworkFamily family, EncoderKind kind) {
  static const LayoutsByKind kActor = OfAllKinds(MakeActorLayout);
  static const LayoutsByKind kAffordance = OfAllKinds(MakeAffordanceLayout);
  if (family == NetworkFamily::kFind) return FinderLayout(kind);
  const LayoutsByKind& layouts = family == NetworkFamily::kGrasp ? kAffordance : kActor;
  return layouts.at(IndexOf(kind));
}

const ParameterLayout& CriticLayout(NetworkFamily family, EncoderKind kind) {
  static const LayoutsByKind kCritic = OfAllKinds(MakeCriticLayout);
  static const LayoutsByKind kDiscriminator = OfAllKinds(MakeDiscriminatorLayout);
  if (family == NetworkFamily::kFind) return FinderLayout(kind);
  const LayoutsByKind& layouts = family == NetworkFamily::kGrasp ? kDiscriminator : kCritic;
  return layouts.at(IndexOf(kind));
}

StageNetworks InitialNetworks(const StageNormalisation& normalisation, bool linear_branches,
                              std::uint64_t seed, NetworkFamily family, EncoderNorm norm) {
  const NetworkNames names = NamesOf(family);
  const EncoderKind kind{norm, normalisation.view.colors};
  return {normalisation,
          linear_branches,
          Initial(ActorLayout(family, kind), seed, std::string(names.actor) + "."),
          Initial(CriticLayout(family, kind), seed, std::string(names.critic) + "."),
          family,
          norm};
}

}  // namespace doorforge
