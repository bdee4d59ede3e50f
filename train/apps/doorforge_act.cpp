// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// From a real depth picture and a robot's state to the hand's next pose.

#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/program.h"
#include "doorforge/deploy/act_answer.h"
#include "doorforge/deploy/answer_picture.h"
#include "doorforge/deploy/decision_stream.h"
#include "doorforge/deploy/depth_picture.h"
#include "doorforge/deploy/online_controller.h"
#include "doorforge/registry/policy_options.h"

namespace doorforge {
namespace {

struct Options {
  OnlineControllerSetup setup;
  DecisionFiles files;
  std::string stage = "auto";
  std::string picture;
  std::string foreign_limit;
  std::string least_gain;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> candidates;
  bool text = false;
  bool overwrite = false;
};

void AddInputs(CLI::App& app, Options& options) {
  app.add_option("--depth", options.files.depth, "depth picture (grey PNG of 16 bits, or .npy)");
  app.add_option("--state", options.files.state, "robot's state at that moment (YAML)");
  app.add_flag("--stream", options.setup.sees_every_decision,
               "instead of --depth and --state: a decision for every line of standard input, "
               "{\"depth\": FILE, \"state\": FILE} or {\"depth\": FILE, \"handle\": FILE}");
  app.add_option("--before", options.files.before,
                 "depth picture by the same camera from before the robot came, which a --handler "
                 "may remember; in a stream {\"before\": FILE, ...} does the same");
  app.add_option("--handle-mask", options.files.handle,
                 "instead of --state, before the robot moves: which pixels show the handle (grey "
                 "PNG, not 0 where it is); says where and how to take hold");
  AddEarlierName(app, "--handle", "--handle-mask", options.files.handle);
  app.add_option("--camera", options.files.camera, "camera's calibration and pose (YAML)")
      ->required();
}

void AddPolicies(CLI::App& app, Options& options) {
  const std::string folder = ": a folder of `doorforge train ";
  AddWord(app, "--opener", options.setup.opener, "who opens the door" + folder + "open`");
  AddEarlierName(app, "--policy", "--opener", options.setup.opener);
  AddWord(app, "--handler", options.setup.handler, "who turns the handle" + folder + "handle`");
  AddWord(app, "--grasper", options.setup.grasper, "who takes hold" + folder + "grasp`");
  app.add_option("--stage", options.stage,
                 "which of them acts: open, handle, or auto: as the state says (unlocked)")
      ->check(CLI::IsMember({"auto", "open", "handle"}))
      ->capture_default_str();
  AddChoice(app, "--base", "what the robot stands on",
            {{"sliders", "fixed"}, "sliders", [&setup = options.setup](const std::string& word) {
               setup.base = *ValueNamed<RobotBase>(word);
             }});
  app.add_option("--candidates", options.candidates,
                 "actions among which the critic chooses (config: policy.candidates, 1)");
}

void AddAnswers(CLI::App& app, Options& options) {
  app.add_option("--foreign-limit", options.foreign_limit,
                 "hold where a picture is farther from the training than so many of a hundred "
                 "validation samples, or off (config: hold.foreign_percentile, 99)");
  app.add_option("--least-gain", options.least_gain,
                 "hold where less is expected [rad], or off (config: hold.least_gain_rad, 0, of "
                 "an action; hold.least_door_angle_rad, 0.1, of a grasp)");
  app.add_flag("--text", options.text, "a few lines for people instead of JSON");
  app.add_option("--picture", options.picture,
                 "PNG to draw the answer into: crop, hand now (white) and next (red), contact");
  app.add_option("--color", options.files.color,
                 "colours of --depth (PNG or JPEG of its size), which policies may read and the "
                 "answer is drawn into; --before-color: of --before");
  app.add_option("--before-color", options.files.before_color)->group("");
  app.add_flag("--overwrite", options.overwrite, "replace the file of --picture");
  app.add_option("--config", options.config, "YAML file with settings")->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "a.b=c overrides one setting, e.g. cloud.max_depth_m");
}

OnlineControllerConfig ConfigOf(const Options& options) {
  auto config = LoadConfig<OnlineControllerConfig>(options.config, options.settings);
  if (options.candidates) config.policy.candidates = *options.candidates;
  SetHolds(options.foreign_limit, options.least_gain, config.hold);
  return config;
}

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("From a depth picture and the robot's state to the hand's next pose.",
               "doorforge act");
  AddInputs(app, options);
  AddPolicies(app, options);
  AddAnswers(app, options);
  app.footer(
      "Prints the hand's next pose, what it is expected to gain, and whether to hold instead.\n"
      "docs/act.md has the files of camera and state. Exit code 1: an answer says hold, or a line\n"
      "could not be answered.\n\n"
      "examples, with pictures of a simulated door, from the folder of the sources:\n"
      "  doorforge act --depth data/sight/lever/grasp/depth.png --camera "
      "data/sight/lever/grasp/camera.yaml \\\n"
      "      --handle-mask data/sight/lever/grasp/mask.png --grasper data/policies/grasper\n"
      "  doorforge act --depth data/sight/lever/open/depth.png --camera "
      "data/sight/lever/open/camera.yaml \\\n"
      "      --state data/sight/lever/open/state.yaml --opener data/policies/opener --text\n"
      "  doorforge act --stream --camera camera.yaml --opener run/opener --handler run/handler");
  ParseVerb(app, argc, argv);
  CheckRequest(options.setup, options.files, options.picture);
  return options;
}

int Act(Options options) {
  options.setup.config = ConfigOf(options);
  if (options.stage != "auto") options.setup.stage = StageNamed(options.stage);
  RequireNoFile(options.picture, options.overwrite);
  options.setup.camera = ReadCalibratedCamera(options.files.camera);
  RequireTrainedPolicies({options.setup.opener, options.setup.handler, options.setup.grasper},
                         "rules read what only the simulator knows, and no robot does");
  OnlineController controller(options.setup);
  for (const std::string& note : controller.notes()) PrintNote("note: " + note);
  if (options.setup.sees_every_decision) {
    const bool held = AnswerStream(controller, {std::cin, options.files, options.text, PrintText});
    return StopRequested() != 0 ? 128 + StopRequested() : held ? 1 : 0;
  }
  const ActAnswer answer = DecideFromFiles(controller, options.files);
  PrintAnswer(!options.text, AnswerToJson(answer), AnswerText(answer));
  if (!options.picture.empty())
    WritePng(options.picture, AnswerPicture(answer, controller, options.setup.config.cloud));
  return answer.hold_reasons.empty() ? 0 : 1;
}

int RunActVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] { return Act(options); });
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunOneVerb({"act", doorforge::RunActVerb}, argc, argv);
}
