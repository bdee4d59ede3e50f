// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/usda_text.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace doorforge {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kLongestPath = 2000;  // each prim below a prim repeats it
constexpr std::size_t kMostPrims = 200'000;

bool IsWordByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool IsIdentifier(std::string_view name) {
  const bool digit_first = !name.empty() && name.front() >= '0' && name.front() <= '9';
  return !name.empty() && !digit_first && std::all_of(name.begin(), name.end(), IsWordByte);
}

enum class UsdaToken { kEnd, kWord, kNumber, kString, kAsset, kPath, kMark };

class UsdaParser {
 public:
  explicit UsdaParser(std::string_view text) : text_(text) {}

  UsdaStage Parse() {
    if (!text_.starts_with("#usda 1.0")) Fail("the file does not begin with #usda 1.0");
    Next();
    if (Sees("(")) stage_.metadata = Metadata();
    while (token_ != UsdaToken::kEnd) Item();
    if (!open_.empty())
      Fail("the text ends inside prim \"" + open_.back()->name + "\", which line " +
           std::to_string(open_.back()->line) + " opens");
    return std::move(stage_);
  }

 private:
  [[noreturn]] void Fail(const std::string& problem, bool limit = false) const {
    throw UsdaFault(token_line_, token_column_, limit, problem);
  }
  bool Sees(std::string_view mark) const { return token_ == UsdaToken::kMark && word_ == mark; }
  bool SeesWord(std::string_view word) const { return token_ == UsdaToken::kWord && word_ == word; }

  void Expect(std::string_view mark) {
    if (!Sees(mark)) Fail("expected \"" + std::string(mark) + "\" before " + Shown());
    Next();
  }

  std::string Shown() const {
    return token_ == UsdaToken::kEnd ? "the end" : "\"" + std::string(word_.substr(0, 40)) + '"';
  }

  // ---- tokens
  void Advance() {
    if (text_[at_] == '\n') {
      ++line_;
      line_begin_ = at_ + 1;
    }
    ++at_;
  }

  void SkipBlanks() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ';') {
        Advance();
      } else {
        return;
      }
    }
  }

  void Next() {
    SkipBlanks();
    token_line_ = line_;
    token_column_ = static_cast<int>(at_ - line_begin_) + 1;
    if (at_ >= text_.size()) {
      token_ = UsdaToken::kEnd;
      return;
    }
    const char c = text_[at_];
    const std::string_view rest = text_.substr(at_);
    if (c == '"' || c == '\'') return String(c);
    if (c == '@') return Quoted(rest.starts_with("@@@") ? "@@@" : "@", UsdaToken::kAsset);
    if (c == '<') return Path();
    const bool signs = c == '-' || c == '+' || c == '.';
    if ((c >= '0' && c <= '9') || signs) return Number();
    if (IsWordByte(c)) return Word();
    if (std::string_view("()[]{}=,:").find(c) == std::string_view::npos)
      Fail("the character \"" + std::string(1, c) + "\"");
    token_ = UsdaToken::kMark;
    word_ = text_.substr(at_, 1);
    Advance();
  }

  void String(char quote) {
    const std::string three(3, quote);
    Quoted(text_.substr(at_).starts_with(three) ? std::string_view(three)
                                                : std::string_view(&quote, 1),
           UsdaToken::kString);
  }

  void Quoted(std::string_view mark, UsdaToken token) {
    for (std::size_t i = 0; i < mark.size(); ++i) Advance();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !text_.substr(at_).starts_with(mark)) {
      if (mark.size() == 1 && text_[at_] == '\n') Fail("a line ends inside quotes");
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) Advance();
      Advance();
    }
    if (at_ >= text_.size()) Fail("the text ends inside quotes");
    word_ = text_.substr(begin, at_ - begin);
    for (std::size_t i = 0; i < mark.size(); ++i) Advance();
    token_ = token;
  }

  void Path() {
    Advance();
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '>') {
      if (text_[at_] == '\n') Fail("a line ends inside a path");
      Advance();
    }
    if (at_ >= text_.size()) Fail("the text ends inside a path");
    word_ = text_.substr(begin, at_ - begin);
    Advance();
    token_ = UsdaToken::kPath;
  }

  void Number() {
    std::size_t begin = at_;
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("-inf") || rest.starts_with("+inf")) {
      at_ += 4;
      word_ = rest.substr(0, 4);
      number_ = word_[0] == '-' ? -kInfinite : kInfinite;
      token_ = UsdaToken::kNumber;
      return;
    }
    if (text_[begin] == '+') ++begin;
    const char* last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(text_.data() + begin, last, number_);
    if (error == std::errc::invalid_argument) Fail("no number");
    if (error == std::errc::result_out_of_range)  // what is too small to be held is 0
      number_ = std::strtod(std::string(text_.data() + begin, end).c_str(), nullptr);
    word_ = text_.substr(at_, static_cast<std::size_t>(end - text_.data()) - at_);
    at_ = static_cast<std::size_t>(end - text_.data());
    token_ = UsdaToken::kNumber;
  }

  // Names of properties have colons and dots inside.
  void Word() {
    const std::size_t begin = at_;
    const auto joins = [&] {
      const char c = text_[at_];
      return (c == ':' || c == '.') && at_ + 1 < text_.size() && IsWordByte(text_[at_ + 1]);
    };
    while (at_ < text_.size() && (IsWordByte(text_[at_]) || joins())) ++at_;
    word_ = text_.substr(begin, at_ - begin);
    token_ = UsdaToken::kWord;
  }

  // ---- grammar
  void Item() {
    if (Sees("}")) {
      if (open_.empty()) Fail("a \"}\" that nothing opens");
      open_.pop_back();
      return Next();
    }
    if (SeesWord("def") || SeesWord("over") || SeesWord("class")) return Prim();
    if (open_.empty()) Fail("expected def, over or class before " + Shown());
    if (SeesWord("variantSet")) return Variants();
    open_.back()->properties.push_back(Property(false));
  }

  void Prim() {
    if (stage_.prims.size() >= kMostPrims) Fail("more than the 200000 prims allowed", true);
    if (open_.size() >= static_cast<std::size_t>(kDeepest))
      Fail("more than the 64 levels of prims allowed", true);
    UsdaPrim& prim = stage_.prims.emplace_back();
    prim.defined = SeesWord("def");
    prim.line = token_line_;
    prim.column = token_column_;
    prim.parent = open_.empty() ? nullptr : open_.back();
    Next();
    if (token_ == UsdaToken::kWord) {
      prim.type = word_;
      Next();
    }
    if (token_ != UsdaToken::kString) Fail("expected a prim's name before " + Shown());
    if (!IsIdentifier(word_)) Fail(Shown() + " is no name of a prim");
    prim.name = word_;
    prim.path = (prim.parent == nullptr ? "" : prim.parent->path) + "/" + prim.name;
    if (prim.path.size() > kLongestPath)
      Fail("a path of more than the " + std::to_string(kLongestPath) + " bytes allowed", true);
    Next();
    if (Sees("(")) prim.metadata = Metadata();
    Expect("{");
    open_.push_back(&prim);
  }

  // What variants hold is passed over, brace by brace.
  void Variants() {
    while (token_ != UsdaToken::kEnd && !Sees("{")) Next();
    PassBraces();
  }

  void PassBraces() {
    int depth = 0;
    do {
      if (Sees("{")) ++depth;
      if (Sees("}")) --depth;
      if (token_ == UsdaToken::kEnd) Fail("the text ends inside braces");
      Next();
    } while (depth > 0);
  }

  std::vector<UsdaProperty> Metadata() {
    std::vector<UsdaProperty> entries;
    // an entry may have metadata, and those theirs
    if (++open_metadata_ > kDeepest)
      Fail("metadata nested deeper than the 64 levels allowed", true);
    Expect("(");
    while (!Sees(")")) {
      if (token_ == UsdaToken::kEnd) Fail("the text ends inside metadata");
      if (token_ == UsdaToken::kString) {  // a comment of the prim
        Next();
        continue;
      }
      entries.push_back(Property(true));
    }
    --open_metadata_;
    Next();
    return entries;
  }

  // What may stand before a type, and in metadata before a name.
  static bool IsListOperation(std::string_view word) {
    return word == "add" || word == "append" || word == "prepend" || word == "delete" ||
           word == "reorder";
  }
  static bool IsQualifier(std::string_view word) {
    return IsListOperation(word) || word == "custom" || word == "uniform" || word == "varying" ||
           word == "config";
  }

  // [operation] name, or [qualifiers] type name, or reorder properties.
  void RequireOrder(const std::vector<std::string_view>& words, bool metadata) const {
    std::size_t before = 0;
    while (before + 1 < words.size() &&
           (metadata ? IsListOperation(words[before]) : IsQualifier(words[before])))
      ++before;
    const std::size_t left = words.size() - before;
    const bool reorders = before > 0 && words[before - 1] == "reorder";
    const bool fits = metadata ? left == 1 && before <= 1 : left == 2 || (left == 1 && reorders);
    if (!fits)
      Fail("\"" + std::string(words.front().substr(0, 40)) + "\" does not begin " +
           (metadata ? "an entry of metadata" : "a property") + ", before " + Shown());
  }

  // Words before "=", of which the last is the name. All stand on one line with "=" and the
  // value's beginning.
  UsdaProperty Property(bool metadata) {
    UsdaProperty property;
    property.line = token_line_;
    property.column = token_column_;
    if (token_ != UsdaToken::kWord) Fail("expected a name before " + Shown());
    std::vector<std::string_view> words;
    while (token_ == UsdaToken::kWord && token_line_ == property.line) {
      words.push_back(word_);
      Next();
      if (!Sees("[")) continue;  // float3[]
      Next();
      Expect("]");
    }
    RequireOrder(words, metadata);
    property.name = words.back();
    const bool same_line = token_line_ == property.line;
    if (metadata && !(Sees("=") && same_line)) Fail("expected \"=\" before " + Shown());
    if (Sees("=")) {
      if (!same_line) Fail("expected \"=\" on the line of \"" + property.name + '"');
      Next();
      if (token_line_ != property.line)
        Fail("expected the value of \"" + property.name + "\" on its line");
      Value(property.value, 0);
    }
    if (Sees("(")) Metadata();
    return property;
  }

  void Value(UsdaValue& value, int depth) {
    if (depth > kDeepest) Fail("values nested deeper than the 64 levels allowed", true);
    if (Sees("{")) return PassBraces();
    if (Sees("[") || Sees("(")) return List(value, depth);
    switch (token_) {
      case UsdaToken::kNumber:
        value.numbers.push_back(number_);
        break;
      case UsdaToken::kString:
        value.texts.emplace_back(word_);
        break;
      case UsdaToken::kWord:
        value.texts.emplace_back(word_);
        break;
      case UsdaToken::kAsset:
        value.assets.emplace_back(word_);
        break;
      case UsdaToken::kPath:
        value.paths.emplace_back(word_);
        break;
      default:
        Fail("expected a value before " + Shown());
    }
    const bool asset = token_ == UsdaToken::kAsset;
    Next();
    if (!asset) return;
    // a reference names a prim of its file and may be moved in time
    if (token_ == UsdaToken::kPath) Next();
    if (Sees("(")) Metadata();
  }

  void List(UsdaValue& value, int depth) {
    const std::string_view end = Sees("[") ? "]" : ")";
    Next();
    while (!Sees(end)) {
      if (token_ == UsdaToken::kEnd) Fail("the text ends inside a list");
      Value(value, depth + 1);
      if (Sees(","))
        Next();
      else if (!Sees(end))
        Fail("expected \",\" or \"" + std::string(end) + "\" before " + Shown());
    }
    Next();
  }

  static constexpr double kInfinite = 1e308;

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  int line_ = 1;
  UsdaToken token_ = UsdaToken::kEnd;
  std::string_view word_;
  double number_ = 0;
  int token_line_ = 1;
  int token_column_ = 1;
  UsdaStage stage_;
  std::vector<UsdaPrim*> open_;
  int open_metadata_ = 0;
};

const UsdaProperty* Named(const std::vector<UsdaProperty>& properties, std::string_view wanted) {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const UsdaProperty& one) { return one.name == wanted; });
  return found == properties.end() ? nullptr : &*found;
}

}  // namespace

const UsdaProperty* UsdaPrim::Property(std::string_view wanted) const {
  return Named(properties, wanted);
}
const UsdaProperty* UsdaPrim::Metadata(std::string_view wanted) const {
  return Named(metadata, wanted);
}
bool UsdaPrim::HasApi(std::string_view schema) const {
  const UsdaProperty* schemas = Metadata("apiSchemas");
  return schemas != nullptr && std::find(schemas->value.texts.begin(), schemas->value.texts.end(),
                                         schema) != schemas->value.texts.end();
}

UsdaStage ParseUsda(std::string_view text) { return UsdaParser(text).Parse(); }

}  // namespace doorforge
