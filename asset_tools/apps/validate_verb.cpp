// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/foreign/validation_run.h"
#include "doorforge/mesh/work_budget.h"

#include "validator.h"
#ifdef DOORFORGE_WITH_OPENABLE
#include "doorforge/openable/openable_check.h"
#endif
#ifdef DOORFORGE_WITH_VIEW
#include "doorforge/view/findings_page.h"
#endif

#include "verbs.h"

namespace doorforge {
namespace {

struct ValidateOptions {
  ValidationRequest request;
  ValidationSettings given;  // on the command line; empty: what the file says
  std::string profile;
  std::string config;
  std::optional<FindingFormat> format;
  std::optional<FailOn> fail_on;
  std::string out;
  bool json = false;
  bool rules = false;
  bool fix = false;
  bool dry_run = false;
};

void AddProjectOptions(CLI::App& app, ValidateOptions& options) {
  AddChoice(app, "--format", options.format, "text (default), json, sarif, junit, github, html");
  app.add_option("--out", options.out, "write the report to this file");
  AddChoice(app, "--fail-on", options.fail_on, "exit code 1 from this severity on (error)");
  const auto list = [&](const char* name, std::vector<std::string>& values, const char* about) {
    app.add_option(name, values, about)->allow_extra_args(false);
  };
  list("--ignore", options.given.ignore, "a code or family, such as HND; may be repeated");
  list("--severity", options.given.severity, "CODE=error, warning or info; may be repeated");
  list("--package", options.given.packages, "NAME=FOLDER for package://NAME; may be repeated");
  app.add_option("--root", options.given.root, "folder that paths of foreign files stay inside");
  app.add_option("--hinge", options.given.hinge, "the hinge of a foreign object: a joint's name");
  app.add_option("--handle", options.given.handle, "its handle: a link's name");
  app.add_option("--ask", options.given.ask,
                 "second opinions: urdfdom,mujoco,sdformat,assimp (default: all) or none")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--baseline", options.given.baseline, "known findings, which count no more");
  app.add_option("--write-baseline", options.request.new_baseline, "write such a file");
  AddConfig(app, options.config,
            "settings of the project; default: the nearest .doorforge-validate.yaml");
}

ValidateOptions ParseValidate(int argc, char** argv) {
  ValidateOptions options;
  options.given.ask.clear();
  FolderChecks& checks = options.request.checks;
  checks.max_seconds = kObjectSeconds;
  CLI::App app("Checks doors, parts and anybody's URDF, MJCF, SDF, USDA, glTF and meshes.",
               "doorforge validate");
  app.add_option("PATH", options.request.paths, "doors, parts, files, or folders that hold some");
  app.add_option("--profile", options.profile,
                 "doors: urdf, physics (default), openable; files: mujoco, isaac, gazebo, sapien")
      ->check(CLI::IsMember(ProfileWords()));
  auto* fix = app.add_flag("--fix", options.fix,
                           "mend what can be mended, then validate; --rules says which");
  app.add_flag("--dry-run", options.dry_run, "with --fix: show what would be mended")->needs(fix);
  AddThreads(app, checks.threads);
  AddMaxSeconds(app, checks.max_seconds);
  app.add_option("--expect", options.request.expect,
                 "how many items there are to check; exit code 4 if it is another number")
      ->check(CLI::Range(1, 1'000'000'000));
  AddJson(app, options.json);
  AddProjectOptions(app, options);
  app.add_flag("--rules", options.rules, "list the rules and end");
  app.footer(
      "exit code: 0 without errors, 1 with errors (--fail-on), 3 if a path could not be read or\n"
      "written or nothing was found to check, 4 if it was not as many as --expect says\n"
      "examples:\n"
      "  doorforge validate doors --json\n"
      "  doorforge validate robot.urdf --hinge door_hinge --handle lever\n"
      "  doorforge validate urdf --format sarif --out findings.sarif\n"
      "  doorforge validate --rules --json");
  ParseVerb(app, argc, argv);
  Require(options.rules || !options.request.paths.empty(), ErrorCode::kInvalidArgument,
          "PATH is required; see `doorforge validate --help`");
  if (options.fix) checks.fix = options.dry_run ? FixMode::kDryRun : FixMode::kWrite;
  return options;
}

std::unique_ptr<DoorValidator> ValidatorFor(ValidationProfile profile) {
  if (profile != ValidationProfile::kOpenable) return std::make_unique<DoorValidator>(profile);
  auto validator = OpenableValidator();
  Require(validator != nullptr, ErrorCode::kInvalidArgument,
          "--profile openable: this build lacks the simulation (sim/rollout)");
  return validator;
}

}  // namespace

std::unique_ptr<DoorValidator> OpenableValidator() {
#ifdef DOORFORGE_WITH_OPENABLE
  return std::make_unique<DoorValidator>(OpenableCheck());
#else
  return nullptr;
#endif
}

int RunValidateVerb(int argc, char** argv) {
  ValidateOptions options = ParseValidate(argc, argv);
  if (options.rules) {
    PrintAnswer(options.json, AllRulesToJson(), AllRulesText());
    return 0;
  }
  ValidationRequest& request = options.request;
  const ChosenProfile profile = ProfileNamed(options.profile);
  options.given.target = profile.target;
  request.format =
      options.format.value_or(options.json ? FindingFormat::kJson : FindingFormat::kText);
  request.settings = SettingsFor(options.config, request.paths.front(), options.given);
  if (options.fail_on) request.settings.fail_on = *options.fail_on;
#ifdef DOORFORGE_WITH_VIEW
  request.page = PageOfFindings(ChecksOf(request.settings));
#endif
  const ValidationAnswer answer = RunValidation(*ValidatorFor(profile.doors), request);
  if (options.out.empty())
    PrintText(answer.document);
  else
    CommitFile(options.out, answer.document);
  PrintProgress(answer.messages);
  return answer.exit_code;
}

}  // namespace doorforge
