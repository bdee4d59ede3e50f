// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/pipeline/pipeline_graph.h"

namespace doorforge {

/// Makes one pipeline of several. Steps whose commands are equal, up to the steps that they need,
/// are one step: what two pipelines have in common is made once.
class PipelineJoiner {
 public:
  explicit PipelineJoiner(std::string name) { joined_.name = std::move(name); }

  /// Adds the steps of `pipeline` that `wanted` are or need, with its settings in their commands.
  ///
  /// @param label Distinguishes a step from an earlier one of the same name that is another.
  /// @returns By the names in `pipeline`, what the steps are called now.
  /// @throws Error(kInvalidConfig) if one of `wanted` is no step of the pipeline.
  std::map<std::string, std::string> Add(const Pipeline& pipeline,
                                         const std::vector<std::string>& wanted,
                                         const std::string& label);
  /// Adds a step as it is; it needs steps by their present names.
  void Add(PipelineStep step) { joined_.steps.push_back(std::move(step)); }

  const Pipeline& joined() const { return joined_; }

 private:
  std::string NewName(const PipelineStep& step, const std::string& label) const;

  Pipeline joined_;
  std::map<std::string, std::string> by_command_;  // text of a command: the step that has it
};

/// The names in braces that occur in the arguments, each once.
std::vector<std::string> PlaceholdersOf(const std::vector<std::string>& arguments);

}  // namespace doorforge
