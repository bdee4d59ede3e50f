// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Where urdf-loader puts the links of a URDF, as columns of 4 x 4 matrices; see urdf_loader_judge.sh.
import URDFLoader from 'urdf-loader';

window.posesByUrdfLoader = (text, angles) => {
  const loader = new URDFLoader();
  loader.parseVisual = false;
  loader.parseCollision = false;
  const robot = loader.parse(text);
  robot.setJointValues(angles);
  robot.updateMatrixWorld(true);
  const poses = Object.entries(robot.links).map(([name, link]) => [name, link.matrixWorld.elements]);
  return { poses: Object.fromEntries(poses), angles: Object.fromEntries(Object.keys(angles).map((name) => [name, robot.joints[name].angle])) };
};
