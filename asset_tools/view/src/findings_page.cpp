// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/view/findings_page.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/foreign/drawn_object.h"
#include "doorforge/foreign/finding_formats.h"
#include "doorforge/foreign/foreign_rules.h"
#include "doorforge/physics/robot_model.h"

#include "html_page.h"
#include "record_view.h"
#include "show_record.h"

namespace doorforge {
namespace {

using Json = internal::PageContent::Json;

constexpr NamedValue<ForeignJointType> kJointWords[] = {
    {ForeignJointType::kFixed, "fixed"},
    {ForeignJointType::kRevolute, "revolute"},
    {ForeignJointType::kContinuous, "continuous"},
    {ForeignJointType::kPrismatic, "prismatic"},
    {ForeignJointType::kOther, "other"}};

std::string_view WordOf(ForeignJointType type) {
  for (const auto& [value, word] : kJointWords) {
    if (value == type) return word;
  }
  return "other";
}

Json NumberOrNull(const std::optional<std::size_t>& number) {
  return number ? Json(*number) : Json(nullptr);
}

// Six floats an edge, in the shape's frame.
Json EdgesForView(const FindingMark& mark, internal::PageContent& content) {
  if (mark.edges.empty()) return nullptr;
  std::string bytes;
  for (const auto& edge : mark.edges) {
    for (const Eigen::Vector3d& end : edge) {
      for (const double number : end) {
        const auto single = static_cast<float>(number);
        char raw[sizeof single];
        std::memcpy(raw, &single, sizeof single);
        bytes.append(raw, sizeof raw);
      }
    }
  }
  Json edges = content.AddBytes(bytes);
  edges["count"] = mark.edges.size();
  return edges;
}

Json MarkForView(const FindingMark& mark, internal::PageContent& content) {
  return {{"link", NumberOrNull(mark.link)},
          {"joint", NumberOrNull(mark.joint)},
          {"shape", NumberOrNull(mark.shape)},
          {"point_m", mark.point_m ? Json(Vector3ToJson(*mark.point_m)) : Json(nullptr)},
          {"edges", EdgesForView(mark, content)}};
}

Json ShapeForView(const DrawnShape& shape, internal::PageContent& content) {
  return {{"name", shape.name},
          {"link", shape.link},
          {"visual", shape.use != ShapeUse::kCollision},
          {"collision", shape.use != ShapeUse::kVisual},
          {"place", TransformToJson(shape.link_from_shape)},
          {"mesh", content.AddMesh(shape.mesh)}};
}

Json JointForView(const DrawnJoint& joint) {
  return {{"name", joint.name},
          {"type", WordOf(joint.type)},
          {"parent", NumberOrNull(joint.parent)},
          {"child", joint.child},
          {"parent_from_joint", TransformToJson(joint.parent_from_joint)},
          {"child_from_joint", TransformToJson(joint.child_from_joint)},
          {"axis", Vector3ToJson(joint.axis)},
          {"lower", joint.lower},
          {"upper", joint.upper}};
}

Json ObjectForView(const DrawnObject& object, internal::PageContent& content) {
  Json links = Json::array();
  for (const DrawnLink& link : object.links)
    links.push_back(
        {{"name", link.name}, {"world_from_link", TransformToJson(link.world_from_link)}});
  Json shapes = Json::array();
  for (const DrawnShape& shape : object.shapes) shapes.push_back(ShapeForView(shape, content));
  Json joints = Json::array();
  for (const DrawnJoint& joint : object.joints) joints.push_back(JointForView(joint));
  return {{"links", std::move(links)},
          {"shapes", std::move(shapes)},
          {"joints", std::move(joints)},
          {"left_out", object.left_out}};
}

Json FindingForView(const ValidationReport& report, const Finding& finding) {
  const FindingPlace place = PlaceOf(report, finding);
  return {{"code", finding.code},
          {"severity", NameOf(finding.severity)},
          {"rule", AnyRule(finding.code).text},
          {"where", finding.where},
          {"file", place.file},
          {"line", place.line},
          {"measured", finding.measured},
          {"allowed", finding.allowed},
          {"fix", finding.fix}};
}

bool IsRecord(const ValidationReport& report) {
  return report.kind == ValidatedKind::kDoor || report.kind == ValidatedKind::kPart;
}

/// The items of a page, one after the other.
class FindingsPageMaker {
 public:
  explicit FindingsPageMaker(const FindingsPageConfig& config) : config_(config) {}

  ViewPage Make(std::span<const ReportedItem> items) {
    std::vector<Json> shown(items.size());
    Progress progress("drawing", items.size());
    for (const std::size_t i : Order(items)) {
      shown[i] = Item(items[i]);
      progress.Advance();
    }
    content_.document["kind"] = "findings";
    content_.document["version"] = CodeVersion();
    content_.document["items"] = std::move(shown);
    ViewPage page;
    page.shown = drawn_;
    page.html = internal::HtmlPage("doorforge validate", content_);
    return page;
  }

 private:
  // Those with findings are drawn first, so that the limits leave out what nobody looks for.
  static std::vector<std::size_t> Order(std::span<const ReportedItem> items) {
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t i) { return !items[i].report.findings.empty(); });
    return order;
  }

  Json Item(const ReportedItem& item) {
    const ValidationReport& report = item.report;
    Json shown = {{"path", report.folder.string()},
                  {"kind", NameOf(report.kind)},
                  {"errors", report.errors},
                  {"warnings", report.warnings},
                  {"notes", report.notes},
                  {"findings", Json::array()},
                  {"object", nullptr},
                  {"record", nullptr},
                  {"not_drawn", nullptr}};
    for (const Finding& finding : report.findings)
      shown["findings"].push_back(FindingForView(report, finding));
    if (drawn_ >= config_.most_drawn || triangles_ >= config_.all_triangles) {
      shown["not_drawn"] = "The page draws " + std::to_string(drawn_) +
                           " items; validate this one by itself to see it.";
      return shown;
    }
    ++drawn_;
    if (IsRecord(report))
      DrawRecord(report, shown);
    else
      DrawFile(item, shown);
    return shown;
  }

  void DrawRecord(const ValidationReport& report, Json& shown) {
    try {
      if (!robot_) robot_ = LoadMobileFranka();
      internal::ShownRecord record = internal::ShowRecord(report.folder, *robot_, content_);
      internal::AddFindings(report.findings, record.record);
      shown["record"] = std::move(record.record);
    } catch (const Error& error) {
      shown["not_drawn"] = error.what();
    }
  }

  void DrawFile(const ReportedItem& item, Json& shown) {
    const DrawnObject object = DrawForeignFile(item.report, config_.checks, item.searched,
                                               {.most_triangles = config_.most_triangles});
    for (const DrawnShape& shape : object.shapes) triangles_ += shape.mesh.triangles.size();
    shown["object"] = ObjectForView(object, content_);
    for (std::size_t i = 0; i < object.marks.size(); ++i)
      shown["findings"][i]["mark"] = MarkForView(object.marks[i], content_);
  }

  const FindingsPageConfig& config_;
  internal::PageContent content_;
  std::optional<RobotModel> robot_;
  std::size_t drawn_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace

ViewPage MakeFindingsPage(std::span<const ReportedItem> items, const FindingsPageConfig& config) {
  return FindingsPageMaker(config).Make(items);
}

FindingsPage PageOfFindings(const ForeignChecks& checks) {
  return [checks](std::span<const ReportedItem> items) {
    return MakeFindingsPage(items, {.checks = checks}).html;
  };
}

}  // namespace doorforge
