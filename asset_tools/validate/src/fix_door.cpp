// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/validate/fix_door.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/part.h"

#include "findings.h"
#include "mend_record.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Findings;

bool Is(const Finding& finding, const Fix& fix) {
  return finding.code == fix.code && finding.where == fix.where;
}

bool Found(const Findings& findings, const Fix& fix) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Finding& finding) { return Is(finding, fix); });
}

bool AnyFixable(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.fixable; });
}

// Codes and places that only the mended copy has.
std::string NewFaults(const Findings& before, const Findings& after) {
  std::string faults;
  for (const Finding& finding : after) {
    if (!Found(before, {finding.code, finding.where, {}}))
      faults += (faults.empty() ? "" : ", ") + finding.code + " at " + finding.where;
  }
  return faults;
}

void CopyInto(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy(from, to, fs::copy_options::recursive | fs::copy_options::copy_symlinks, error);
  if (error) throw Error(ErrorCode::kIo, from.string() + ": cannot be copied: " + error.message());
}

std::vector<Fix> Mend(const fs::path& folder, const Findings& findings) {
  return fs::exists(folder / "door.json") ? internal::MendDoor(folder, findings)
                                          : internal::MendPart(folder, findings);
}

// Says of what is left why it was not mended.
void Explain(const std::string& reason, FixReport& report) {
  for (Finding& finding : report.left) {
    if (finding.fixable) finding.fix += " (not fixed: " + reason + ")";
  }
}

}  // namespace

FixReport FixFolder(const fs::path& folder, FixMode mode) {
  const Findings before = DoorValidator().Validate(folder).findings;
  FixReport report{folder, {}, before};
  if (!AnyFixable(before)) return report;
  // a link to the folder stays one
  const FolderKind& kind = fs::exists(folder / kDoorFolder.record) ? kDoorFolder : kPartFolder;
  StagedFolder staged(fs::canonical(folder), kind, Existing::kReplace);
  CopyInto(folder, staged.path());
  try {
    report.fixes = Mend(staged.path(), before);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kIo) throw;
    report.fixes.clear();
    Explain(error.what(), report);
    return report;
  }
  const Findings after = DoorValidator().Validate(staged.path()).findings;
  std::erase_if(report.fixes, [&](const Fix& fix) { return Found(after, fix); });
  const std::string worse = NewFaults(before, after);
  if (report.fixes.empty() || !worse.empty()) {
    report.fixes.clear();
    Explain(worse.empty() ? "it needs another mesh or number" : "it would break " + worse, report);
    return report;
  }
  report.left = after;
  Explain("it needs another mesh or number", report);
  if (mode == FixMode::kWrite) {
    staged.Commit();
    report.written = true;
  }
  return report;
}

}  // namespace doorforge
