// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/networks/batch_norm.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/parameters.h"
#include "doorforge/networks/training_sample.h"

namespace doorforge {

inline constexpr int kLatentSize = 128;
/// Points farther than this from the contact are not among the nearest, NetworkView::near_points:
/// the hand's reach to either side.
inline constexpr float kNearRadius = 0.12F;  // [m]

/// Mean and standard deviation of the training set, component by component. Deviations have a lower
/// bound, so that what hardly varied in training is not blown up later.
template <std::size_t N>
struct Normaliser {
  std::array<float, N> mean{};
  std::array<float, N> deviation{};

  std::array<float, N> Apply(const std::array<float, N>& value) const {
    std::array<float, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = (value[i] - mean[i]) / deviation[i];
    return out;
  }
};

/// How the networks are told where things are. kHand: clouds relative to the hand's position and
/// the hand's turn from its present rotation, both along the world's axes, so that what was learned
/// at one height and distance holds at others; where a grasp is chosen, clouds and contact points
/// relative to the cloud's point 0. kWorld: one centre for all clouds and absolute rotations, as
/// UniDoorManip.
enum class ViewFrame { kHand, kWorld };
inline constexpr NamedValue<ViewFrame> kViewFrames[] = {{ViewFrame::kHand, "hand"},
                                                        {ViewFrame::kWorld, "world"}};
constexpr std::span<const NamedValue<ViewFrame>> ValuesOf(ViewFrame) { return kViewFrames; }

/// What the motion networks are told of the robot itself, 18 numbers. kHand: rows 1 and 2 of the
/// hand's rotation and both finger openings, the way that the motion is to take (0 the usual, 1 the
/// other), the rest 0; like the hand's frame it does not depend on where the door stands. kJoints:
/// nine positions and nine velocities, as UniDoorManip. kNone: 18 times 0. kGripper: the hand's z
/// axis, the six different numbers of y y^T of its y axis (xx, yy, zz, xy, xz, yz), the fingers'
/// mean opening, the rest as kHand. Half a turn of the hand about its z changes nothing of a
/// parallel gripper, and nothing of these numbers: which of both ways an arm reaches a handle does
/// not matter then, and the mirror image of a hand is a hand.
enum class StateKind { kHand, kJoints, kNone, kGripper };
inline constexpr NamedValue<StateKind> kStateKinds[] = {{StateKind::kHand, "hand"},
                                                        {StateKind::kJoints, "joints"},
                                                        {StateKind::kNone, "none"},
                                                        {StateKind::kGripper, "gripper"}};
constexpr std::span<const NamedValue<StateKind>> ValuesOf(StateKind) { return kStateKinds; }
PolicyState StateOf(StateKind kind, const Proprioception& proprioception,
                    MotionWay way = MotionWay::kUsual);

/// How the networks are told of the scene. Default: as UniDoorManip. A grasp has no state.
struct NetworkView {
  ViewFrame frame = ViewFrame::kWorld;
  StateKind state = StateKind::kJoints;
  float crop_radius_m = 0;        ///< CloudWindow::crop_radius_m of every cloud.
  float point_scale = 1;          ///< CloudWindow::point_scale of every cloud.
  float cloud_crop_radius_m = 0;  ///< TrainingSample::cloud_crop_radius_m of what was learned from.
  int remembered_finer = 0;       ///< TrainingSample::remembered_finer of what was learned from.
  /// Where a grasp is chosen: how many of the points nearest to the contact the discriminator
  /// reads, in the hand's own frame, instead of the cloud and the rotation; 0: those, as
  /// UniDoorManip.
  int near_points = 0;
  bool colors = false;  ///< The encoders read the colours of points.

  friend bool operator==(const NetworkView&, const NetworkView&) = default;
};

/// Constants between the world's numbers and the networks'. Part of a checkpoint.
struct StageNormalisation {
  NetworkView view;
  /// Subtracted from every cloud, in the hand's frame after the hand's position; the scale stays
  /// metres.
  std::array<float, 3> cloud_centre_m{};
  Normaliser<18> state;
  Normaliser<9> action;  ///< Position or contact point [m], then the six rotation numbers.
  Normaliser<3> hand_m;
  Normaliser<3> base_m;
  Normaliser<1> angle_gain_rad;
};

/// In the hand's frame the samples' actions must be turns already.
///
/// @throws Error(kInvalidArgument) if there is no sample.
StageNormalisation MeasureNormalisation(std::span<const TrainingSample> samples,
                                        const NetworkView& view = {});
/// Whether the networks have learned both ways that a motion may take: they are told then which one
/// to take, and whoever uses them has to find out which one is the door's.
bool KnowsBothWays(const StageNormalisation& normalisation);
/// What they are told instead of `way` where they have learned one way alone: that one.
MotionWay WayThatIsKnown(const StageNormalisation& normalisation, MotionWay way);
/// Returns that of a cloud that is seen with the hand, or its own point 0, there.
CloudWindow WindowOf(const StageNormalisation& normalisation,
                     const std::array<float, 3>& hand_or_point_m);
nlohmann::ordered_json NormalisationToJson(const StageNormalisation& normalisation);
/// Throws Error(kFormat), naming `path`.
StageNormalisation NormalisationFromJson(const nlohmann::ordered_json& json,
                                         const std::string& path);

/// Which networks a stage has. Each stage has one that proposes and one that judges: actor and
/// critic where the hand is moved, affordance and discriminator where a grasp is chosen
/// (UniDoorManip, Section 4); where a handle is found, one that says where on the door it is and
/// one that says, seen from near by, which points are its.
enum class NetworkFamily { kMotion, kGrasp, kFind };
NetworkFamily FamilyOf(std::string_view stage);

/// What files call the two: "actor" and "critic", "affordance" and "discriminator", or "place" and
/// "mask".
struct NetworkNames {
  const char* actor;
  const char* critic;
};
NetworkNames NamesOf(NetworkFamily family);

/// The actor: encoder ("encoder.*") and conditional VAE (UniDoorManip's table): action
/// 9-128-128-64, state 18-128-128-64, posterior 256-128-128 -> mean and log-variance of 128
/// latents, decoder 320-512-256-9. The affordance: encoder, contact point 3-128-128-128, score
/// 256-128-1. The place: encoder of EncoderWidth::kNarrow, score 128-64-1.
const ParameterLayout& ActorLayout(NetworkFamily family = NetworkFamily::kMotion,
                                   EncoderKind kind = {});

/// The critic: encoder of its own, state 18-128-128-64, action 9-128-128-64, hand and base position
/// 3-128-128-64 each, score 384-256-128-1. The discriminator: encoder and action 9-128-128-128, or
/// near points 3-64-64-128 and their maximum (as Liang et al. 2019), the other 0; score 384-128-1.
/// The mask: as the place.
const ParameterLayout& CriticLayout(NetworkFamily family = NetworkFamily::kMotion,
                                    EncoderKind kind = {});

/// The trained values of both networks, each a flat vector of its layout.
struct StageNetworks {
  StageNormalisation normalisation;
  bool linear_branches = false;  ///< See TrainConfig.
  std::vector<float> actor;      ///< At "grasp" the affordance, at "find" the place.
  std::vector<float> critic;     ///< At "grasp" the discriminator, at "find" the mask.
  NetworkFamily family = NetworkFamily::kMotion;
  EncoderNorm norm = EncoderNorm::kNone;  ///< kBatch in training alone, see PolicyOf().

  EncoderKind encoder() const { return {norm, normalisation.view.colors}; }
  const ParameterLayout& actor_layout() const { return ActorLayout(family, encoder()); }
  const ParameterLayout& critic_layout() const { return CriticLayout(family, encoder()); }
};

/// He initialisation; layers that give results start at a tenth of it, so training starts near the
/// mean of the training set; normalisations scale by 1 and shift by 0.
StageNetworks InitialNetworks(const StageNormalisation& normalisation, bool linear_branches,
                              std::uint64_t seed, NetworkFamily family = NetworkFamily::kMotion,
                              EncoderNorm norm = EncoderNorm::kNone);

}  // namespace doorforge
