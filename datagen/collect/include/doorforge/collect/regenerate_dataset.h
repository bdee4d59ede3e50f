// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/collect/stage_policies.h"
#include "doorforge/dataset/regenerate.h"
#include "doorforge/dataset/verify_dataset.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/schemas/episode_film.h"

namespace doorforge {

/// A dataset of which a share is made again, and what it was made with.
struct RegenerateDatasetRequest {
  std::filesystem::path folder;    ///< The dataset's.
  double fraction = 0.01;          ///< This share of the planned episodes is made again, in (0, 1].
  std::vector<std::string> doors;  ///< Folders with the doors of the dataset.
  std::string robot;               ///< URDF of the robot, where config.yaml names one that is not
                                   ///< in the dataset's folder; empty: none is given.
  CollectionWords policies;        ///< That acted.
  int threads = 0;                 ///< 0: all processors.
  RobotMeshReader robot_meshes;    ///< Reads the meshes of that robot; see LoadRobot().
};

/// Makes a share of a dataset's episodes again, from its own config.yaml and the doors, robot and
/// policies that are given, and compares every byte; see RegenerateEpisodes().
///
/// @throws Error(kInvalidArgument) if build, doors, robot or policies are not those that the
///     dataset was made with, or it is of an early build that noted no plan; as StageRun and
///     RegenerateEpisodes().
RegenerateResult RegenerateDataset(const RegenerateDatasetRequest& request);

/// A check of a dataset, of which a share may be made again where the rest has no fault.
struct ThoroughVerification {
  VerifyRequest verify;
  std::string share = {};  ///< As ParseFraction() takes it, "1%"; empty: none is made again.
  RegenerateDatasetRequest regenerate = {};  ///< Its folder, threads and fraction are not read.
};

struct ThoroughFindings {
  std::vector<DatasetFinding> findings;
  std::string note;  ///< How much was made again, for people; empty where nothing was.
};

/// VerifyDataset() with progress, then RegenerateDataset(). Throws as both, and as ParseFraction().
ThoroughFindings VerifyThoroughly(ThoroughVerification request);

/// What is filmed of a dataset, and what it was made with; `fraction` is not looked at.
struct FilmDatasetRequest {
  RegenerateDatasetRequest made_with;
  int stored = 0;  ///< 0: every episode that failed; else at most so many of those that are stored.
};

/// Films planned episodes, made again as RegenerateDataset() does, in the order of the plan. At the
/// stage "grasp", where failures are data, all are stored and none failed.
///
/// @throws Error(kInvalidArgument) as RegenerateDataset(), or if an episode made again does not end
///     as it is recorded: its outcome and numbers, and of one that is stored the hash of its final
///     state.
std::vector<EpisodeFilm> FilmDataset(const FilmDatasetRequest& request);

}  // namespace doorforge
