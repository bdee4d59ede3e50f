// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "doorforge/core/named_enum.h"
#include "doorforge/networks/batch_norm.h"
#include "doorforge/networks/stage_networks.h"

// How a policy was trained, as its record carries it. Here, below the room that trains, because
// those who run a policy read its record.

namespace doorforge {

/// How the learning rate goes on behind the warm-up.
enum class RateSchedule {
  kCosine,    ///< It falls along half a cosine to 1 % over all steps.
  kStep,      ///< It is multiplied with 0.9 every 5000 steps (UniDoorManip).
  kConstant,  ///< It stays.
};
inline constexpr NamedValue<RateSchedule> kRateSchedules[] = {
    {RateSchedule::kCosine, "cosine"},
    {RateSchedule::kStep, "step"},
    {RateSchedule::kConstant, "constant"}};
constexpr std::span<const NamedValue<RateSchedule>> ValuesOf(RateSchedule) {
  return kRateSchedules;
}

/// What the discriminator minimises.
enum class ScoreLoss {
  kSquared,   ///< Its score becomes the expected angle.
  kAbsolute,  ///< Its score becomes the median of the angle (UniDoorManip).
};
inline constexpr NamedValue<ScoreLoss> kScoreLosses[] = {{ScoreLoss::kSquared, "squared"},
                                                         {ScoreLoss::kAbsolute, "absolute"}};
constexpr std::span<const NamedValue<ScoreLoss>> ValuesOf(ScoreLoss) { return kScoreLosses; }

/// What decides a training run besides its samples. Two runs of equal configs on equal samples give
/// equal bytes, for any number of threads and any interruption.
struct TrainConfig {
  /// Not a setting: decides which ones there are.
  NetworkFamily family = NetworkFamily::kMotion;
  /// A stage's networks learn so long; at "grasp" the discriminator, and the affordance as long
  /// after it.
  int epochs = 10;
  int discriminator_epochs = 0;  ///< In the place of `epochs`; 0: as many. With near points an
                                 ///< epoch takes a tenth of the affordance's. At "find" the mask's,
                                 ///< called mask_epochs.
  int batch_size =
      32;  ///< UniDoorManip's released code; an epoch leaves out the last, incomplete batch.
  double learning_rate = 1e-3;
  double weight_decay = 1e-5;
  RateSchedule schedule = RateSchedule::kCosine;
  int warmup_steps = 30;         ///< The rate grows linearly over these.
  double lambda_position = 100;  ///< Times mean L1 of the position [m].
  double lambda_rotation = 5;    ///< Times the geodesic angle [rad].
  double lambda_kl = 0.02;       ///< Times the divergence, summed over latents.
  /// Weight of the same reconstruction decoded from the latent 0, which is what the policy decodes
  /// when it runs; 0 gives the plain conditional VAE.
  double prior_reconstruction = 1;
  /// True: no ReLU between the layers of the actor's branches and decoder, as released.
  bool linear_branches = false;
  ViewFrame frame = ViewFrame::kHand;
  StateKind state = StateKind::kHand;
  /// Points farther than this from point 0 are not seen [m]; 0: all are, see CloudWindow.
  double crop_radius_m = 0;
  /// CloudWindow::point_scale of every cloud.
  double point_scale = 1;
  /// The encoders read the colours of points, which the data set must have then.
  bool colors = false;
  /// With `colors`, on every step each cloud is shown in other colours than it had: hues turned,
  /// contrast lowered, brightness moved at random.
  bool augment_colors = true;
  /// The critic learns on every n-th step only; 1: on all.
  int critic_interval = 1;
  ScoreLoss score_loss = ScoreLoss::kSquared;
  /// The affordance learns from so many points of each cloud's handle, a finder from so many of
  /// each look.
  int sampled_points = 4;
  int sampled_orientations = 50;  ///< Rated by the discriminator at each of them (UniDoorManip).
  int best_orientations = 10;     ///< Whose mean rating is the affordance's target (likewise).
  double tilt_rad = 0.1;          ///< Sampled orientations lean by it, see OrientationSampling.
  /// NetworkView::near_points: the discriminator reads what lies around the fingers, told in the
  /// hand's own frame; 0: the cloud in the frame above and the grasp's numbers (UniDoorManip).
  int near_points = 256;
  /// On every step door and hand are turned together about the way into the leaf, by up to this
  /// either way [rad]; where a grasp is chosen, and in the frame "hand" only.
  double augment_roll_rad = 0;
  /// On every step each scene is shown as it is or as its mirror image, by a fair coin: a door
  /// hinged left is one hinged right then. In the frame "hand" only, and not with joints as state.
  bool augment_mirror = false;
  /// With kBatch (UniDoorManip) the encoder learns in libtorch's operators also on the device
  /// "cpu", from all points of every cloud, in one process.
  EncoderNorm encoder_norm = EncoderNorm::kNone;
  /// What computes the encoder. "cpu": this library's own kernels. "libtorch": the same network in
  /// libtorch's operators, on the processor; "cuda", "cuda:N": there. Decides the last digits, and
  /// on a GPU two equal runs may differ in them.
  std::string device = "cpu";
  double validation_share = 0.1;  ///< So much is taken off if the data set has no split "val".
  std::uint64_t seed = 1;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("epochs", self.epochs);
    visit("batch_size", self.batch_size);
    visit("learning_rate", self.learning_rate);
    visit("weight_decay", self.weight_decay);
    visit("schedule", self.schedule);
    visit("warmup_steps", self.warmup_steps);
    if (self.family == NetworkFamily::kMotion) {
      visit("lambda_position", self.lambda_position);
      visit("lambda_rotation", self.lambda_rotation);
      visit("lambda_kl", self.lambda_kl);
      visit("prior_reconstruction", self.prior_reconstruction);
      visit("linear_branches", self.linear_branches);
      visit("state", self.state);
      visit("critic_interval", self.critic_interval);
    } else if (self.family == NetworkFamily::kFind) {
      visit("mask_epochs", self.discriminator_epochs);
      visit("sampled_points", self.sampled_points);
      visit("augment_roll_rad", self.augment_roll_rad);
    } else {
      visit("discriminator_epochs", self.discriminator_epochs);
      visit("score_loss", self.score_loss);
      visit("sampled_points", self.sampled_points);
      visit("sampled_orientations", self.sampled_orientations);
      visit("best_orientations", self.best_orientations);
      visit("tilt_rad", self.tilt_rad);
      visit("near_points", self.near_points);
      visit("augment_roll_rad", self.augment_roll_rad);
    }
    visit("augment_mirror", self.augment_mirror);
    if (self.family != NetworkFamily::kFind) visit("frame", self.frame);
    visit("context_m", self.crop_radius_m);
    visit("zoom", self.point_scale);
    // records from before there was a choice stay as they are, byte by byte
    if (self.family != NetworkFamily::kFind) {
      if (!std::is_const_v<Self> || self.colors) {
        visit("colors", self.colors);
        visit("augment_colors", self.augment_colors);
      }
      visit("encoder_norm", self.encoder_norm);
      visit("device", self.device);
    }
    visit("validation_share", self.validation_share);
    visit("seed", self.seed);
  }
};

/// The settings with which the training of a stage begins, by its name or "motion" or "find". A
/// finder's mask sees 0.2 m about where the handle is guessed to be, told six times larger, and
/// learns longer than its place.
TrainConfig TrainDefaultsOf(std::string_view stage);

/// Epochs, counted from 1; 0: none, as long as nothing was validated.
struct BestEpochs {
  int actor = 0;
  int critic = 0;

  friend bool operator==(const BestEpochs&, const BestEpochs&) = default;
};

}  // namespace doorforge
