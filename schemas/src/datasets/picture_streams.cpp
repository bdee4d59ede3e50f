// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/picture_streams.h"

#include <algorithm>
#include <array>

#include "doorforge/core/error.h"
#include "doorforge/schemas/npy.h"

namespace doorforge {
namespace {

constexpr std::string_view kPose = "pose";
constexpr std::string_view kArraySuffix = ".npy";

// What the array of a stream is.
struct StreamForm {
  PictureStream stream;
  std::string_view type;
  std::size_t element_size;
  std::size_t channels;  // 1: no axis of its own
  std::string_view unit;
  std::string_view frame;
  std::string_view meaning;
};

constexpr std::array kForms = {
    StreamForm{PictureStream::kRgb, "|u1", 1, 3, "", "", "sRGB"},
    StreamForm{PictureStream::kDepth, "<u2", 2, 1, "mm", "camera",
               "distance along the optical axis, 0: nothing"},
    StreamForm{PictureStream::kDepth32, "<f4", 4, 1, "m", "camera",
               "distance along the optical axis, 0: nothing"},
    StreamForm{PictureStream::kLabel, "|u1", 1, 1, "", "",
               "0 body, 1 handle, 2 frame, 3 robot, 4 other, 255 nothing"},
    StreamForm{PictureStream::kLink, "|u1", 1, 1, "", "",
               "0 frame, 1 leaf, 2 handle, 3 + j body of robot joint j, then the robot's base; 255 "
               "nothing"},
    StreamForm{PictureStream::kNormal, "|i1", 1, 3, "1/127", "world",
               "unit normal towards the camera, 0: nothing"},
};

const StreamForm& FormOf(PictureStream stream) {
  return *std::find_if(kForms.begin(), kForms.end(),
                       [&](const StreamForm& form) { return form.stream == stream; });
}

bool IsNameOf(std::string_view name, std::string_view stream) {
  return name.size() > stream.size() + 1 && name.starts_with(stream) && name[stream.size()] == '_';
}

EpisodeFeature PoseFeature(const std::string& name) {
  return {name,   "<f8",   {3, 4},
          "1, m", "world", "world_from_camera; camera x right, y down, z forward"};
}

EpisodeFeature ColorFeature() {
  return {std::string(kCloudColors), "|u1", {0, 3}, "", "", "sRGB of the points of cloud"};
}

bool IsPictureName(std::string_view name) {
  return name == kCloudColors || IsNameOf(name, kPose) ||
         std::any_of(kForms.begin(), kForms.end(),
                     [&](const StreamForm& form) { return IsNameOf(name, NameOf(form.stream)); });
}

std::vector<std::size_t> ShapeOf(const ShardReader& reader, std::size_t episode,
                                 const std::string& member) {
  return ParseNpyHeader(reader.Read(episode, member), reader.Describe(episode, member)).shape;
}

EpisodeFeature FeatureIn(const ShardReader& reader, std::size_t episode,
                         const std::string& member) {
  const std::string where = reader.Describe(episode, member);
  const NpyHeader header = ParseNpyHeader(reader.Read(episode, member), where);
  std::optional<EpisodeFeature> feature;
  if (!header.shape.empty() && header.shape[0] == reader.index().episodes[episode].decisions)
    feature = PictureFeature(member.substr(0, member.size() - kArraySuffix.size()),
                             {header.shape.begin() + 1, header.shape.end()});
  const bool one_a_point = member != std::string(kCloudColors) + ".npy" ||
                           header.shape == ShapeOf(reader, episode, "cloud.npy");
  if (!feature || feature->type != header.type || !one_a_point)
    throw Error(ErrorCode::kFormat, where +
                                        ": is called as a picture, and its type and shape are "
                                        "none of a picture of this episode");
  return *feature;
}

}  // namespace

std::size_t BytesAPixel(PictureStream stream) {
  return FormOf(stream).element_size * FormOf(stream).channels;
}

std::string PictureName(PictureStream stream, std::string_view camera) {
  return std::string(NameOf(stream)) + "_" + std::string(camera);
}

std::string PicturePoseName(std::string_view camera) {
  return std::string(kPose) + "_" + std::string(camera);
}

std::optional<EpisodeFeature> PictureFeature(const std::string& name,
                                             const std::vector<std::size_t>& shape) {
  if (IsNameOf(name, kPose) && shape == std::vector<std::size_t>{3, 4}) return PoseFeature(name);
  if (name == kCloudColors && shape.size() == 2 && shape[1] == 3) return ColorFeature();
  for (const StreamForm& form : kForms) {
    if (!IsNameOf(name, NameOf(form.stream))) continue;
    const bool fits =
        form.channels == 1 ? shape.size() == 2 : shape.size() == 3 && shape[2] == form.channels;
    if (!fits || shape[0] == 0 || shape[1] == 0) return {};
    return EpisodeFeature{name,
                          std::string(form.type),
                          shape,
                          std::string(form.unit),
                          std::string(form.frame),
                          std::string(form.meaning)};
  }
  return {};
}

std::vector<EpisodeFeature> PictureFeaturesOf(const ShardReader& reader, std::size_t episode) {
  std::vector<EpisodeFeature> features;
  for (const ShardMember& member : reader.index().episodes[episode].members) {
    if (!member.name.ends_with(kArraySuffix)) continue;
    const std::string name = member.name.substr(0, member.name.size() - kArraySuffix.size());
    if (IsPictureName(name)) features.push_back(FeatureIn(reader, episode, member.name));
  }
  return features;
}

}  // namespace doorforge
