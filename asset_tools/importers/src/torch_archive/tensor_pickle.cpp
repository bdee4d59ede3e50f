// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "torch_archive/tensor_pickle.h"

#include <algorithm>
#include <map>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

// A pickle of a small tensor has about 50 instructions. The limits keep one that repeats itself
// from growing: every value is a copy.
constexpr int kMaxSteps = 1000;
constexpr std::size_t kMaxText = 256;
constexpr std::size_t kMaxItems = 200;  // of a value, in all its levels

enum class Kind { kMark, kNumber, kText, kGlobal, kTuple, kStorage, kTensor, kOther };

struct Value {
  Kind kind = Kind::kOther;
  std::int64_t number = 0;
  std::string text;          // of a global "module.name"; of a storage its element type
  std::vector<Value> items;  // of a tuple; of a tensor the arguments that rebuild it

  std::size_t Size() const {
    std::size_t size = 1;
    for (const Value& item : items) size += item.Size();
    return size;
  }
};

// Opcodes of Python's pickletools, protocols 2 to 4.
class PickleReader {
 public:
  PickleReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Value Run() {
    for (int steps = 0;; ++steps) {
      if (steps > kMaxSteps) Fail("too long");
      const auto code = static_cast<unsigned char>(Take(1)[0]);
      if (code == '.') return Pop();
      Step(code);
    }
  }

  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorCode::kFormat, name_ + ": a pickle that is " + problem +
                                        "; expected a tensor saved by torch.save");
  }

 private:
  void Step(unsigned char code) {
    switch (code) {
      case 0x80:  // PROTO
        Take(1);
        break;
      case 0x95:  // FRAME
        Take(8);
        break;
      case 'q':  // BINPUT
        memo_[Number(1)] = Top();
        break;
      case 'r':  // LONG_BINPUT
        memo_[Number(4)] = Top();
        break;
      case 0x94:  // MEMOIZE
        memo_[static_cast<std::int64_t>(memo_.size())] = Top();
        break;
      case 'h':  // BINGET
        Push(Recall(Number(1)));
        break;
      case 'j':  // LONG_BINGET
        Push(Recall(Number(4)));
        break;
      case 'b':  // BUILD
        Pop();
        break;
      case 'Q':  // BINPERSID
        Push(StorageFrom(Pop()));
        break;
      case 'R':  // REDUCE
        Reduce();
        break;
      default:
        StepConstant(code);
    }
  }

  // instructions that push a value
  void StepConstant(unsigned char code) {
    switch (code) {
      case '(':
        Push({Kind::kMark, 0, {}, {}});
        break;
      case 'K':
        Push({Kind::kNumber, Number(1), {}, {}});
        break;
      case 'M':
        Push({Kind::kNumber, Number(2), {}, {}});
        break;
      case 'J':
        Push({Kind::kNumber, static_cast<std::int32_t>(Number(4)), {}, {}});
        break;
      case 'X':
        Push({Kind::kText, 0, Text(Number(4)), {}});
        break;
      case 0x8c:
        Push({Kind::kText, 0, Text(Number(1)), {}});
        break;
      case 'c': {
        const std::string module = Line();
        Push({Kind::kGlobal, 0, module + "." + Line(), {}});
        break;
      }
      case 0x88:  // True, False
      case 0x89:
        Push({Kind::kNumber, code == 0x88 ? 1 : 0, {}, {}});
        break;
      case 'N':  // None, {} and []
      case '}':
      case ']':
        Push({});
        break;
      default:
        StepTuple(code);
    }
  }

  void StepTuple(unsigned char code) {
    if (code == ')') {
      Push({Kind::kTuple, 0, {}, {}});
    } else if (code == 't') {
      const auto mark = std::find_if(stack_.rbegin(), stack_.rend(),
                                     [](const Value& v) { return v.kind == Kind::kMark; });
      if (mark == stack_.rend()) Fail("broken");
      const auto count = static_cast<std::size_t>(mark - stack_.rbegin());
      Value tuple = TupleOf(count);
      Pop();
      Push(std::move(tuple));
    } else if (code >= 0x85 && code <= 0x87) {
      Push(TupleOf(code - 0x84U));
    } else {
      Fail("not understood at instruction " + std::to_string(code));
    }
  }

  Value TupleOf(std::size_t count) {
    if (count > stack_.size()) Fail("broken");
    Value tuple{Kind::kTuple, 0, {}, {}};
    const auto first = stack_.end() - static_cast<std::ptrdiff_t>(count);
    tuple.items.assign(first, stack_.end());
    stack_.erase(first, stack_.end());
    return tuple;
  }

  // ("storage", torch.FloatStorage, key, device, count)
  Value StorageFrom(const Value& id) const {
    const bool known = id.kind == Kind::kTuple && id.items.size() >= 3 &&
                       id.items[0].text == "storage" && id.items[1].kind == Kind::kGlobal &&
                       id.items[2].kind == Kind::kText;
    if (!known) Fail("not of a tensor");
    return {Kind::kStorage, 0, id.items[1].text, {id.items[2]}};
  }

  void Reduce() {
    const Value arguments = Pop();
    const Value callable = Pop();
    const bool has_arguments = arguments.kind == Kind::kTuple && !arguments.items.empty();
    if (callable.text == "torch._utils._rebuild_tensor_v2") {
      Push({Kind::kTensor, 0, {}, arguments.items});
    } else if (callable.text == "torch._utils._rebuild_parameter" && has_arguments) {
      Push(arguments.items[0]);
    } else {
      Push({});
    }
  }

  std::string_view Take(std::size_t size) {
    if (size > bytes_.size() - at_) Fail("cut off");
    const std::string_view taken = bytes_.substr(at_, size);
    at_ += size;
    return taken;
  }

  std::int64_t Number(std::size_t size) {
    const std::string_view taken = Take(size);
    std::uint64_t number = 0;
    for (std::size_t i = size; i-- > 0;)
      number = number << 8 | static_cast<unsigned char>(taken[i]);
    return static_cast<std::int64_t>(number);
  }

  std::string Text(std::int64_t size) {
    if (size > static_cast<std::int64_t>(kMaxText)) Fail("too long");
    return std::string(Take(static_cast<std::size_t>(size)));
  }

  std::string Line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) Fail("cut off");
    const std::string line = Text(static_cast<std::int64_t>(end - at_));
    ++at_;
    return line;
  }

  void Push(Value value) {
    if (value.Size() > kMaxItems) Fail("too long");
    stack_.push_back(std::move(value));
  }

  const Value& Top() const {
    if (stack_.empty()) Fail("broken");
    return stack_.back();
  }

  Value Pop() {
    if (stack_.empty()) Fail("broken");
    Value value = std::move(stack_.back());
    stack_.pop_back();
    return value;
  }

  const Value& Recall(std::int64_t key) const {
    const auto known = memo_.find(key);
    if (known == memo_.end()) Fail("broken");
    return known->second;
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::vector<Value> stack_;
  std::map<std::int64_t, Value> memo_;
};

std::vector<std::int64_t> NumbersOf(const Value& tuple, const PickleReader& reader) {
  std::vector<std::int64_t> numbers;
  if (tuple.kind != Kind::kTuple) reader.Fail("not of a tensor");
  for (const Value& item : tuple.items) {
    if (item.kind != Kind::kNumber) reader.Fail("not of a tensor");
    numbers.push_back(item.number);
  }
  return numbers;
}

}  // namespace

PickledTensor ParseTensorPickle(std::string_view pickle, const std::string& name) {
  PickleReader reader(pickle, name);
  const Value tensor = reader.Run();
  const bool known = tensor.kind == Kind::kTensor && tensor.items.size() >= 4 &&
                     tensor.items[0].kind == Kind::kStorage &&
                     tensor.items[1].kind == Kind::kNumber;
  if (!known) reader.Fail("not of a tensor");
  PickledTensor parsed;
  parsed.element = tensor.items[0].text.substr(tensor.items[0].text.rfind('.') + 1);
  parsed.key = tensor.items[0].items[0].text;
  parsed.offset = tensor.items[1].number;
  parsed.size = NumbersOf(tensor.items[2], reader);
  parsed.stride = NumbersOf(tensor.items[3], reader);
  if (parsed.size.size() != parsed.stride.size()) reader.Fail("not of a tensor");
  return parsed;
}

}  // namespace doorforge::internal
