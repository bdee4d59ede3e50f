// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/json_schema.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/settings_schema.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/shard.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

Json SchemaOf(const Json& example, const std::string& name);

// What both schemas allow: two objects are one whose properties allow both.
Json Merged(Json first, const Json& second) {
  if (first == second) return first;
  const Json kind = first.value("type", Json());
  if (kind == second.value("type", Json()) && kind == "object") {
    for (const auto& [key, property] : second["properties"].items())
      first["properties"][key] = Merged(first["properties"].value(key, property), property);
    return first;
  }
  if (kind == second.value("type", Json()) && kind == "array") {
    first["items"] = Merged(first["items"], second["items"]);
    return first;
  }
  Json kinds = first.value("anyOf", Json::array({first}));
  for (const Json& more : second.value("anyOf", Json::array({second})))
    if (std::find(kinds.begin(), kinds.end(), more) == kinds.end()) kinds.push_back(more);
  return {{"anyOf", kinds}};
}

Json ItemsOf(const Json& array, const std::string& name) {
  Require(!array.empty(), ErrorCode::kInvalidArgument,
          "the record that stands for '" + name + "' leaves it empty");
  Json items = SchemaOf(array[0], name);
  for (const Json& item : array) items = Merged(items, SchemaOf(item, name));
  return items;
}

Json ObjectSchema(const Json& object) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const auto& [key, value] : object.items()) {
    properties[key] = SchemaOf(value, key);
    required.push_back(key);
  }
  return {{"type", "object"}, {"properties", properties}, {"required", required}};
}

Json SchemaOf(const Json& example, const std::string& name) {
  if (example.is_object()) return ObjectSchema(example);
  Json schema;
  if (example.is_array()) {
    schema = {{"type", "array"}, {"items", ItemsOf(example, name)}};
  } else if (example.is_boolean()) {
    schema = {{"type", "boolean"}};
  } else if (example.is_number_unsigned()) {
    schema = {{"type", "integer"}, {"minimum", 0}};
  } else if (example.is_number_integer()) {
    schema = {{"type", "integer"}};
  } else if (example.is_number()) {
    schema = {{"type", "number"}};
  } else {
    schema = {{"type", "string"}};
    if (name == "sha256" || name.ends_with("_sha256")) schema["pattern"] = "^[0-9a-f]{64}$";
  }
  const std::string unit = UnitOfName(name);
  if (!unit.empty()) schema["description"] = "unit: " + unit;
  return schema;
}

// The schema at a place such as "parts[].stage" or "libraries{}".
Json& At(Json& schema, std::string place) {
  Json* here = &schema;
  const std::string whole = place;
  while (!place.empty()) {
    const std::size_t end = std::min(place.find_first_of(".["), place.size());
    const std::string key = place.substr(0, end);
    if (!key.empty()) {
      Require(here->contains("properties") && (*here)["properties"].contains(key),
              ErrorCode::kInvalidArgument, "no record has '" + whole + "' any more");
      here = &(*here)["properties"][key];
    }
    place.erase(0, end);
    if (place.starts_with("[]")) {
      here = &(*here)["items"];
      place.erase(0, 2);
    }
    if (place.starts_with(".")) place.erase(0, 1);
  }
  return *here;
}

// A record's schema, and what its example alone does not show.
class SchemaBuilder {
 public:
  SchemaBuilder(const std::string& name, const Json& example)
      : name_(name), schema_(SchemaOf(example, name)) {
    if (!example.contains("schema")) return;
    At(schema_, "schema") = {{"const", example["schema"]}};
    At(schema_, "schema_version") = {
        {"type", "integer"}, {"minimum", 1}, {"maximum", example["schema_version"]}};
  }

  template <class Names>
  SchemaBuilder& OneOf(const std::string& place, const Names& names) {
    At(schema_, place)["enum"] = names;
    return *this;
  }

  // Earlier builds of this version, or records of another kind, leave the key out.
  SchemaBuilder& Optional(const std::string& parent, const std::string& key) {
    Json& object = At(schema_, parent);
    Json& required = object["required"];
    const auto found = std::find(required.begin(), required.end(), key);
    Require(found != required.end(), ErrorCode::kInvalidArgument,
            "no record has '" + parent + "." + key + "' any more");
    required.erase(found);
    return *this;
  }

  // The object's keys are free: all values are as its first one.
  SchemaBuilder& Map(const std::string& place) {
    Json& object = At(schema_, place);
    const Json value = object["properties"].front();
    object = {{"type", "object"}, {"additionalProperties", value}};
    return *this;
  }

  RecordSchema Finish(const std::string& title) const {
    Json whole = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
    for (const auto& [key, value] : schema_.items()) whole[key] = value;
    return {name_, whole};
  }

 private:
  std::string name_;
  Json schema_;
};

const std::vector<std::string> kStageNames = {"open", "handle", "grasp"};

std::vector<std::string> CategoryNames() {
  std::vector<std::string> names;
  for (const Category category :
       {Category::kInterior, Category::kWindow, Category::kCar, Category::kSafe,
        Category::kStorageFurniture, Category::kRefrigerator})
    names.emplace_back(NameOf(category));
  return names;
}

std::vector<std::string> MechanismNames() {
  std::vector<std::string> names;
  for (const Mechanism mechanism : {Mechanism::kNone, Mechanism::kLever, Mechanism::kRound,
                                    Mechanism::kKey, Mechanism::kValve, Mechanism::kFlap})
    names.emplace_back(NameOf(mechanism));
  return names;
}

std::vector<std::string> OutcomeNames() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kEpisodeOutcomeCount; ++i)
    names.emplace_back(NameOf(static_cast<EpisodeOutcome>(i)));
  return names;
}

RecordSchema DatasetSchema() {
  DatasetRecord record;
  record.parts.emplace_back();
  record.statistics["cloud"] = {{0.0}, {0.0}, {0.0}, {0.0}};
  return SchemaBuilder("dataset", DatasetToJson(record))
      .OneOf("parts[].stage", kStageNames)
      .OneOf("features[].dtype", std::vector<std::string>{"<f4", "<f8", "<i8", "<u2", "|i1", "|u1"})
      .Map("train_statistics")
      .Finish("dataset.json of a doorforge dataset");
}

RecordSchema ProvenanceSchema() {
  DatasetProvenance provenance;
  provenance.libraries["ray_caster"] = "";
  DatasetDoor door;
  door.body.shape.push_back(0.0);
  door.handle.shape.push_back(0.0);
  provenance.doors.push_back(door);
  provenance.planned.emplace_back();
  return SchemaBuilder("provenance", ProvenanceToJson(provenance))
      .Map("libraries")
      .OneOf("doors[].category", CategoryNames())
      .OneOf("doors[].mechanism", MechanismNames())
      .Optional("", "planned")
      .Finish("provenance.json of a doorforge dataset");
}

FailedEpisode ExampleFailure() { return {}; }

RecordSchema ShardIndexSchema() {
  ShardIndex index;
  index.header.number = 0;
  index.tar = "shard-000000.tar";
  index.episodes.push_back({"ep000000", 1, {{"meta.json", 512, 1, 0}}});
  index.failures.push_back(ExampleFailure());
  return SchemaBuilder("shard_index", ParseJson(ShardIndexText(index), "example"))
      .OneOf("stage", kStageNames)
      .Optional("", "index_crc32c")
      .Finish("Index of a shard, beside its tar");
}

RecordSchema EpisodeSchema() {
  Episode episode;
  episode.decisions.emplace_back();
  return SchemaBuilder("episode", EpisodeMetaToJson(episode))
      .OneOf("outcome", OutcomeNames())
      .Finish("meta.json of an episode");
}

RecordSchema FailureSchema() {
  DatasetPart part;
  return SchemaBuilder("failure", ParseJson(FailureLine(ExampleFailure(), part), "example"))
      .OneOf("stage", kStageNames)
      .Finish("A line of failures.jsonl");
}

}  // namespace

std::vector<RecordSchema> RecordSchemas() {
  return {DatasetSchema(), ProvenanceSchema(), ShardIndexSchema(), EpisodeSchema(),
          FailureSchema()};
}

}  // namespace doorforge
