// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace doorforge {
namespace {

using Episodes = std::span<const EvaluatedEpisode>;

template <class... Values>
std::string Format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string Row(const std::string& name, Episodes episodes, Episodes reference) {
  const SuccessSummary summary = Summarise(episodes);
  const SuccessRate& opened = summary.opened;
  std::string row = Format("%-18s %6.1f %%   %5.1f - %5.1f %%   %4d/%-4d   %5.1f +- %4.1f %%",
                           name.c_str(), 100 * opened.rate, 100 * opened.low, 100 * opened.high,
                           opened.successes, opened.episodes, 100 * summary.over_seeds.mean,
                           100 * std::sqrt(summary.over_seeds.variance));
  if (!reference.empty()) row += Format("   %6.1f %%", 100 * Summarise(reference).opened.rate);
  return row + "\n";
}

// Doors with and without a latch are set in under their category.
std::string LabelOf(const EpisodeGroup& group) {
  if (!group.latched) return NameOf(group);
  return *group.latched ? "  with a latch" : "  without";
}

std::string EffortLine(const SuccessSummary& summary) {
  return Format(
      "handle turned: %.1f %%; median time to open %.1f s; greatest force %.0f N (median), %.0f "
      "N\n",
      100 * summary.handle_turned.rate, summary.median_opening_s, summary.median_force_n,
      summary.peak_force_n);
}

std::string ForceLine(const SuccessSummary& summary) {
  std::string line =
      Format("net force on the door: %.0f N (median), %.0f N (99 %%), %.0f N; opened within",
             summary.median_net_force_n, summary.most_net_force_n, summary.peak_net_force_n);
  for (const ForceSuccess& limit : summary.within_force)
    line += Format(" %.0f N %.1f %%%s", limit.limit_n, 100 * limit.success.rate,
                   &limit == &summary.within_force.back() ? "\n" : ",");
  return line;
}

std::string AngleLine(const SuccessSummary& summary) {
  std::string line = "door angle passed: ";
  for (const AngleSuccess& angle : summary.over_angle) {
    line += Format(" %.0f deg %.1f %%%s", angle.angle_rad * 57.29577951308232,
                   100 * angle.success.rate, &angle == &summary.over_angle.back() ? "\n" : ",");
  }
  return line;
}

std::string Causes(const EvaluationReport& report) {
  std::string text;
  for (const FailureCause& cause : CausesOf(report.episodes)) {
    const EvaluatedEpisode& example = report.episodes[cause.first];
    text += Format("  %-16s %4d   ", cause.name.c_str(), cause.episodes) + "such as " +
            example.door_id + ", seed " + std::to_string(example.seed) + ": " + example.detail +
            "\n";
  }
  return text.empty() ? "no failures\n" : "causes of failure\n" + text;
}

// Who acted at each stage.
std::string StagesLine(const ReportProvenance& provenance) {
  const auto actor = [](const std::string& sha256, const char* otherwise) {
    if (sha256.empty()) return std::string(otherwise);
    return IsTrained(sha256) ? "trained " + sha256.substr(0, 12) : sha256;
  };
  if (DidAll(provenance))
    return "grasp, handle and opening: trained " + provenance.policy_sha256.substr(0, 12) + "\n";
  return "grasp: " + actor(provenance.grasper_sha256, "expert") +
         (provenance.finder_sha256.empty()
              ? ""
              : " on a handle found by " + provenance.finder_sha256.substr(0, 12)) +
         "; handle: " + actor(provenance.handler_sha256, "rule") +
         (IsSwitchPredicted(provenance) ? ", which says when it is turned" : "") +
         "; opening: " + actor(provenance.policy_sha256, provenance.policy.c_str()) + "\n";
}

std::string PrivilegesLine(const ReportProvenance& provenance) {
  std::string line;
  for (const std::string& privilege : provenance.privileges)
    line += (line.empty() ? "privileges: " : "; ") + privilege;
  return line.empty() ? line : line + "\n";
}

}  // namespace

std::string ReportTable(const EvaluationReport& report) {
  std::string text =
      Format("%-18s %8s   %15s   %9s   %15s%s\n", "success > 45 deg", "rate", "95 % interval",
             "opened", "over seeds", report.reference.empty() ? "" : "     expert");
  for (const EpisodeGroup& group : GroupsOf(report.episodes))
    text += Row(LabelOf(group), OfGroup(report.episodes, group), OfGroup(report.reference, group));
  const SuccessSummary all = Summarise(report.episodes);
  return text + StagesLine(report.provenance) + PrivilegesLine(report.provenance) +
         EffortLine(all) + ForceLine(all) + AngleLine(all) + Causes(report);
}

}  // namespace doorforge
