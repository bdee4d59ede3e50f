// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The extension doorforge._core. Users meet it through the Python files of the package.

#include <exception>
#include <filesystem>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "bindings.h"
#include "convert.h"

namespace doorforge::python {
namespace {

const char* ClassOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return "InvalidArgumentError";
    case ErrorCode::kInvalidConfig:
      return "InvalidConfigError";
    case ErrorCode::kMissing:
      return "MissingError";
    case ErrorCode::kFormat:
      return "FormatError";
    case ErrorCode::kIo:
      return "FileAccessError";
    case ErrorCode::kIncomplete:
      return "IncompleteError";
  }
  return "Error";
}

void RaiseError(const char* name, const char* message) {
  const py::object type = py::module_::import("doorforge.errors").attr(name);
  PyErr_SetObject(type.ptr(), py::str(message).ptr());
}

void Translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    RaiseError(ClassOf(error.code()), error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    RaiseError("FileAccessError", (error.path1().string() + ": " + error.code().message()).c_str());
  }
}

}  // namespace

void BindErrors(py::module_& module) {
  py::register_exception_translator(Translate);
  module.def("exit_code_of", [](const std::string& name) {
    for (const ErrorCode code :
         {ErrorCode::kInvalidArgument, ErrorCode::kInvalidConfig, ErrorCode::kMissing,
          ErrorCode::kFormat, ErrorCode::kIo, ErrorCode::kIncomplete}) {
      if (name == ClassOf(code)) return ExitCodeOf(code);
    }
    return 3;
  });
}

}  // namespace doorforge::python

PYBIND11_MODULE(_core, module) {
  namespace python = doorforge::python;
  module.doc() = "The C++ of doorforge. Use the modules of the package doorforge instead.";
  module.def("code_version", &doorforge::CodeVersion);
  module.def("data_folder", &doorforge::DataFolder);
  python::BindErrors(module);
  python::BindDoors(module);
  python::BindScenes(module);
  python::BindStepper(module);
  python::BindLatch(module);
  python::BindPolicies(module);
  python::BindEvaluation(module);
}
