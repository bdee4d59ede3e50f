// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "run/ask_urdfdom.h"

#ifdef DOORFORGE_WITH_URDFDOM
#include <exception>

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include "doorforge/core/committed_file.h"
#endif

namespace doorforge::foreign {

#ifdef DOORFORGE_WITH_URDFDOM
namespace {

/// Keeps what the library would print.
class KeptLog : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_ += text + '\n';
  }
  const std::string& errors() const { return errors_; }

 private:
  std::string errors_;
};

}  // namespace

std::string OpinionOfUrdfdom(const std::filesystem::path& file) {
  const std::string name = std::string("urdfdom ") + DOORFORGE_WITH_URDFDOM + "\n";
  KeptLog log;
  console_bridge::useOutputHandler(&log);
  std::string problem;
  try {
    const auto model = urdf::parseURDF(ReadFile(file, 16ULL << 20U));
    if (!model) problem = log.errors().empty() ? "no model" : log.errors();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  console_bridge::restorePreviousOutputHandler();
  return problem.empty() ? "ok\n" + name : "no\n" + name + problem;
}
#else
std::string OpinionOfUrdfdom(const std::filesystem::path& /*file*/) {
  return "absent\nurdfdom\nthis build is without it";
}
#endif

}  // namespace doorforge::foreign
