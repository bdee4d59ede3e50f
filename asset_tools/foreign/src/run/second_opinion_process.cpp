// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <unistd.h>

#include "doorforge/core/confined_child.h"
#include "doorforge/foreign/answer_parent.h"

#ifdef DOORFORGE_WITH_SDFORMAT
#include <sdf/sdf.hh>
#endif

namespace doorforge::foreign {
namespace {

std::string Answer(const char* verdict, const std::string& program, const std::string& words) {
  return std::string(verdict) + '\n' + program + '\n' + words;
}

#ifdef DOORFORGE_WITH_SDFORMAT
std::string OpinionOfSdformat(const std::string& file) {
  const std::string name = std::string("sdformat ") + DOORFORGE_WITH_SDFORMAT;
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  bool includes = false;
  // what is included lies where a simulator is told to look
  config.SetFindCallback([&](const std::string&) {
    includes = true;
    return std::string();
  });
  sdf::Root root;
  std::string words;
  for (const sdf::Error& error : root.Load(file, config)) words += error.Message() + '\n';
  if (includes) return Answer("absent", name, "it would have to find what is included");
  return words.empty() ? Answer("ok", name, "") : Answer("no", name, words);
}
#else
std::string OpinionOfSdformat(const std::string&) {
  return Answer("absent", "sdformat", "this build is without it");
}
#endif

std::string mujoco_name = "MuJoCo";

// Where MuJoCo would end the process and write a log.
void AnswerMujocoError(const char* words) {
  SendAnswer(Answer("no", mujoco_name, words));
  ::_exit(0);
}
void IgnoreMujocoWarning(const char*) {}

template <class T>
T Symbol(void* library, const char* name) {
  return reinterpret_cast<T>(::dlsym(library, name));
}

std::string OpinionOfMujoco(void* library, const std::string& file) {
  // mujoco.h: mjModel* mj_loadXML(const char*, const mjVFS*, char*, int); both types stay opaque
  using Load = void* (*)(const char*, const void*, char*, int);
  using Version = const char* (*)();
  const auto load = Symbol<Load>(library, "mj_loadXML");
  const auto version = Symbol<Version>(library, "mj_versionString");
  if (load == nullptr) return Answer("absent", "MuJoCo", "its library lacks mj_loadXML");
  if (version != nullptr) mujoco_name += std::string(" ") + version();
  using Handler = void (*)(const char*);
  if (auto* error = Symbol<Handler*>(library, "mju_user_error")) *error = AnswerMujocoError;
  if (auto* warning = Symbol<Handler*>(library, "mju_user_warning")) *warning = IgnoreMujocoWarning;
  std::array<char, 1024> words{};
  const void* model = load(file.c_str(), nullptr, words.data(), static_cast<int>(words.size()));
  return model != nullptr ? Answer("ok", mujoco_name, "") : Answer("no", mujoco_name, words.data());
}

void* OpenMujoco(const char* named) {
  if (named != nullptr) return ::dlopen(named, RTLD_NOW | RTLD_LOCAL);
  for (const char* name : {"libmujoco.so", "libmujoco.so.2.2.2"}) {
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  }
  return nullptr;
}

}  // namespace

int AnswerParent(std::span<char* const> arguments) {
  if (arguments.size() < 4) {
    std::fprintf(stderr, "doorforge-second-opinion is started by the other doorforge programs\n");
    return 2;
  }
  const std::string_view program = arguments[1];
  const bool mujoco = program == "mujoco";
  // libraries are opened before the process gives up what it can do
  void* library = mujoco ? OpenMujoco(arguments.size() > 4 ? arguments[4] : nullptr) : nullptr;
  ConfineProcess({.seconds = 30, .parent = std::atoi(arguments[3]), .threads = mujoco});
  std::string answer;
  try {
    if (!mujoco)
      answer = OpinionOfSdformat(arguments[2]);
    else if (library == nullptr)
      answer = Answer("absent", "MuJoCo", "it is not installed");
    else
      answer = OpinionOfMujoco(library, arguments[2]);
  } catch (const std::exception& error) {
    answer = Answer("no", std::string(program), error.what());
  }
  if (!SendAnswer(answer)) return 3;
  // some libraries crash where they are unloaded
  ::_exit(0);
}

}  // namespace doorforge::foreign
