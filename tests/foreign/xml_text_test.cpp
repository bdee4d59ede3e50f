// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "text/xml_text.h"

#include <gtest/gtest.h>

namespace doorforge::foreign {
namespace {

TEST(XmlText, APathNamesElementsByTheirNames) {
  const XmlDocument document = ParseXml("<a><b name='x'><c/></b><b name='y'/></a>");
  EXPECT_EQ(XPathOf(document.elements[2]), "/a/b[@name='x']/c");
}

// A path is made for every fault of a file: megabytes of a name may not be in it.
TEST(XmlText, APathIsShortWhateverTheNamesAre) {
  const std::string tag(1'000'000, 'n');
  const std::string name(1000, 'n');
  const XmlDocument document =
      ParseXml("<" + tag + "><b name='" + name + "'><c/></b><b/></" + tag + ">");
  EXPECT_EQ(XPathOf(document.elements[2]), "/" + std::string(300, 'n') + "/b[1]/c");
}

// Each body of an MJCF names the one around it: a long name would be there as often as it has
// bodies.
TEST(XmlText, ANameOfManyBytesIsRefusedAndAListOfNumbersIsNot) {
  EXPECT_EQ(ParseXml("<a b='" + std::string(1024, 'n') + "'/>").elements.size(), 1U);
  EXPECT_EQ(ParseXml("<a b='" + std::string(2000, '1') + " -2.5e3\n'/>").elements.size(), 1U);
  try {
    ParseXml("<a b='" + std::string(1025, 'n') + "'/>");
    FAIL() << "it was read";
  } catch (const XmlFault& fault) {
    EXPECT_EQ(fault.kind, XmlFaultKind::kLimit);
  }
}

}  // namespace
}  // namespace doorforge::foreign
