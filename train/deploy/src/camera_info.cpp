// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "camera_info.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "doorforge/core/nearest_name.h"

namespace doorforge::internal {
namespace {

constexpr int kMostPixels = 8192;
constexpr double kSame = 1e-9;

/// A model's name, ours for it, and how many coefficients it has.
struct NamedModel {
  const char* name;
  LensModel model;
  std::size_t coefficients;
};
constexpr std::array<NamedModel, 8> kModels = {{
    {"plumb_bob", LensModel::kPolynomial, 5},
    {"brown_conrady", LensModel::kPolynomial, 5},
    {"rational_polynomial", LensModel::kPolynomial, 12},
    {"equidistant", LensModel::kFisheye, 4},
    {"fisheye", LensModel::kFisheye, 4},
    {"kannala_brandt4", LensModel::kFisheye, 4},
    {"inverse_brown_conrady", LensModel::kInverseBrown, 5},
    {"none", LensModel::kPinhole, 0},
}};

// pyrealsense2 says "distortion.inverse_brown_conrady", rs-enumerate-devices "Inverse Brown
// Conrady".
std::string PlainName(std::string name) {
  if (name.starts_with("distortion.")) name.erase(0, name.find('.') + 1);
  for (char& c : name) c = c == ' ' ? '_' : static_cast<char>(std::tolower(c));
  return name.empty() ? "none" : name;
}

const NamedModel& ModelNamed(const NamedNumbers& file, const std::string& name) {
  const std::string plain = PlainName(name);
  std::vector<std::string> known;
  for (const NamedModel& model : kModels) {
    if (plain == model.name) return model;
    known.emplace_back(model.name);
  }
  file.Fail("distortion_model: \"" + name + "\" is not read; did you mean \"" +
            NearestName(plain, known) + "\"? Or rectify the picture first");
}

// The first key of these that the file has.
const char* KeyAmong(const NamedNumbers& file, const std::vector<const char*>& keys) {
  for (const char* key : keys)
    if (file.Has(key)) return key;
  file.Fail("the key \"" + std::string(keys[0]) + "\" is missing");
}

// Numbers under one of some names, alone or as the data of a matrix.
std::vector<double> Values(const NamedNumbers& file, const std::vector<const char*>& keys,
                           std::size_t least, std::size_t most) {
  const char* key = KeyAmong(file, keys);
  if (!file.At(key).is_object()) return file.Numbers(key, least, most);
  return NamedNumbers(file.file() + ": " + key, file.At(key)).Numbers("data", least, most);
}

bool HasAny(const NamedNumbers& file, const std::vector<const char*>& keys) {
  return std::ranges::any_of(keys, [&](const char* key) { return file.Has(key); });
}

const std::vector<const char*> kIntrinsics = {"camera_matrix", "k", "K"};
const std::vector<const char*> kDistortion = {"distortion_coefficients", "d", "D"};
const std::vector<const char*> kRectification = {"rectification_matrix", "r", "R"};
const std::vector<const char*> kProjection = {"projection_matrix", "p", "P"};

/// What part of the sensor the picture shows, in pixels of the sensor.
struct Window {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  int across = 1;  // pixels of the sensor a pixel of the picture
  int down = 1;
};

Window WindowOf(const NamedNumbers& file) {
  Window window;
  window.width = file.WholeNumber(KeyAmong(file, {"image_width", "width"}), 1, kMostPixels);
  window.height = file.WholeNumber(KeyAmong(file, {"image_height", "height"}), 1, kMostPixels);
  // 0 and 1 both mean one by one
  if (file.Has("binning_x")) window.across = std::max(1, file.WholeNumber("binning_x", 0, 64));
  if (file.Has("binning_y")) window.down = std::max(1, file.WholeNumber("binning_y", 0, 64));
  if (!file.Has("roi") || !file.At("roi").is_object()) return window;
  const NamedNumbers roi(file.file() + ": roi", file.At("roi"));
  const auto number = [&](const char* key, int most) {
    return roi.Has(key) ? roi.WholeNumber(key, 0, most) : 0;
  };
  const int width = number("width", window.width);
  const int height = number("height", window.height);
  if (width == 0 || height == 0) return window;  // means all of it
  window.left = number("x_offset", window.width - width);
  window.top = number("y_offset", window.height - height);
  window.width = width;
  window.height = height;
  return window;
}

// A camera matrix of the sensor's pixels, whose first has its centre at 0, as the view of a window.
PinholeView ViewOf(const NamedNumbers& file, const char* key, const std::vector<double>& matrix,
                   const Window& window) {
  const std::size_t columns = matrix.size() / 3;
  const double fx = matrix[0];
  const double fy = matrix[columns + 1];
  if (!(fx >= 1 && fy >= 1))
    file.Fail(std::string(key) + ": focal lengths of " + Format("%g and %g", fx, fy) +
              " pixels; a camera that was not calibrated says 0");
  PinholeView view;
  view.width = window.width / window.across;
  view.height = window.height / window.down;
  view.fx = fx / window.across;
  view.fy = fy / window.down;
  view.cx = (matrix[2] + 0.5 - window.left) / window.across;
  view.cy = (matrix[columns + 2] + 0.5 - window.top) / window.down;
  return view;
}

LensDistortion LensOf(const NamedNumbers& file) {
  if (!HasAny(file, kDistortion)) return {};
  const std::vector<double> coefficients = Values(file, kDistortion, 0, 14);
  const bool is_named = file.Has("distortion_model");
  return LensNamed(file,
                   is_named                   ? file.Word("distortion_model")
                   : coefficients.size() <= 5 ? "plumb_bob"
                                              : "rational_polynomial",
                   coefficients);
}

Eigen::Matrix3d RectificationOf(const NamedNumbers& file) {
  if (!HasAny(file, kRectification)) return Eigen::Matrix3d::Identity();
  const std::vector<double> r = Values(file, kRectification, 9, 9);
  // one that was never set is all zeros
  if (std::ranges::all_of(r, [](double value) { return value == 0; }))
    return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d turn =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
  constexpr double kRounding = 1e-4;
  if (!((turn * turn.transpose()).isIdentity(kRounding) && turn.determinant() > 0))
    file.Fail("rectification_matrix: is no rotation");
  return turn;
}

}  // namespace

bool IsCameraInfo(const nlohmann::ordered_json& json) {
  return std::ranges::any_of(std::array{"image_width", "camera_matrix", "k", "K", "roi", "header"},
                             [&](const char* key) { return json.contains(key); });
}

LensDistortion LensNamed(const NamedNumbers& file, const std::string& model,
                         const std::vector<double>& coefficients) {
  const NamedModel& named = ModelNamed(file, model);
  const auto is_set = [](double value) { return value != 0; };
  if (std::ranges::none_of(coefficients, is_set)) return {};
  const std::size_t count = std::min(coefficients.size(), named.coefficients);
  // drivers fill lists up with zeros
  if (std::any_of(coefficients.begin() + static_cast<std::ptrdiff_t>(count), coefficients.end(),
                  is_set))
    file.Fail("distortion_coefficients: " + std::to_string(coefficients.size()) +
              " of them, and of \"" + model + "\" " + std::to_string(named.coefficients) +
              " are read; look at distortion_model, or rectify the picture first");
  LensDistortion lens{named.model, {}};
  std::copy_n(coefficients.begin(), count, lens.coefficients.begin());
  return lens;
}

CameraInfo CameraInfoOf(const NamedNumbers& file) {
  const Window window = WindowOf(file);
  CameraInfo info;
  const std::vector<double> k = Values(file, kIntrinsics, 9, 9);
  info.raw = ViewOf(file, "camera_matrix", k, window);
  info.lens = LensOf(file);
  info.rectification = RectificationOf(file);
  info.rectified = info.raw;
  const bool projects = HasAny(file, kProjection) && Values(file, kProjection, 12, 12)[0] != 0;
  if (projects)
    info.rectified = ViewOf(file, "projection_matrix", Values(file, kProjection, 12, 12), window);
  const auto near = [](double a, double b) { return std::abs(a - b) <= kSame * std::abs(a); };
  info.alike = info.lens.model == LensModel::kPinhole && info.rectification.isIdentity(kSame) &&
               near(info.raw.fx, info.rectified.fx) && near(info.raw.fy, info.rectified.fy) &&
               near(info.raw.cx, info.rectified.cx) && near(info.raw.cy, info.rectified.cy);
  return info;
}

}  // namespace doorforge::internal
