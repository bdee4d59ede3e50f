// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "read/glb_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::uint64_t kMostStride = 252;  // byteStride in the specification

// Codes, sizes and names are those of the glTF 2.0 specification, section 3.6.2.
struct ComponentType {
  int code;
  std::uint64_t bytes;
};
constexpr std::array<ComponentType, 6> kComponents = {
    {{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}}};
constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> kTypes = {
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

// Copies: nothing in a file from outside is sure to be aligned.
std::uint32_t WordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// Characters that are no digits are passed over, as browsers do; a length that is then short is a
// fault of its own.
std::string DecodedBase64(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t value =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
            .find(c);
    if (value == std::string_view::npos) continue;
    bits = bits << 6U | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xFFU);
  }
  return bytes;
}

// A document from outside may have any type anywhere: what is not there, or not an object, reads as
// nothing, and the check that needs it says so.
const Json kNothing;

const Json& Member(const Json& json, const char* key) {
  if (!json.is_object()) return kNothing;
  const auto found = json.find(key);
  return found == json.end() ? kNothing : *found;
}

/// Where an accessor's elements lie.
struct Elements {
  std::string_view bytes;  // from the first one on
  std::uint64_t stride = 0;
  std::uint64_t count = 0;
  int component = 0;
  std::uint64_t numbers = 0;

  double Float(std::uint64_t element, std::uint64_t number) const {
    float value = 0;
    std::memcpy(&value, bytes.data() + element * stride + number * 4, sizeof value);
    return value;
  }
  std::uint64_t Index(std::uint64_t element) const {
    const char* at = bytes.data() + element * stride;
    if (component == 5121) return static_cast<unsigned char>(*at);
    if (component == 5123) {
      std::uint16_t value = 0;
      std::memcpy(&value, at, sizeof value);
      return value;
    }
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
};

class GltfCheck {
  static constexpr std::uint64_t kMostElements = 200'000'000;
  static constexpr std::size_t kMostLevels = 1000;
  static constexpr std::uint64_t kMostBufferBytes = 1ULL << 29U;

 public:
  GltfCheck(std::string file, const BufferReader& reader, FaultList& faults)
      : file_(std::move(file)), reader_(reader), faults_(faults) {}

  TriangleMesh Check(std::string_view bytes) {
    const bool binary = bytes.size() >= 4 && WordAt(bytes, 0) == kMagic;
    std::string_view text = bytes;
    if (binary && !Chunks(bytes, text)) return {};
    try {
      document_ = ParseJson(text, file_);
    } catch (const Error& error) {
      Fail("FIL002", "", error.what());
      return {};
    }
    if (!Member(Member(document_, "asset"), "version").is_string()) {
      Fail("FIL007", "/asset", "no asset.version");
      return {};
    }
    // each step reads what the one before found sound
    CheckBuffers();
    CheckViews();
    CheckAccessors();
    CheckReferences();
    CheckNodes();
    CheckMeshes();
    return std::move(triangles_);
  }

 private:
  void Fail(std::string_view code, const std::string& pointer, const Measured& measured) {
    faults_.Add(code, {file_, 0, 0, pointer}, measured);
  }

  // The text of the JSON chunk, and binary_; false where the container does not hold.
  bool Chunks(std::string_view bytes, std::string_view& text) {
    if (bytes.size() < 20) return Broken("the file ends inside its header");
    if (WordAt(bytes, 4) != 2) return Broken("version " + std::to_string(WordAt(bytes, 4)));
    if (WordAt(bytes, 8) != bytes.size())
      return Broken("its header says " + std::to_string(WordAt(bytes, 8)) +
                    " bytes, the file has " + std::to_string(bytes.size()));
    std::size_t at = 12;
    for (int number = 0; at < bytes.size(); ++number) {
      if (at + 8 > bytes.size()) return Broken("the file ends inside the header of a chunk");
      const std::uint64_t length = WordAt(bytes, at);
      const std::uint32_t type = WordAt(bytes, at + 4);
      if (at + 8 + length > bytes.size())
        return Broken("chunk " + std::to_string(number) + " of " + std::to_string(length) +
                      " bytes goes beyond the end of the file");
      if (length % 4 != 0)
        return Broken("the length of chunk " + std::to_string(number) + " is no multiple of 4");
      const std::string_view content = bytes.substr(at + 8, length);
      if (number == 0 && type != kJsonChunk) return Broken("the first chunk is not JSON");
      if (number == 0) text = content;
      if (number == 1 && type == kBinaryChunk) {
        binary_ = content;
        has_binary_ = true;
      }
      at += 8 + length;
    }
    return true;
  }

  bool Broken(const std::string& problem) {
    Fail("GLB001", "", problem);
    return false;
  }

  const Json& List(const char* key) const {
    const Json& list = Member(document_, key);
    return list.is_array() ? list : kNothing;
  }

  std::uint64_t Unsigned(const Json& json, const char* key, std::uint64_t fallback,
                         const std::string& pointer) {
    const Json& number = Member(json, key);
    if (number.is_null()) return fallback;
    // below 2^40, sums of three such numbers cannot overflow
    if (number.is_number_unsigned() && number.get<std::uint64_t>() < (1ULL << 40U))
      return number.get<std::uint64_t>();
    Fail("FIL006", pointer + "/" + key, "no whole number of 0 and more");
    return fallback;
  }

  static std::string At(const std::string& list, std::size_t i) {
    return "/" + list + "/" + std::to_string(i);
  }

  void CheckBuffers() {
    const Json& buffers = List("buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::string pointer = At("buffers", i);
      const std::uint64_t length = Unsigned(buffers[i], "byteLength", 0, pointer);
      if (length == 0) Fail("FIL007", pointer, "no byteLength of 1 and more");
      std::string_view content = BufferContent(buffers[i], i, pointer);
      // a buffer that could not be read has its own finding
      if (content.size() < length && !missing_.back())
        Fail("GLB003", pointer + "/byteLength",
             std::to_string(length) + " bytes, there are " + std::to_string(content.size()));
      buffers_.push_back(content.substr(0, length));
    }
  }

  std::string_view BufferContent(const Json& buffer, std::size_t number,
                                 const std::string& pointer) {
    missing_.push_back(false);
    const Json& uri = Member(buffer, "uri");
    if (!uri.is_string()) {
      if (number == 0 && has_binary_) return binary_;
      Fail("GLB003", pointer, "neither a uri nor a binary chunk");
      missing_.back() = true;
      return {};
    }
    if (buffer_bytes_ > kMostBufferBytes) {
      Fail("FIL003", pointer, "buffers of more than the 512 MiB allowed");
      missing_.back() = true;
      return {};
    }
    const auto& text = uri.get_ref<const std::string&>();
    if (text.starts_with("data:")) {
      const std::size_t comma = text.find(',');
      return Kept(DecodedBase64(comma == std::string::npos ? "" : text.substr(comma + 1)));
    }
    auto content = reader_ ? reader_({text, {file_, 0, 0, pointer + "/uri"}, false})
                           : std::optional<std::string>();
    missing_.back() = !content;
    return content ? Kept(std::move(*content)) : std::string_view();
  }

  std::string_view Kept(std::string content) {
    buffer_bytes_ += content.size();
    owned_.push_back(std::move(content));
    return owned_.back();
  }

  void CheckViews() {
    const Json& views = List("bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::string pointer = At("bufferViews", i);
      const std::uint64_t buffer = Unsigned(views[i], "buffer", 1ULL << 39U, pointer);
      const std::uint64_t offset = Unsigned(views[i], "byteOffset", 0, pointer);
      const std::uint64_t length = Unsigned(views[i], "byteLength", 0, pointer);
      views_.emplace_back();
      holds_.push_back(false);
      if (buffer >= buffers_.size()) {
        Fail("GLB002", pointer + "/buffer", Count(buffer, buffers_.size()));
        continue;
      }
      if (offset + length > buffers_[buffer].size()) {
        if (!missing_[buffer])
          Fail("GLB003", pointer,
               "ends at byte " + std::to_string(offset + length) + " of " +
                   std::to_string(buffers_[buffer].size()));
        continue;
      }
      views_.back() = buffers_[buffer].substr(offset, length);
      holds_.back() = true;
    }
  }

  static std::string Count(std::uint64_t index, std::size_t count) {
    return (index >= 1ULL << 39U ? "none" : std::to_string(index)) + " of " + std::to_string(count);
  }

  void CheckAccessors() {
    const Json& accessors = List("accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i)
      accessors_.push_back(Accessor(accessors[i], At("accessors", i)));
  }

  std::optional<Elements> Accessor(const Json& accessor, const std::string& pointer) {
    Elements elements;
    elements.count = Unsigned(accessor, "count", 0, pointer);
    elements.component = static_cast<int>(Unsigned(accessor, "componentType", 0, pointer));
    const auto component =
        std::find_if(kComponents.begin(), kComponents.end(),
                     [&](const auto& one) { return one.code == elements.component; });
    const Json& type_name = Member(accessor, "type");
    const auto type = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& one) {
      return type_name.is_string() && type_name.get_ref<const std::string&>() == one.first;
    });
    if (component == kComponents.end() || type == kTypes.end()) {
      Fail("FIL008", pointer, "unknown componentType or type");
      return std::nullopt;
    }
    if (elements.count == 0) {
      Fail("FIL007", pointer, "no count of 1 and more");
      return std::nullopt;
    }
    elements.numbers = type->second;
    const std::uint64_t size = component->bytes * type->second;
    CheckSparse(Member(accessor, "sparse"), elements.count, pointer);
    const Json& view_index = Member(accessor, "bufferView");
    if (view_index.is_null()) {  // zeros, or compressed
      if (elements.count > kMostElements)
        Fail("FIL003", pointer,
             "more than the " + std::to_string(kMostElements) + " elements allowed");
      return std::nullopt;
    }
    const std::uint64_t view = Unsigned(accessor, "bufferView", 1ULL << 39U, pointer);
    if (view >= views_.size()) {
      Fail("GLB002", pointer + "/bufferView", Count(view, views_.size()));
      return std::nullopt;
    }
    if (!holds_[view]) return std::nullopt;
    const std::uint64_t offset = Unsigned(accessor, "byteOffset", 0, pointer);
    elements.stride = Unsigned(List("bufferViews")[view], "byteStride", size, pointer);
    // the specification aligns an element by its place in the buffer, not in the view
    const std::uint64_t begin =
        Unsigned(List("bufferViews")[view], "byteOffset", 0, pointer) + offset;
    if (begin % component->bytes != 0 || elements.stride % component->bytes != 0 ||
        elements.stride < size || elements.stride > kMostStride) {
      Fail("GLB003", pointer,
           "byte " + std::to_string(begin) + ", stride " + std::to_string(elements.stride) +
               " for elements of " + std::to_string(size) + " bytes");
      return std::nullopt;
    }
    // by division, for the product may be beyond 64 bits
    const std::uint64_t room = views_[view].size();
    if (offset + size > room || elements.count - 1 > (room - offset - size) / elements.stride) {
      Fail("GLB003", pointer,
           std::to_string(elements.count) + " elements, " + std::to_string(elements.stride) +
               " bytes apart, from byte " + std::to_string(offset) + " of a view of " +
               std::to_string(room));
      return std::nullopt;
    }
    elements.bytes = views_[view].substr(offset);
    return elements;
  }

  void CheckSparse(const Json& sparse, std::uint64_t count, const std::string& pointer) {
    if (!sparse.is_object()) return;
    const std::uint64_t changed = Unsigned(sparse, "count", 0, pointer + "/sparse");
    if (changed > count)
      Fail("GLB003", pointer + "/sparse",
           std::to_string(changed) + " elements replaced, of " + std::to_string(count));
  }

  // An index of another list, where there is one.
  void CheckIndex(const Json& json, const char* key, const char* list, const std::string& pointer) {
    const Json& index = Member(json, key);
    if (index.is_null()) return;
    const std::size_t count = List(list).size();
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= count)
      Fail("GLB002", pointer + "/" + key,
           index.dump().substr(0, 40) + " of " + std::to_string(count));
  }

  void CheckReferences() {
    CheckIndex(document_, "scene", "scenes", "");
    const auto each = [&](const char* list,
                          const std::vector<std::pair<const char*, const char*>>& keys) {
      const Json& entries = List(list);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        for (const auto& [key, target] : keys) CheckIndex(entries[i], key, target, At(list, i));
      }
    };
    each("nodes", {{"mesh", "meshes"}, {"skin", "skins"}, {"camera", "cameras"}});
    each("textures", {{"source", "images"}, {"sampler", "samplers"}});
    each("images", {{"bufferView", "bufferViews"}});
    const Json& materials = List("materials");
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const std::string pointer = At("materials", i);
      const Json& metal = Member(materials[i], "pbrMetallicRoughness");
      for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"})
        CheckIndex(Member(metal, key), "index", "textures",
                   pointer + "/pbrMetallicRoughness/" + key);
      for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
        CheckIndex(Member(materials[i], key), "index", "textures", pointer + "/" + key);
    }
  }

  void CheckNodes() {
    const Json& nodes = List("nodes");
    parent_.assign(nodes.size(), -1);
    world_.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      CheckTransform(nodes[i], At("nodes", i));
      const Json& children = Member(nodes[i], "children");
      for (std::size_t k = 0; children.is_array() && k < children.size(); ++k)
        Adopt(i, children[k], At("nodes", i) + "/children/" + std::to_string(k));
    }
    FindLoops(nodes.size());
    const Json& scenes = List("scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const Json& roots = Member(scenes[i], "nodes");
      for (std::size_t k = 0; roots.is_array() && k < roots.size(); ++k) {
        if (!roots[k].is_number_unsigned() || roots[k].get<std::uint64_t>() >= nodes.size())
          Fail("GLB002", At("scenes", i) + "/nodes/" + std::to_string(k),
               roots[k].dump().substr(0, 40) + " of " + std::to_string(nodes.size()));
      }
    }
  }

  void FindLoops(std::size_t nodes) {
    // a walk up from each node stops where an earlier one has been: 0 new, 1 on this walk, 2 before
    std::vector<int> state(nodes, 0);
    std::vector<std::size_t> depth(nodes, 0);
    for (std::size_t i = 0; i < nodes; ++i) {
      std::vector<std::size_t> way;
      std::size_t at = i;
      for (; state[at] == 0; at = static_cast<std::size_t>(parent_[at])) {
        state[at] = 1;
        way.push_back(at);
        if (parent_[at] < 0) break;
      }
      if (state[at] == 1 && parent_[at] >= 0) {
        Fail("GLB006", At("nodes", at), "below itself");
        loops_ = true;
      }
      std::size_t levels = state[at] == 2 ? depth[at] : 0;
      for (auto it = way.rbegin(); it != way.rend(); ++it) {
        state[*it] = 2;
        depth[*it] = ++levels;
      }
      if (levels > kMostLevels)
        return Fail("FIL003", At("nodes", i),
                    "more than the " + std::to_string(kMostLevels) + " levels of nodes allowed");
    }
  }

  void Adopt(std::size_t parent, const Json& child, const std::string& pointer) {
    if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= parent_.size())
      return Fail("GLB002", pointer,
                  child.dump().substr(0, 40) + " of " + std::to_string(parent_.size()));
    int& slot = parent_[child.get<std::size_t>()];
    if (slot >= 0)
      return Fail("GLB006", pointer,
                  "node " + child.dump() + " is a child of node " + std::to_string(slot) + ", too");
    slot = static_cast<int>(parent);
  }

  std::optional<std::vector<double>> NumbersOf(const Json& json, const char* key, std::size_t count,
                                               const std::string& pointer) {
    const Json& list = Member(json, key);
    if (list.is_null()) return std::nullopt;
    std::vector<double> numbers;
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
      if (list[i].is_number()) numbers.push_back(list[i].get<double>());
    }
    if (list.is_array() && numbers.size() == count && list.size() == count) return numbers;
    Fail("FIL006", pointer + "/" + key, "expected " + std::to_string(count) + " numbers");
    return std::nullopt;
  }

  void CheckTransform(const Json& node, const std::string& pointer) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (const auto t = NumbersOf(node, "translation", 3, pointer))
      transform.translate(Eigen::Vector3d((*t)[0], (*t)[1], (*t)[2]));
    if (const auto r = NumbersOf(node, "rotation", 4, pointer)) {
      const Eigen::Quaterniond q((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
      if (std::abs(q.norm() - 1) > 1e-3)
        Fail("GLB007", pointer + "/rotation", "a quaternion of length " + Digits(q.norm()));
      transform.rotate(q);
    }
    if (const auto s = NumbersOf(node, "scale", 3, pointer)) {
      const Eigen::Vector3d scale((*s)[0], (*s)[1], (*s)[2]);
      if ((scale.array() == 0).any()) Fail("GLB007", pointer + "/scale", "a scale of 0");
      transform.scale(scale);
    }
    if (const auto m = NumbersOf(node, "matrix", 16, pointer)) {
      transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(m->data());
      if (std::abs(transform.linear().determinant()) < 1e-18)
        Fail("GLB007", pointer + "/matrix", "a matrix that flattens");
    }
    local_.push_back(transform);
  }

  void CheckMeshes() {
    const Json& meshes = List("meshes");
    // a mesh is measured where it stands, as often as it is used; in a loop nothing stands anywhere
    std::vector<std::vector<Eigen::Affine3d>> uses(meshes.size());
    const Json& nodes = List("nodes");
    for (std::size_t i = 0; i < nodes.size() && !loops_; ++i) {
      const Json& mesh = Member(nodes[i], "mesh");
      if (mesh.is_number_unsigned() && mesh.get<std::uint64_t>() < uses.size())
        uses[mesh.get<std::size_t>()].push_back(WorldOf(i));
    }
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const Json& primitives = Member(meshes[i], "primitives");
      if (!primitives.is_array() || primitives.empty())
        Fail("FIL007", At("meshes", i), "no primitives");
      for (std::size_t k = 0; primitives.is_array() && k < primitives.size(); ++k)
        CheckPrimitive(primitives[k], At("meshes", i) + "/primitives/" + std::to_string(k),
                       uses[i]);
    }
  }

  // Each node is placed once, however long the way up is.
  const Eigen::Affine3d& WorldOf(std::size_t node) {
    std::vector<std::size_t> way;
    for (int at = static_cast<int>(node); at >= 0 && !world_[static_cast<std::size_t>(at)];
         at = parent_[static_cast<std::size_t>(at)])
      way.push_back(static_cast<std::size_t>(at));
    for (std::size_t k = way.size(); k-- > 0;) {
      const int above = parent_[way[k]];
      world_[way[k]] =
          above < 0 ? local_[way[k]] : *world_[static_cast<std::size_t>(above)] * local_[way[k]];
    }
    return *world_[node];
  }

  void CheckPrimitive(const Json& primitive, const std::string& pointer,
                      const std::vector<Eigen::Affine3d>& uses) {
    CheckIndex(primitive, "material", "materials", pointer);
    CheckIndex(primitive, "indices", "accessors", pointer);
    const Json& attributes = Member(primitive, "attributes");
    if (attributes.is_object()) {
      for (const auto& [name, unused] : attributes.items())
        CheckIndex(attributes, name.c_str(), "accessors", pointer + "/attributes");
    }
    const Json& position = Member(attributes, "POSITION");
    if (position.is_null()) return Fail("FIL007", pointer + "/attributes", "no POSITION");
    const auto* points = ElementsAt(position);
    if (points == nullptr || points->component != 5126 || points->numbers != 3) return;
    if (!Afford(points->count)) return;
    const auto accessor = position.get<std::size_t>();
    if (!CheckPositions(*points, List("accessors")[accessor], At("accessors", accessor))) return;
    const Json& indices = Member(primitive, "indices");
    const auto* order = ElementsAt(indices);
    if (order != nullptr && !Afford(order->count)) return;
    if (order != nullptr && !CheckIndices(*order, points->count, pointer)) return;
    const Json& mode = Member(primitive, "mode");
    const bool triangles = mode.is_null() || (mode.is_number_unsigned() && mode.get<int>() == 4);
    if (triangles && (indices.is_null() || order != nullptr)) AddTriangles(*points, order, uses);
  }

  // Whether so many more elements are looked at: primitives may share what they look at.
  bool Afford(std::uint64_t count) {
    looked_at_ += count;
    if (looked_at_ <= kMostElements) return true;
    Fail("FIL003", "",
         "primitives with more than the " + std::to_string(kMostElements) + " elements allowed");
    return false;
  }

  const Elements* ElementsAt(const Json& index) const {
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors_.size())
      return nullptr;
    const auto& elements = accessors_[index.get<std::size_t>()];
    return elements ? &*elements : nullptr;
  }

  bool CheckPositions(const Elements& points, const Json& accessor, const std::string& pointer) {
    const auto least = NumbersOf(accessor, "min", 3, pointer);
    const auto most = NumbersOf(accessor, "max", 3, pointer);
    for (std::uint64_t i = 0; i < points.count; ++i) {
      for (std::uint64_t k = 0; k < 3; ++k) {
        const double number = points.Float(i, k);
        if (!std::isfinite(number)) {
          Fail("GLB004", pointer, "position " + std::to_string(i) + " is not finite");
          return false;
        }
        // min and max were rounded to other digits than the positions
        const double slack = 1e-6 * std::max(1.0, std::abs(number));
        if ((least && number < (*least)[k] - slack) || (most && number > (*most)[k] + slack)) {
          Fail("GLB004", pointer,
               "position " + std::to_string(i) + " has " + Digits(number) +
                   " outside of min and max");
          return true;
        }
      }
    }
    return true;
  }

  bool CheckIndices(const Elements& order, std::uint64_t vertices, const std::string& pointer) {
    const bool whole =
        order.component == 5121 || order.component == 5123 || order.component == 5125;
    if (!whole || order.numbers != 1) {
      Fail("FIL008", pointer + "/indices", "no accessor of unsigned scalars");
      return false;
    }
    for (std::uint64_t i = 0; i < order.count; ++i) {
      if (order.Index(i) < vertices) continue;
      Fail("GLB005", pointer + "/indices",
           "index " + std::to_string(i) + " names vertex " + std::to_string(order.Index(i)) +
               " of " + std::to_string(vertices));
      return false;
    }
    return true;
  }

  void AddTriangles(const Elements& points, const Elements* order,
                    const std::vector<Eigen::Affine3d>& uses) {
    const std::uint64_t count = (order == nullptr ? points.count : order->count) / 3;
    for (const Eigen::Affine3d& world : uses) {
      if (!world.matrix().allFinite()) continue;
      if (triangles_.triangles.size() + count > kMaxRawTriangles)
        return Fail("FIL003", "", "more than the 5000000 triangles allowed");
      if (triangles_.vertices.size() + points.count > 3 * kMaxRawTriangles)
        return Fail("FIL003", "", "more than the 15000000 vertices allowed");
      // a mirrored use shows its triangles from behind
      const bool mirrored = world.linear().determinant() < 0;
      const auto first = static_cast<int>(triangles_.vertices.size());
      for (std::uint64_t i = 0; i < points.count; ++i)
        triangles_.vertices.push_back(
            world * Eigen::Vector3d(points.Float(i, 0), points.Float(i, 1), points.Float(i, 2)));
      for (std::uint64_t i = 0; i < count; ++i) {
        const auto corner = [&](std::uint64_t k) {
          const std::uint64_t at = 3 * i + k;
          return first + static_cast<int>(order == nullptr ? at : order->Index(at));
        };
        triangles_.triangles.emplace_back(corner(0), corner(mirrored ? 2 : 1),
                                          corner(mirrored ? 1 : 2));
      }
    }
  }

  std::string file_;
  const BufferReader& reader_;
  FaultList& faults_;
  Json document_;
  std::string_view binary_;
  bool has_binary_ = false;
  std::vector<std::string_view> buffers_;
  std::vector<bool> missing_;
  std::deque<std::string> owned_;
  std::vector<std::string_view> views_;
  std::vector<bool> holds_;
  std::vector<std::optional<Elements>> accessors_;
  std::vector<int> parent_;
  std::vector<Eigen::Affine3d> local_;
  std::vector<std::optional<Eigen::Affine3d>> world_;
  bool loops_ = false;
  std::uint64_t looked_at_ = 0;
  std::uint64_t buffer_bytes_ = 0;
  TriangleMesh triangles_;
};

}  // namespace

TriangleMesh CheckGltf(std::string_view bytes, const std::string& file, const BufferReader& buffers,
                       FaultList& faults) {
  return GltfCheck(file, buffers, faults).Check(bytes);
}

TriangleMesh GlbTriangles(std::string_view bytes) {
  FaultList faults;
  TriangleMesh mesh = CheckGltf(bytes, "", {}, faults);
  for (const Finding& finding : faults.Sorted()) {
    if (finding.severity == Severity::kError)
      throw RawMeshFault(0, finding.place.element + ": " + finding.measured);
  }
  if (mesh.triangles.empty()) throw RawMeshFault(0, "no triangle in it that is not compressed");
  return mesh;
}

}  // namespace doorforge::foreign
