// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "text/xml_text.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <unordered_map>

namespace doorforge::foreign {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Bytes of letters beyond ASCII are taken as part of a name, whichever letters they make.
bool BeginsName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool ContinuesName(char c) {
  return BeginsName(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

// Bytes of the character at the beginning, or 0 where it is no UTF-8 or no character of XML.
std::size_t CharacterBytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || IsSpace(text[0]) ? 1 : 0;
  const std::size_t count = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < count) return 0;
  std::uint32_t code = first & (0x7FU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool overlong = (count == 3 && code < 0x800) || (count == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate || code > 0x10FFFF || code == 0xFFFE || code == 0xFFFF ? 0 : count;
}

void AppendUtf8(std::uint32_t code, std::string& text) {
  const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return add(code);
  if (code < 0x800) {
    add(0xC0U | code >> 6U);
  } else {
    if (code < 0x10000) {
      add(0xE0U | code >> 12U);
    } else {
      add(0xF0U | code >> 18U);
      add(0x80U | (code >> 12U & 0x3FU));
    }
    add(0x80U | (code >> 6U & 0x3FU));
  }
  add(0x80U | (code & 0x3FU));
}

// A path is made for every fault, so its steps are short whatever the names are.
constexpr std::size_t kLongestStep = 300;

std::string StepTo(const XmlElement& element) { return "/" + element.name.substr(0, kLongestStep); }

// Says which of its parent's children each child is. Once for all, since a parent may have many.
void NameSteps(const std::vector<XmlElement*>& children) {
  std::unordered_map<std::string, std::size_t> tags;
  std::unordered_map<std::string, std::size_t> names;
  const auto named = [](const XmlElement& element) {
    const XmlAttribute* name = element.Attribute("name");
    return name == nullptr ? std::string() : element.name + "[@name='" + name->value + "']";
  };
  for (const XmlElement* child : children) {
    ++tags[child->name];
    ++names[named(*child)];
  }
  std::unordered_map<std::string, std::size_t> seen;
  for (XmlElement* child : children) {
    const std::size_t number = ++seen[child->name];
    const std::string by_name = named(*child);
    const bool only = tags[child->name] == 1;
    child->step = StepTo(*child) + (only ? "" : "[" + std::to_string(number) + "]");
    if (!by_name.empty() && by_name.size() <= kLongestStep && names[by_name] == 1)
      child->step = "/" + by_name;
  }
}

// Strict where a library would go on, since what it makes of a fault is not what another program
// does; and it knows line and column of each attribute.
class XmlParser {
 public:
  XmlParser(std::string_view text, const XmlLimits& limits) : text_(text), limits_(limits) {}

  XmlDocument Parse() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
      Fail("the text is UTF-16; write it as UTF-8");
    while (at_ < text_.size()) Step();
    if (!open_.empty())
      Fail("the text ends inside <" + open_.back()->name + ">, which line " +
           std::to_string(open_.back()->line) + " opens");
    if (document_.root == nullptr) Fail("no element in it");
    NameAll();
    return std::move(document_);
  }

 private:
  void NameAll() {
    document_.elements.front().step = StepTo(document_.elements.front());
    std::unordered_map<const XmlElement*, std::vector<XmlElement*>> families;
    for (XmlElement& element : document_.elements) {
      if (element.parent != nullptr) families[element.parent].push_back(&element);
    }
    for (const auto& [parent, children] : families) NameSteps(children);
  }

  [[noreturn]] void Fail(const std::string& problem,
                         XmlFaultKind kind = XmlFaultKind::kNotWellFormed) const {
    throw XmlFault(kind, line_, Column(), problem);
  }
  // Bytes, as compilers count: an editor that counts letters is off by those beyond ASCII.
  int Column() const { return static_cast<int>(at_ - line_begin_) + 1; }
  bool Sees(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  bool AtEnd() const { return at_ >= text_.size(); }

  void Advance(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, ++at_) {
      if (text_[at_] != '\n') continue;
      ++line_;
      line_begin_ = at_ + 1;
    }
  }

  // Past one character of text, which is checked.
  void AdvanceCharacter() {
    const std::size_t bytes = CharacterBytes(text_.substr(at_));
    if (bytes == 0) Fail("a byte that is no character of XML in UTF-8");
    Advance(bytes);
  }

  void AdvancePast(std::string_view end, const std::string& what) {
    while (!Sees(end)) {
      if (AtEnd()) Fail("the text ends inside " + what);
      AdvanceCharacter();
    }
    Advance(end.size());
  }

  void SkipSpace() {
    while (!AtEnd() && IsSpace(text_[at_])) Advance(1);
  }

  void Step() {
    if (text_[at_] != '<') return Text();
    if (Sees("<!--")) return Comment();
    if (Sees("<![CDATA[")) return Cdata();
    if (Sees("<!"))
      Fail("a DOCTYPE or another declaration; no object needs one", XmlFaultKind::kDeclaration);
    if (Sees("<?")) return Instruction();
    if (Sees("</")) return Close();
    Open();
  }

  void Instruction() {
    // a byte order mark may stand before it
    const bool first = at_ == 0 || (at_ == 3 && line_ == 1 && text_.starts_with("\xEF\xBB\xBF"));
    Advance(2);
    const std::string name = Name();
    const bool declares = name.size() == 3 && (name[0] | 0x20) == 'x' && (name[1] | 0x20) == 'm' &&
                          (name[2] | 0x20) == 'l';
    if (!declares) return AdvancePast("?>", "a processing instruction");
    if (!first || name != "xml") Fail("an XML declaration that does not begin the file");
    XmlElement declaration;
    declaration.name = "?xml";
    while (true) {
      const bool spaced = !AtEnd() && IsSpace(text_[at_]);
      SkipSpace();
      if (Sees("?>")) break;
      if (!spaced) Fail("expected a blank or \"?>\" in the XML declaration");
      ReadAttribute(declaration);
    }
    Advance(2);
    const XmlAttribute* version = declaration.Attribute("version");
    if (version == nullptr || !version->value.starts_with("1."))
      Fail("the XML declaration states no version 1.0");
  }

  void Comment() {
    Advance(4);
    while (!Sees("--")) {
      if (AtEnd()) Fail("the text ends inside a comment");
      AdvanceCharacter();
    }
    if (!Sees("-->")) Fail("\"--\" inside a comment");
    Advance(3);
  }

  void Cdata() {
    if (open_.empty()) Fail("CDATA outside the root element");
    const std::size_t begin = at_ + 9;
    AdvancePast("]]>", "a CDATA section");
    open_.back()->text += text_.substr(begin, at_ - 3 - begin);
  }

  void Text() {
    if (open_.empty()) {
      if (!IsSpace(text_[at_])) Fail("text outside the root element");
      return SkipSpace();
    }
    while (!AtEnd() && text_[at_] != '<') {
      if (Sees("]]>")) Fail("\"]]>\" in text");
      AppendCharacter(open_.back()->text);
    }
  }

  void AppendCharacter(std::string& to) {
    if (text_[at_] == '&') return AppendReference(to);
    const std::size_t begin = at_;
    AdvanceCharacter();
    to += text_.substr(begin, at_ - begin);
  }

  void AppendReference(std::string& to) {
    const std::size_t end = text_.find(';', at_);
    const std::string_view name =
        end == std::string_view::npos
            ? ""
            : text_.substr(at_ + 1, std::min<std::size_t>(end - at_ - 1, 12));  // none is longer
    constexpr std::pair<std::string_view, char> kKnown[] = {
        {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    const auto* known = std::find_if(std::begin(kKnown), std::end(kKnown),
                                     [&](const auto& row) { return row.first == name; });
    if (known != std::end(kKnown)) {
      to += known->second;
    } else if (name.starts_with('#')) {
      AppendUtf8(CodeOf(name.substr(1)), to);
    } else {
      Fail("\"&\" begins no reference that XML knows; write &amp; for the character");
    }
    Advance(end + 1 - at_);
  }

  std::uint32_t CodeOf(std::string_view digits) const {
    const bool hexadecimal = digits.starts_with('x');
    if (hexadecimal) digits.remove_prefix(1);
    std::uint32_t code = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
    const bool control = code < 0x20 && code != 9 && code != 10 && code != 13;
    if (error != std::errc{} || end != digits.data() + digits.size() || control ||
        code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF))
      Fail("a reference to no character of XML");
    return code;
  }

  std::string Name() {
    const std::size_t begin = at_;
    if (AtEnd() || !BeginsName(text_[at_])) Fail("expected a name");
    while (!AtEnd() && ContinuesName(text_[at_])) Advance(1);
    return std::string(text_.substr(begin, at_ - begin));
  }

  XmlElement& NewElement() {
    if (document_.elements.size() >= limits_.elements)
      Fail("more than the " + std::to_string(limits_.elements) + " elements allowed",
           XmlFaultKind::kLimit);
    if (open_.size() >= limits_.depth)
      Fail("more than the " + std::to_string(limits_.depth) + " levels of elements allowed",
           XmlFaultKind::kLimit);
    // elements lie in a deque, so that pointers to them hold while more are added
    if (open_.empty() && document_.root != nullptr) Fail("a second root element");
    XmlElement& element = document_.elements.emplace_back();
    element.line = line_;
    element.column = Column();
    if (open_.empty()) {
      document_.root = &element;
    } else {
      element.parent = open_.back();
      open_.back()->children.push_back(&element);
    }
    return element;
  }

  void Open() {
    XmlElement& element = NewElement();
    Advance(1);
    element.name = Name();
    while (true) {
      const bool spaced = !AtEnd() && IsSpace(text_[at_]);
      SkipSpace();
      if (AtEnd()) Fail("the text ends inside <" + element.name + ">");
      if (Sees("/>")) return Advance(2);
      if (Sees(">")) {
        Advance(1);
        return open_.push_back(&element);
      }
      if (!spaced) Fail("expected a blank, \">\" or \"/>\" in <" + element.name + ">");
      ReadAttribute(element);
    }
  }

  void ReadAttribute(XmlElement& element) {
    if (element.attributes.size() >= limits_.attributes)
      Fail("more than the " + std::to_string(limits_.attributes) + " attributes allowed",
           XmlFaultKind::kLimit);
    XmlAttribute attribute{{}, {}, line_, Column()};
    attribute.name = Name();
    if (element.Attribute(attribute.name) != nullptr)
      Fail("<" + element.name + "> has the attribute " + attribute.name + " twice");
    SkipSpace();
    if (!Sees("=")) Fail("expected \"=\" after the attribute " + attribute.name);
    Advance(1);
    SkipSpace();
    if (!Sees("\"") && !Sees("'")) Fail("the value of " + attribute.name + " has no quotes");
    const char quote = text_[at_];
    Advance(1);
    while (!AtEnd() && text_[at_] != quote) {
      if (text_[at_] == '<') Fail("\"<\" in the value of " + attribute.name);
      AppendCharacter(attribute.value);
    }
    if (AtEnd()) Fail("the text ends inside the value of " + attribute.name);
    // a name is repeated by all that refer to it; lists of numbers are not
    if (attribute.value.size() > limits_.name_bytes &&
        attribute.value.find_first_not_of("0123456789+-.eE \t\r\n") != std::string::npos)
      Fail("a value of more than the " + std::to_string(limits_.name_bytes) + " bytes allowed",
           XmlFaultKind::kLimit);
    Advance(1);
    element.attributes.push_back(std::move(attribute));
  }

  void Close() {
    if (open_.empty()) Fail("an end tag outside the root element");
    Advance(2);
    const XmlElement& element = *open_.back();
    const std::string name = Name();
    if (name != element.name)
      Fail("</" + name + "> where </" + element.name + "> is expected, which line " +
           std::to_string(element.line) + " opens");
    SkipSpace();
    if (!Sees(">")) Fail("expected \">\" in </" + name);
    Advance(1);
    open_.pop_back();
  }

  std::string_view text_;
  XmlLimits limits_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  int line_ = 1;
  XmlDocument document_;
  std::vector<XmlElement*> open_;
};

}  // namespace

const XmlAttribute* XmlElement::Attribute(std::string_view wanted) const {
  for (const XmlAttribute& attribute : attributes) {
    if (attribute.name == wanted) return &attribute;
  }
  return nullptr;
}

const XmlElement* XmlElement::Child(std::string_view wanted) const {
  for (const XmlElement* child : children) {
    if (child->name == wanted) return child;
  }
  return nullptr;
}

XmlDocument ParseXml(std::string_view text, const XmlLimits& limits) {
  return XmlParser(text, limits).Parse();
}

std::string XPathOf(const XmlElement& element) {
  std::string path;
  for (const XmlElement* at = &element; at != nullptr; at = at->parent) path = at->step + path;
  return path;
}

}  // namespace doorforge::foreign
