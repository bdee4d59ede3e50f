// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "thumbnail.h"

#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_picture.h"

namespace doorforge::internal {

Subject SubjectOf(const Part& part) {
  Subject subject{part.id, {}, part.role == PartRole::kBody};
  for (const PartPiece& piece : part.pieces)
    subject.meshes.push_back({piece.mesh, 0, PointLabel::kOther, piece.color_rgba.head<3>()});
  return subject;
}

std::string DrawSubject(const Subject& subject, int width) {
  SceneGeometry scene(subject.meshes);
  ViewConfig view;
  view.width = width;
  view.height = width * 3 / 4;
  ScenePictureConfig shading;
  shading.floor = subject.stands;
  return EncodeJpeg(RenderPicture(scene, FramingCamera(scene, view), shading));
}

}  // namespace doorforge::internal
