// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <utility>

#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/schemas/safetensors.h"

#include "training_state.h"

namespace doorforge {
namespace {

constexpr const char* kPpoKind = "doorforge.ppo";

// Calls visit(name, vector) for all flat vectors.
template <class State, class Visit>
void VisitPpoVectors(State& state, const Visit& visit) {
  visit("actor", state.networks.actor);
  visit("log_deviation", state.networks.log_deviation);
  visit("critic", state.networks.critic);
  visit("adam.first", state.first_moment);
  visit("adam.second", state.second_moment);
}

}  // namespace

void WritePpoState(const std::filesystem::path& folder, const PpoState& state,
                   const PpoOrigin& origin) {
  TensorFile file;
  VisitPpoVectors(state, [&](const std::string& name, const std::vector<float>& values) {
    file.tensors[name] = MakeTensor<float>(values, {values.size()});
  });
  const std::vector<double> numbers = internal::NumbersOfRows(state.updates, PpoColumns());
  file.tensors["updates"] =
      MakeTensor<double>(numbers, {state.updates.size(), PpoColumns().size()});
  file.tensors["gradient_steps"] = MakeTensor<std::int64_t>(
      std::vector<std::int64_t>{static_cast<std::int64_t>(state.gradient_steps)}, {1});
  internal::WriteTrainingState(folder, kPpoKind, origin, std::move(file));
}

bool HasPpoState(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / internal::kTrainingState);
}

PpoState ReadPpoState(const std::filesystem::path& folder, const PpoOrigin& expected,
                      PpoState initial) {
  const std::string path = (folder / internal::kTrainingState).string();
  const TensorFile file = internal::ReadTrainingState(folder, kPpoKind, expected);
  PpoState state = std::move(initial);
  VisitPpoVectors(state, [&](const std::string& name, std::vector<float>& values) {
    values = ValuesOf<float>(TensorNamed(file, name, path), {values.size()}, path);
  });
  state.updates =
      internal::RowsOfTensor<PpoUpdate>(TensorNamed(file, "updates", path), PpoColumns(), path);
  state.gradient_steps = static_cast<std::uint64_t>(
      ValuesOf<std::int64_t>(TensorNamed(file, "gradient_steps", path), {1}, path)[0]);
  return state;
}

}  // namespace doorforge
