// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Files of policies and what is made with them, pipelines, and robots. Their rooms come whole, so
// this program is built by whoever asks for it.

#include <array>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/pipeline/pipeline_graph.h"
#include "doorforge/policy/door_height.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/side_classifier.h"
#include "doorforge/policy/training_curves.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/policy/whole_policy.h"
#include "doorforge/report/report.h"

#include "fuzz_target.h"
#include "input_folder.h"

namespace doorforge::fuzz {
namespace {

std::filesystem::path FolderWith(const char* name, std::string_view input) {
  return InputFile(name, input).parent_path();
}

// The record alone: its weights are refused at the latest, being none.
void ReadPolicyRecord(std::string_view input) {
  InputFile("policy.safetensors", "");
  ReadPolicy(FolderWith("policy.json", input), "open");
}

void ReadWholeRecord(std::string_view input) {
  InputFile("policy.safetensors", "");
  ReadWholePolicy(FolderWith("policy.json", input));
}

void ReadSide(std::string_view input) { ReadSideClassifier(FolderWith("side.safetensors", input)); }

void ReadLearnedHeights(std::string_view input) {
  ReadHeights(FolderWith("heights.safetensors", input));
}

void ReadTurned(std::string_view input) {
  ReadTurnedClassifier(FolderWith("turned.safetensors", input), "");
}

void ReadFamiliar(std::string_view input) {
  ReadFamiliarity(FolderWith("familiar.safetensors", input), "", NetworkFamily::kMotion);
}

void ReadCurves(std::string_view input) { ReadTrainingCurves(FolderWith("losses.json", input)); }

void ReadEvaluation(std::string_view input) {
  const auto first = ReportToJson(ReportFromJson(ParseJson(input, "input"), "input"));
  Expect(ReportToJson(ReportFromJson(ParseJson(JsonText(first), "text"), "text")) == first,
         "a report is written as read");
}

void ReadPipelineFile(std::string_view input) {
  ReadPipeline(InputFile("input.yaml", input).string(), {});
}

void ReadRobot(std::string_view input) {
  LoadRobot(InputFile("robot.urdf", input), RobotBase::kFixed);
}

constexpr std::array kTargets{
    Target{"policy", Shape::kJson, ReadPolicyRecord},
    Target{"whole", Shape::kJson, ReadWholeRecord},
    Target{"side", Shape::kTensors, ReadSide},
    Target{"heights", Shape::kTensors, ReadLearnedHeights},
    Target{"turned", Shape::kTensors, ReadTurned},
    Target{"familiar", Shape::kTensors, ReadFamiliar},
    Target{"curves", Shape::kJson, ReadCurves},
    Target{"report", Shape::kJson, ReadEvaluation},
    Target{"pipeline", Shape::kBytes, ReadPipelineFile},
    Target{"robot", Shape::kBytes, ReadRobot},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
