// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/packed_content.h"

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

#include "episode_writer.h"
#include "expert_film.h"
#include "html_page.h"
#include "record_view.h"
#include "show_record.h"
#include "thumbnail.h"

namespace doorforge {

using Json = nlohmann::ordered_json;

std::string PackRecord(const std::filesystem::path& folder, const Json& beside) {
  internal::PageContent content;
  content.document.update(beside);
  content.document["kind"] = "records";
  content.document["version"] = CodeVersion();
  internal::ShownRecord shown = internal::ShowRecord(folder, LoadMobileFranka(), content);
  internal::AddFindings(DoorValidator().Validate(folder).findings, shown.record);
  content.document["records"] = Json::array({std::move(shown.record)});
  return content.Packed();
}

std::string PackExpertFilm(const std::filesystem::path& door_folder, std::uint64_t seed) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = ReadDoor(door_folder);
  internal::EpisodeWriter writer(robot, 0);
  writer.Add(door, door.id, internal::FilmOfExpert(door, robot, seed, false));
  return writer.content().Packed();
}

std::string PackMeshes(std::span<const TriangleMesh> meshes, const Json& beside) {
  internal::PageContent content;
  content.document.update(beside);
  Json shown = Json::array();
  for (const TriangleMesh& mesh : meshes) shown.push_back(content.AddMesh(mesh));
  content.document["shown"] = std::move(shown);
  return content.Packed();
}

std::string ServedPage(const std::string& title, const Json& document) {
  internal::PageContent content;
  content.document.update(document);
  return internal::ServedHtmlPage(title, content);
}

std::string DrawThumbnail(const Part& part, int width_px) {
  Require(width_px >= 64 && width_px <= 640, ErrorCode::kInvalidArgument,
          "thumbnail: the width must lie in 64..640");
  return internal::DrawSubject(internal::SubjectOf(part), width_px);
}

}  // namespace doorforge
