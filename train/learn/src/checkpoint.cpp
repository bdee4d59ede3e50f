// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/learn/checkpoint.h"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/json_numbers.h"
#include "doorforge/learn/cloud_geometry.h"
#include "doorforge/learn/event_log.h"
#include "doorforge/learn/point_encoder.h"
#include "doorforge/schemas/safetensors.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kWeightsFile = "policy.safetensors";
constexpr const char* kRecordFile = "policy.json";
constexpr const char* kStateFile = "training.safetensors";
constexpr const char* kStateHash = "content_sha256";
constexpr const char* kLossesFile = "losses.json";
constexpr int kLossesSchemaVersion = 1;

using MakeFloats = Tensor (*)(std::span<const float>, std::vector<std::uint64_t>);

// Every layer's weight and bias under its own name.
void AddParameters(const ParameterLayout& layout, const std::string& prefix,
                   const std::vector<float>& parameters, MakeFloats make, TensorFile& file) {
  for (const DenseLayer& layer : layout.layers()) {
    const auto slice = [&](std::size_t begin, std::size_t count) {
      return std::span<const float>(parameters).subspan(begin, count);
    };
    const auto outputs = static_cast<std::uint64_t>(layer.outputs);
    file.tensors[prefix + layer.name + ".weight"] =
        make(slice(layer.offset, layer.weight_count()),
             {outputs, static_cast<std::uint64_t>(layer.inputs)});
    file.tensors[prefix + layer.name + ".bias"] =
        make(slice(layer.bias_offset(), outputs), {outputs});
  }
}

std::vector<float> ReadParameters(const ParameterLayout& layout, const std::string& prefix,
                                  const TensorFile& file, const std::string& path) {
  std::vector<float> parameters;
  parameters.reserve(layout.size());
  const auto append = [&](const std::string& name, const std::vector<std::uint64_t>& shape) {
    const std::string where = path + ": " + name;
    for (const float value : FloatsOf(TensorNamed(file, name, path), shape, where)) {
      if (!std::isfinite(value))
        throw Error(ErrorCode::kFormat, where + ": holds a number that is not finite");
      parameters.push_back(value);
    }
  };
  for (const DenseLayer& layer : layout.layers()) {
    const auto outputs = static_cast<std::uint64_t>(layer.outputs);
    append(prefix + layer.name + ".weight", {outputs, static_cast<std::uint64_t>(layer.inputs)});
    append(prefix + layer.name + ".bias", {outputs});
  }
  return parameters;
}

std::string Prefix(const char* network) { return std::string(network) + "."; }

TensorFile WeightsOf(const StageNetworks& networks, MakeFloats make) {
  TensorFile file;
  const NetworkNames names = NamesOf(networks.family);
  AddParameters(ActorLayout(networks.family, networks.norm), Prefix(names.actor), networks.actor,
                make, file);
  AddParameters(CriticLayout(networks.family, networks.norm), Prefix(names.critic), networks.critic,
                make, file);
  return file;
}

void ReadWeights(const TensorFile& file, const std::string& path, StageNetworks& networks) {
  const NetworkNames names = NamesOf(networks.family);
  networks.actor =
      ReadParameters(ActorLayout(networks.family, networks.norm), Prefix(names.actor), file, path);
  networks.critic = ReadParameters(CriticLayout(networks.family, networks.norm),
                                   Prefix(names.critic), file, path);
}

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
  visit_network(Prefix(names.actor), ActorLayout(networks.family, networks.norm), state.actor_first,
                state.actor_second, state.actor_statistics);
  visit_network(Prefix(names.critic), CriticLayout(networks.family, networks.norm),
                state.critic_first, state.critic_second, state.critic_statistics);
}

// The best networks are those of a policy, none of them where none was validated.
void AddBest(const BestNetworks& best, TensorFile& file) {
  const NetworkFamily family = best.networks.family;
  const NetworkNames names = NamesOf(family);
  if (best.epochs.actor > 0)
    AddParameters(ActorLayout(family), "best." + Prefix(names.actor), best.networks.actor,
                  MakeTensor<float>, file);
  if (best.epochs.critic > 0)
    AddParameters(CriticLayout(family), "best." + Prefix(names.critic), best.networks.critic,
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
    best.networks.actor =
        ReadParameters(ActorLayout(networks.family), "best." + Prefix(names.actor), file, path);
  if (best.epochs.critic > 0)
    best.networks.critic =
        ReadParameters(CriticLayout(networks.family), "best." + Prefix(names.critic), file, path);
  return best;
}

std::string ConfigText(const TrainConfig& config) { return JsonText(ToJson(config)); }

void AddLosses(const TrainerState& state, TensorFile& file) {
  const std::vector<LossColumn> columns = LossColumnsOf(state.networks.family);
  std::vector<double> steps;
  std::vector<double> epochs;
  const auto append = [&](const StageLosses& losses, std::vector<double>& out) {
    for (const LossColumn& column : columns) out.push_back(losses.*(column.value));
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
    StageLosses losses = UnknownLosses();
    for (std::size_t i = 0; i < columns.size(); ++i)
      losses.*(columns[i].value) = values[row * columns.size() + i];
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

// Of all that the file holds but this hash: a training that goes on from a damaged number would end
// in a policy that nobody can tell from a sound one.
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

Json ProvenanceToJson(const PolicyProvenance& provenance) {
  Json json = {{"config", ToJson(provenance.config)},
               {"config_sha256", ConfigHash(provenance.config)},
               {"dataset_sha256", provenance.dataset_sha256},
               {"code_version", provenance.code_version},
               {"seed", provenance.config.seed},
               {"step", provenance.step}};
  if (!provenance.from_weights_sha256.empty())
    json["from_weights_sha256"] = provenance.from_weights_sha256;
  if (provenance.best != BestEpochs{}) {
    const NetworkNames names = NamesOf(provenance.config.family);
    json["best_epoch"] = {{names.actor, provenance.best.actor},
                          {names.critic, provenance.best.critic}};
  }
  json["trained_on"] = SeenPartsToJson(provenance.trained_on);
  return json;
}

PolicyProvenance ProvenanceFromJson(const Json& json, NetworkFamily family,
                                    const std::string& path) {
  PolicyProvenance provenance;
  provenance.config.family = family;
  try {
    Assign(MemberOf(json, "config", path), provenance.config, path + ".config");
  } catch (const Error& error) {
    throw Error(ErrorCode::kFormat, error.what());
  }
  provenance.dataset_sha256 = ValueOf<std::string>(json, "dataset_sha256", path);
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.step = ValueOf<std::uint64_t>(json, "step", path);
  if (json.contains("from_weights_sha256"))
    provenance.from_weights_sha256 = ValueOf<std::string>(json, "from_weights_sha256", path);
  if (json.contains("best_epoch")) {
    const NetworkNames names = NamesOf(family);
    const Json& best = json["best_epoch"];
    provenance.best = {ValueOf<int>(best, names.actor, path + ".best_epoch"),
                       ValueOf<int>(best, names.critic, path + ".best_epoch")};
  }
  if (json.contains("trained_on"))
    provenance.trained_on =
        SeenPartsFromJson(MemberOf(json, "trained_on", path), path + ".trained_on");
  return provenance;
}

// A line a step; a loss that is not known yet is left out.
std::string LossLines(const TrainerState& state, const TrainingPace& pace) {
  const std::vector<LossColumn> columns = LossColumnsOf(state.networks.family);
  std::string text;
  const auto add = [&](const char* name, double value) {
    char number[64];
    std::snprintf(number, sizeof number, "\": %.9g", value);
    text.append(", \"").append(name).append(number);
  };
  for (std::size_t i = 0; i < state.steps.size(); ++i) {
    text += "{\"step\": " + std::to_string(i + 1) +
            ", \"epoch\": " + std::to_string(i / pace.steps_per_epoch + 1);
    add("learning_rate", LearningRateAt(pace.config, {i, pace.steps_per_epoch}));
    for (const LossColumn& column : columns) {
      const double value = state.steps[i].*(column.value);
      if (std::isfinite(value)) add(column.name, value);
    }
    text += "}\n";
  }
  return text;
}

// The steps' losses, and behind each epoch those of the validation.
std::vector<ScalarEvent> EventsOf(const TrainerState& state) {
  const std::size_t per_epoch = state.epochs.empty() ? 0 : state.steps.size() / state.epochs.size();
  std::vector<ScalarEvent> events;
  const auto add = [&](const char* kind, std::size_t step, const StageLosses& losses) {
    for (const LossColumn& column : LossColumnsOf(state.networks.family)) {
      const double value = losses.*(column.value);
      if (std::isfinite(value)) events.push_back({step, std::string(kind) + column.name, value});
    }
  };
  for (std::size_t i = 0; i < state.steps.size(); ++i) add("train/", i + 1, state.steps[i]);
  for (std::size_t i = 0; i < state.epochs.size(); ++i)
    add("validation/", (i + 1) * per_epoch, state.epochs[i].validation);
  return events;
}

}  // namespace

std::string ConfigHash(const TrainConfig& config) { return Sha256Hex(ConfigText(config)); }

void WritePolicy(const fs::path& folder, const StageNetworks& networks,
                 const PolicyProvenance& provenance) {
  Require(networks.norm == EncoderNorm::kNone, ErrorCode::kInvalidArgument,
          "a policy's normalised layers must be folded, see PolicyOf()");
  const std::string weights = EncodeTensors(WeightsOf(networks, MakeHalfTensor));
  CommitFile(folder / kWeightsFile, weights);
  Json json = {{"schema", "doorforge.policy"},
               {"schema_version", kPolicySchemaVersion},
               {"stage", provenance.stage},
               {"weights", kWeightsFile},
               {"weights_sha256", Sha256Hex(weights)},
               {"sizes",
                {{"cloud_points", kCloudPoints},
                 {"feature", kFeatureSize},
                 {"state", 18},
                 {"action", 9},
                 {"latent", kLatentSize}}},
               {"linear_branches", networks.linear_branches},
               {"normalisation", NormalisationToJson(networks.normalisation)},
               {"provenance", ProvenanceToJson(provenance)}};
  WriteJsonFile(folder / kRecordFile, json);
}

PolicyRecord ReadPolicy(const fs::path& folder, std::string_view stage) {
  const std::string path = (folder / kRecordFile).string();
  const Json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.policy", kPolicySchemaVersion, path);
  const auto found = ValueOf<std::string>(json, "stage", path);
  if (found != stage)
    throw Error(ErrorCode::kFormat, path + ": a policy of the stage \"" + found +
                                        "\", where one of the stage \"" + std::string(stage) +
                                        "\" is needed");
  PolicyRecord record;
  record.weights_sha256 = ValueOf<std::string>(json, "weights_sha256", path);
  record.networks.family = FamilyOf(found);
  record.networks.linear_branches = ValueOf<bool>(json, "linear_branches", path);
  record.networks.normalisation =
      NormalisationFromJson(MemberOf(json, "normalisation", path), path + ".normalisation");
  record.provenance = ProvenanceFromJson(MemberOf(json, "provenance", path), record.networks.family,
                                         path + ".provenance");
  record.provenance.stage = found;

  const std::string weights_path = (folder / kWeightsFile).string();
  const std::string weights = ReadFile(weights_path);
  if (Sha256Hex(weights) != record.weights_sha256)
    throw Error(ErrorCode::kFormat, weights_path + ": its SHA-256 is not the one in " + path +
                                        "; run the training again with --resume");
  ReadWeights(DecodeTensors(weights, weights_path), weights_path, record.networks);
  return record;
}

void WriteTrainerState(const fs::path& folder, const TrainerState& state,
                       const PolicyProvenance& provenance) {
  TensorFile file = WeightsOf(state.networks, MakeTensor<float>);
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
  state.networks.norm = NormOf(expected.config);
  ReadWeights(file, path, state.networks);
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

std::vector<TrainingCurve> CurvesOf(const TrainerState& state) {
  std::vector<TrainingCurve> curves;
  for (const LossColumn& column : LossColumnsOf(state.networks.family)) {
    TrainingCurve& curve = curves.emplace_back();
    curve.name = column.name;
    for (std::size_t e = 0; e < state.epochs.size(); ++e) {
      curve.epoch.push_back(static_cast<double>(e + 1));
      curve.train.push_back(state.epochs[e].train.*(column.value));
      curve.validation.push_back(state.epochs[e].validation.*(column.value));
    }
  }
  return curves;
}

void WriteLosses(const fs::path& folder, const TrainerState& state, const TrainingPace& pace) {
  CommitFile(folder / "losses.jsonl", LossLines(state, pace));
  CommitFile(folder / "events.out.tfevents.doorforge", TensorboardEvents(EventsOf(state)));
  Json curves = Json::array();
  for (const TrainingCurve& curve : CurvesOf(state))
    curves.push_back({{"name", curve.name},
                      {"epoch", NumbersToJson(curve.epoch)},
                      {"train", NumbersToJson(curve.train)},
                      {"validation", NumbersToJson(curve.validation)}});
  WriteJsonFile(folder / kLossesFile, {{"schema", "doorforge.losses"},
                                       {"schema_version", kLossesSchemaVersion},
                                       {"curves", curves}});
}

std::vector<TrainingCurve> ReadTrainingCurves(const fs::path& folder) {
  const std::string path = (folder / kLossesFile).string();
  const Json json = ReadJsonFile(path);
  RequireSchema(json, "doorforge.losses", kLossesSchemaVersion, path);
  const Json& array = MemberOf(json, "curves", path);
  if (!array.is_array()) throw Error(ErrorCode::kFormat, path + ".curves: expected an array");
  std::vector<TrainingCurve> curves;
  for (const Json& entry : array) {
    TrainingCurve curve;
    curve.name = ValueOf<std::string>(entry, "name", path);
    curve.epoch = NumbersFromJson(MemberOf(entry, "epoch", path), path);
    curve.train = NumbersFromJson(MemberOf(entry, "train", path), path);
    curve.validation = NumbersFromJson(MemberOf(entry, "validation", path), path);
    if (curve.train.size() != curve.epoch.size() || curve.validation.size() != curve.epoch.size())
      throw Error(ErrorCode::kFormat, path + ": the columns of a curve differ in length");
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace doorforge
