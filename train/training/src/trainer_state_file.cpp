// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/trainer_state_file.h"

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/network_tensors.h"
#include "doorforge/schemas/safetensors.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStateFile = "training.safetensors";
constexpr const char* kStateHash = "content_sha256";

// Calls visit(name, vector, size) for all that training needs between steps besides the weights.
template <class State, class Visit>
void VisitVectors(State& state, const Visit& visit) {
  const StageNetworks& networks = state.networks;
  const NetworkNames names = NamesOf(networks.family);
  const auto visit_network = [&](const std::string& name, const ParameterLayout& layout,
                                 auto& first, auto& second, auto& statistics) {
    visit("adam." + name + "first", first, layout.size());
    visit("adam." + name + "second", second, layout.size());
    const std::size_t outputs = InitialStatistics(layout).mean.size();
    if (outputs == 0) return;
    visit("norm." + name + "mean", statistics.mean, outputs);
    visit("norm." + name + "variance", statistics.variance, outputs);
  };
  visit_network(internal::NetworkPrefix(names.actor), networks.actor_layout(),
                state.actor_first_moment, state.actor_second_moment, state.actor_statistics);
  visit_network(internal::NetworkPrefix(names.critic), networks.critic_layout(),
                state.critic_first_moment, state.critic_second_moment, state.critic_statistics);
}

// The best networks are those of a policy, none of them where none was validated.
void AddBest(const BestNetworks& best, TensorFile& file) {
  const NetworkFamily family = best.networks.family;
  const NetworkNames names = NamesOf(family);
  if (best.epochs.actor > 0)
    internal::AddParameters(best.networks.actor_layout(),
                            "best." + internal::NetworkPrefix(names.actor), best.networks.actor,
                            MakeTensor<float>, file);
  if (best.epochs.critic > 0)
    internal::AddParameters(best.networks.critic_layout(),
                            "best." + internal::NetworkPrefix(names.critic), best.networks.critic,
                            MakeTensor<float>, file);
  file.tensors["best.epochs"] =
      MakeTensor<double>(std::vector<double>{static_cast<double>(best.epochs.actor),
                                             static_cast<double>(best.epochs.critic)},
                         {2});
}

BestNetworks ReadBest(const TensorFile& file, const std::string& path,
                      const StageNetworks& networks) {
  const NetworkNames names = NamesOf(networks.family);
  const auto epochs = ValuesOf<double>(TensorNamed(file, "best.epochs", path), {2}, path);
  BestNetworks best{{static_cast<int>(epochs[0]), static_cast<int>(epochs[1])}, networks};
  best.networks.norm = EncoderNorm::kNone;
  best.networks.actor.clear();
  best.networks.critic.clear();
  if (best.epochs.actor > 0)
    best.networks.actor = internal::ReadParameters(
        best.networks.actor_layout(), "best." + internal::NetworkPrefix(names.actor), file, path);
  if (best.epochs.critic > 0)
    best.networks.critic = internal::ReadParameters(
        best.networks.critic_layout(), "best." + internal::NetworkPrefix(names.critic), file, path);
  return best;
}

std::string ConfigText(const TrainConfig& config) { return JsonText(ToJson(config)); }

constexpr double kUnknownLoss = std::numeric_limits<double>::quiet_NaN();  // in the file

void AddLosses(const TrainerState& state, TensorFile& file) {
  const std::vector<LossColumn> columns = LossColumnsOf(state.networks.family);
  std::vector<double> steps;
  std::vector<double> epochs;
  const auto append = [&](const StageLosses& losses, std::vector<double>& out) {
    for (const LossColumn& column : columns)
      out.push_back((losses.*(column.value)).value_or(kUnknownLoss));
  };
  for (const StageLosses& losses : state.steps) append(losses, steps);
  for (const EpochLosses& epoch : state.epochs) {
    append(epoch.train, epochs);
    append(epoch.validation, epochs);
  }
  file.tensors["losses.steps"] = MakeTensor<double>(steps, {state.steps.size(), columns.size()});
  file.tensors["losses.epochs"] =
      MakeTensor<double>(epochs, {state.epochs.size(), 2, columns.size()});
}

// Length of the leading axis of a tensor that is checked in full right after.
std::uint64_t LengthOf(const Tensor& tensor) { return tensor.shape.empty() ? 0 : tensor.shape[0]; }

void ReadLosses(const TensorFile& file, const std::string& path, TrainerState& state) {
  const std::vector<LossColumn> columns = LossColumnsOf(state.networks.family);
  const Tensor& steps = TensorNamed(file, "losses.steps", path);
  const Tensor& epochs = TensorNamed(file, "losses.epochs", path);
  const auto of_steps = ValuesOf<double>(steps, {LengthOf(steps), columns.size()}, path);
  const auto of_epochs = ValuesOf<double>(epochs, {LengthOf(epochs), 2, columns.size()}, path);
  const auto losses_at = [&](const std::vector<double>& values, std::size_t row) {
    StageLosses losses;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = values[row * columns.size() + i];
      if (!std::isnan(value)) losses.*(columns[i].value) = value;
    }
    return losses;
  };
  for (std::size_t i = 0; i < LengthOf(steps); ++i) state.steps.push_back(losses_at(of_steps, i));
  for (std::size_t i = 0; i < LengthOf(epochs); ++i)
    state.epochs.push_back({losses_at(of_epochs, 2 * i), losses_at(of_epochs, 2 * i + 1)});
}

const std::string& MetadataOf(const TensorFile& file, const std::string& key,
                              const std::string& path) {
  const auto found = file.metadata.find(key);
  if (found == file.metadata.end())
    throw Error(ErrorCode::kFormat, path + ": lacks the metadata \"" + key + "\"");
  return found->second;
}

// It covers all that the file holds but itself: a training that goes on from a damaged number would
// end in a policy that nobody can tell from a sound one.
std::string StateHash(const TensorFile& file) {
  Sha256 hash;
  const auto add = [&](const std::string& text) {
    hash.Update(std::to_string(text.size()) + ":");
    hash.Update(text);
  };
  for (const auto& [name, tensor] : file.tensors) {
    add(name);
    add(std::to_string(static_cast<int>(tensor.type)));
    for (const std::uint64_t length : tensor.shape) add(std::to_string(length));
    add(tensor.bytes);
  }
  for (const auto& [key, text] : file.metadata) {
    if (key == kStateHash) continue;
    add(key);
    add(text);
  }
  return hash.HexDigest();
}

// A training goes on only from what it would have come to by itself.
void RequireSameTraining(const TensorFile& file, const PolicyProvenance& given,
                         const std::string& path) {
  const auto refuse = [&](const std::string& what, const std::string& difference) {
    throw Error(ErrorCode::kInvalidArgument,
                path + ": " + what +
                    "; give what is recorded to go on, --overwrite to begin anew, or another "
                    "--out, there with --from " +
                    fs::path(path).parent_path().string() + " to begin with these weights" +
                    difference);
  };
  const std::string& config = MetadataOf(file, "config", path);
  if (config != ConfigText(given.config))
    refuse("this training has other settings", ConfigDifference(config, ConfigText(given.config)));
  const std::string& data = MetadataOf(file, "dataset_sha256", path);
  if (data != given.dataset_sha256)
    refuse("this training has other data than --data",
           "\n  sha256: recorded " + data + ", given " + given.dataset_sha256);
  const std::string& from = MetadataOf(file, "from_weights_sha256", path);
  const auto weights = [](const std::string& sha256) {
    return sha256.empty() ? "none" : "those of sha256 " + sha256;
  };
  if (from != given.from_weights_sha256)
    refuse(
        "this training began with other weights than --from says",
        "\n  weights: recorded " + weights(from) + ", given " + weights(given.from_weights_sha256));
}

}  // namespace

void WriteTrainerState(const fs::path& folder, const TrainerState& state,
                       const PolicyProvenance& provenance) {
  TensorFile file = internal::WeightsOf(state.networks, MakeTensor<float>);
  VisitVectors(state, [&](const std::string& name, const auto& values, std::size_t size) {
    file.tensors[name] = MakeTensor<float>(values, {size});
  });
  AddLosses(state, file);
  AddBest(state.best, file);
  file.metadata = {{"config", ConfigText(provenance.config)},
                   {"dataset_sha256", provenance.dataset_sha256},
                   {"from_weights_sha256", provenance.from_weights_sha256},
                   {"normalisation", JsonText(NormalisationToJson(state.networks.normalisation))},
                   {"step", std::to_string(state.step)}};
  file.metadata[kStateHash] = StateHash(file);
  CommitFile(folder / kStateFile, EncodeTensors(file));
}

bool HasTrainerState(const fs::path& folder) { return fs::exists(folder / kStateFile); }

TrainerState ReadTrainerState(const fs::path& folder, const PolicyProvenance& expected) {
  const std::string path = (folder / kStateFile).string();
  const TensorFile file = ReadTensors(path);
  if (MetadataOf(file, kStateHash, path) != StateHash(file))
    throw Error(ErrorCode::kFormat,
                path +
                    ": damaged: its content is not what its own SHA-256 says; put back a copy, or "
                    "train again with --overwrite");
  RequireSameTraining(file, expected, path);
  TrainerState state;
  state.networks.family = FamilyOf(expected.stage);
  state.networks.linear_branches = expected.config.linear_branches;
  state.networks.norm = expected.config.encoder_norm;
  internal::ReadWeights(file, path, state.networks);
  VisitVectors(state, [&](const std::string& name, auto& values, std::size_t size) {
    values = ValuesOf<float>(TensorNamed(file, name, path), {size}, path);
  });
  ReadLosses(file, path, state);
  const Json normalisation =
      ParseJson(MetadataOf(file, "normalisation", path), path + ": normalisation");
  state.networks.normalisation = NormalisationFromJson(normalisation, path + ": normalisation");
  state.best = ReadBest(file, path, state.networks);
  state.step = state.steps.size();
  if (MetadataOf(file, "step", path) != std::to_string(state.step))
    throw Error(ErrorCode::kFormat, path + ": its losses and its step do not agree");
  return state;
}

}  // namespace doorforge
