// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <set>

#include "check/checks.h"

namespace doorforge::foreign {
namespace {

template <class Named>
void CheckNames(const std::vector<Named>& things, const char* twice, FaultList& faults) {
  std::map<std::string, int> lines;
  for (const Named& thing : things) {
    if (thing.name.empty()) {
      // a missing attribute is told as such
      if (thing.place.line == 0 || !faults.Has("FIL007")) faults.Add("TRE001", thing.place, "none");
      continue;
    }
    const auto [first, is_new] = lines.emplace(thing.name, thing.place.line);
    if (!is_new)
      faults.Add(twice, thing.place,
                 "\"" + thing.name + "\", also on line " + std::to_string(first->second));
  }
}

void CheckEnds(const ArticulatedObject& object, FaultList& faults) {
  std::set<std::string> links;
  for (const ForeignLink& link : object.links) links.insert(link.name);
  std::map<std::string, int> children;
  for (const ForeignJoint& joint : object.joints) {
    for (const std::string& end : {joint.parent, joint.child}) {
      if (!end.empty() && !links.contains(end))
        faults.Add("TRE004", joint.place, "link \"" + end + "\" does not exist");
    }
    if (!joint.child.empty() && joint.parent == joint.child) {
      faults.Add("TRE008", joint.place, "\"" + joint.child + "\" with itself");
      continue;
    }
    if (joint.child.empty() || !links.contains(joint.child)) continue;
    const auto [first, is_new] = children.emplace(joint.child, joint.place.line);
    if (!is_new)
      faults.Add("TRE005", joint.place,
                 "\"" + joint.child + "\" is the child of the joint on line " +
                     std::to_string(first->second) + ", too");
  }
}

// A link from which the way up does not end.
void CheckLoops(const ArticulatedObject& object, FaultList& faults) {
  std::map<std::string, const ForeignJoint*> above;
  for (const ForeignJoint& joint : object.joints) {
    if (joint.parent != joint.child) above.emplace(joint.child, &joint);
  }
  std::set<std::string> done;
  for (const ForeignLink& link : object.links) {
    std::set<std::string> way;
    std::string at = link.name;
    while (!done.contains(at) && way.insert(at).second && above.contains(at))
      at = above[at]->parent;
    if (way.contains(at) && !done.contains(at) && above.contains(at) && !at.empty()) {
      std::string text = at;
      std::string next = above[at]->parent;
      for (std::size_t i = 0; next != at && i < 8; ++i) {
        text += " below " + next;
        next = above[next]->parent;
      }
      faults.Add("TRE006", above[at]->place, text + " below " + next);
    }
    done.insert(way.begin(), way.end());
  }
}

void CheckRoots(const ArticulatedObject& object, FaultList& faults) {
  if (!object.traits.one_root || faults.Has("TRE004") || faults.Has("TRE006")) return;
  std::set<std::string> children;
  for (const ForeignJoint& joint : object.joints) children.insert(joint.child);
  const ForeignLink* first = nullptr;
  for (const ForeignLink& link : object.links) {
    if (link.name.empty() || children.contains(link.name)) continue;
    if (first == nullptr) {
      first = &link;
      continue;
    }
    faults.Add("TRE007", link.place,
               "\"" + link.name + "\" is a second root beside \"" + first->name + '"');
  }
}

void CheckMimics(const ArticulatedObject& object, FaultList& faults) {
  std::map<std::string, const ForeignJoint*> joints;
  for (const ForeignJoint& joint : object.joints) joints.emplace(joint.name, &joint);
  for (const ForeignJoint& joint : object.joints) {
    if (!joint.mimic) continue;
    if (!joints.contains(joint.mimic->joint)) {
      faults.Add("TRE009", joint.mimic->place,
                 "joint \"" + joint.mimic->joint + "\" does not exist");
      continue;
    }
    std::set<std::string> way;
    const ForeignJoint* at = &joint;
    while (at != nullptr && at->mimic && way.insert(at->name).second) {
      const auto next = joints.find(at->mimic->joint);
      at = next == joints.end() ? nullptr : next->second;
    }
    if (at != nullptr && at->mimic && at->name == joint.name)
      faults.Add("TRE009", joint.mimic->place, "\"" + joint.name + "\" follows itself");
    if (joint.mimic->multiplier == 0)
      faults.Add("JNT013", joint.mimic->place, Measured(joint.mimic->multiplier, ""));
  }
}

}  // namespace

void CheckTree(const ArticulatedObject& object, FaultList& faults) {
  if (object.links.empty()) faults.Add("TRE010", object.place, Measured(0, ""));
  CheckNames(object.links, "TRE002", faults);
  CheckNames(object.joints, "TRE003", faults);
  CheckEnds(object, faults);
  CheckLoops(object, faults);
  CheckRoots(object, faults);
  CheckMimics(object, faults);
}

}  // namespace doorforge::foreign
