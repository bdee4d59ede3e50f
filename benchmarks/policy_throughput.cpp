// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The opening stage as it is trained and used, on made-up samples of 4096 points:
//
//   policy_throughput decisions [repetitions]   time of a decision, with 1 and 16 candidates, and
//                                               of 16 observations' decisions
//   policy_throughput steps [steps]             training in batches of 32, one thread, geometry
//                                               found anew for every sample, and the memory it
//                                               takes
//   policy_throughput processes [steps]         two processes, a core each, against one: needs two
//                                               idle cores
//
// Decisions and steps are processor time, which other programs on the machine hardly
// change; processes are wall-clock time, and only mean something on a machine that does nothing
// else.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>  // NOLINT: clock_gettime is POSIX
#include <unistd.h>

#include "doorforge/policy/stage_policy.h"
#include "doorforge/training/process_group.h"
#include "doorforge/training/train_stage.h"

#include "door_cloud.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

constexpr std::size_t kSamples = 64;
constexpr int kBatch = 32;

double ProcessorSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double WallSeconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

double PeakMebibytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

TrainConfig ConfigFor(int steps) {
  TrainConfig config;
  config.batch_size = kBatch;
  config.epochs = std::max(1, steps / static_cast<int>(kSamples / kBatch));
  return config;
}

// Trains and calls `at_step` before the first step and after each.
template <class Function>
void Train(int steps, ProcessGroup* group, const Function& at_step) {
  const auto made = testing::MakeSyntheticSamples(1, kSamples);
  TrainHooks hooks;
  hooks.threads = 1;
  hooks.group = group;
  hooks.geometry_cache_bytes = 0;  // all geometry is part of the step
  hooks.on_step = [&](const TrainerState& state) { at_step(static_cast<int>(state.step)); };
  at_step(0);
  TrainStage(made.samples, {}, ConfigFor(steps), hooks);
}

// Processor seconds of a call, sorted.
template <class Call>
std::vector<double> SecondsOf(int repetitions, const Call& call) {
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const double start = ProcessorSeconds();
    call();
    seconds.push_back(ProcessorSeconds() - start);
  }
  std::ranges::sort(seconds);
  return seconds;
}

void PrintDecisions(int repetitions) {
  const auto made = testing::MakeSyntheticSamples(1, 3);
  constexpr std::size_t kObservations = 16;
  std::vector<Observation> observations(kObservations);
  for (std::size_t i = 0; i < kObservations; ++i) {
    observations[i].cloud.xyz = testing::DoorCloud(8 + i, 0.4);
    observations[i].proprioception[31] = 1;
  }
  for (const int candidates : {1, 16}) {
    PolicyOptions options;
    options.candidates = candidates;
    const auto policy =
        MakePolicy(InitialNetworks(MeasureNormalisation(made.samples), false, 4), options);
    const auto one = SecondsOf(repetitions, [&] { policy->Act(observations[0]); });
    const auto batch = SecondsOf(std::max(1, repetitions / 4), [&] {
      for (const Observation& observation : observations) policy->Act(observation);
    });
    std::printf(
        "decision, %2d candidates: median %.1f ms, 95 %% under %.1f ms (goal: 50); of %zu "
        "observations %.1f ms\n",
        candidates, 1e3 * one[one.size() / 2], 1e3 * one[one.size() * 95 / 100], kObservations,
        1e3 * batch[batch.size() / 2]);
  }
}

void PrintSteps(int steps) {
  std::vector<double> seconds;
  double start = 0;
  Train(steps, nullptr, [&](int step) {
    const double now = ProcessorSeconds();
    if (step > 0) seconds.push_back(now - start);
    start = now;
  });
  std::ranges::sort(seconds);
  const double median = seconds[seconds.size() / 2];
  std::printf(
      "batch of %d, actor and critic, all geometry: %.2f s a step, %.1f samples/s/core "
      "through both networks, %.1f through one\n",
      kBatch, median, kBatch / median, 2 * kBatch / median);
  std::printf("peak memory: %.0f MiB (goal: under 2000)\n", PeakMebibytes());
}

// Samples per second of wall-clock time behind the first step.
double WallRate(int steps, ProcessGroup* group) {
  double start = 0;
  double end = 0;
  int done = 0;
  Train(steps, group, [&](int step) {
    end = WallSeconds();
    done = step;
    if (step == 1) start = end;
  });
  return kBatch * (done - 1) / (end - start);
}

// The core of a rank. Each process has its own, as Slurm's --cpu-bind or numactl give it, so that
// the scheduler moves nothing while it is timed.
int CoreOf(int rank) {
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return rank;
  int before = rank % CPU_COUNT(&allowed);
  int core = 0;
  while (!CPU_ISSET(core, &allowed) || before-- > 0) ++core;
  return core;
}

int RunMember(int steps) {
  const auto group = ProcessGroupFromEnvironment();
  const double rate = WallRate(steps, group.get());
  if (group->rank() == 0) std::printf("%.3f\n", rate);
  return 0;
}

// The rate that rank 0 of `processes` copies of this program prints; NaN if one fails.
double RateOf(const std::string& program, int processes, int steps) {
  const std::string port = std::to_string(20000 + ::getpid() % 20000);
  std::string command;
  for (int rank = processes - 1; rank >= 0; --rank)
    command += "RANK=" + std::to_string(rank) + " WORLD_SIZE=" + std::to_string(processes) +
               " MASTER_ADDR=127.0.0.1 MASTER_PORT=" + port + " taskset -c " +
               std::to_string(CoreOf(rank)) + " '" + program + "' member " + std::to_string(steps) +
               (rank > 0 ? " & " : "; code=$?; wait; exit $code");
  FILE* pipe = ::popen(command.c_str(), "r");
  double rate = std::numeric_limits<double>::quiet_NaN();
  if (pipe != nullptr && std::fscanf(pipe, "%lf", &rate) != 1)
    rate = std::numeric_limits<double>::quiet_NaN();
  const bool failed = pipe == nullptr || ::pclose(pipe) != 0;
  return failed ? std::numeric_limits<double>::quiet_NaN() : rate;
}

int PrintProcesses(const std::string& program, int steps) {
  // one, two, one: what else runs on the machine shows in the difference of the ones
  const double before = RateOf(program, 1, steps);
  const double both = RateOf(program, 2, steps);
  const double after = RateOf(program, 1, steps);
  std::printf("one process %.1f and %.1f samples/s, two %.1f: %.2f times (goal: 1.8)\n", before,
              after, both, both / std::max(before, after));
  return both > 0 ? 0 : 1;
}

int Run(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  const int count = argc > 2 ? std::max(2, std::atoi(argv[2])) : 10;
  if (what == "decisions")
    PrintDecisions(count);
  else if (what == "steps")
    PrintSteps(count);
  else if (what == "processes")
    return PrintProcesses(argv[0], count);
  else if (what == "member")
    return RunMember(count);
  else
    return std::fprintf(stderr, "usage: policy_throughput decisions|steps|processes [N]\n"), 2;
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) try {
  return doorforge::Run(argc, argv);
} catch (const std::exception& error) {
  return std::fprintf(stderr, "policy_throughput: %s\n", error.what()), 1;
}
