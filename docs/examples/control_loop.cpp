// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The shipped policies in a robot's own program, without files and processes in between. Replace
// Simulated, which gives the sample pictures of data/sight/lever, by your camera and your arm:
//
//   control_loop data

#include <cstdio>
#include <filesystem>
#include <string>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/program.h"
#include "doorforge/deploy/online_controller.h"

// One camera and one arm, as three functions.
class Simulated {
 public:
  explicit Simulated(const std::filesystem::path& folder) : folder_(folder) {}

  doorforge::CalibratedCamera Camera() const {
    return doorforge::ReadCalibratedCamera(folder_ / "camera.yaml");
  }
  // Metres along the camera's z, 0 where nothing was measured.
  doorforge::DepthImage Depth() const {
    return doorforge::DecodeDepthPng(doorforge::ReadFile(folder_ / "depth.png"), 0.001, "depth");
  }
  doorforge::RobotState State(const doorforge::RobotModel& robot) const {
    return doorforge::ReadRobotState(folder_ / "state.yaml", robot);
  }

 private:
  std::filesystem::path folder_;
};

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] {
    const std::filesystem::path data = argc > 1 ? argv[1] : "data";
    const Simulated device(data / "sight" / "lever" / "open");
    doorforge::OnlineController controller({.camera = device.Camera(),
                                            .opener = (data / "policies" / "opener").string(),
                                            .handler = (data / "policies" / "handler").string()});
    for (int step = 0; step < 3; ++step) {
      const doorforge::ActAnswer answer =
          controller.Decide(device.Depth(), device.State(controller.robot()));
      std::printf("%s", doorforge::AnswerText(answer).c_str());
      if (!answer.hold_reasons.empty()) return 1;  // keep the arm where it is
      // move the arm to answer.world_from_hand here
    }
    return 0;
  });
}
