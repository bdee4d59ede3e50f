// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace doorforge::foreign {

/// The body of a program that another starts with a file from outside; each has its own. Both give
/// up their rights (see confined_child.h) before they open the file.
///
/// doorforge-second-opinion: PROGRAM FILE PARENT [LIBRARY], where PROGRAM is "sdformat" or
/// "mujoco". It answers "ok", "no" or "absent", the program's name with its version, and its words,
/// a line each.
///
/// doorforge-read-model: PARENT WORK FILE and
///   model FORMAT, for ReadModelApart() of read_model.h;
///   text ROOT URDFDOM [NAME=FOLDER...], for ReadTextApart(): the text of an articulated object,
///     and, where URDFDOM is "1" and it is a URDF, what urdfdom says of it in the form above;
///   triangles, for GlbTrianglesApart().
/// It opens `FILE`, and of the second kind what lies below the folders, and nothing else.
int AnswerParent(std::span<char* const> arguments);

}  // namespace doorforge::foreign
