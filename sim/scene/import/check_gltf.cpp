// glTF 2.0 (Khronos, 2017): container, buffers, views and accessors against the file's size. What is inside the buffers
// is checked after reading. Names in comments are the specification's.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/gltf_nodes.hpp"
#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/json.hpp"

namespace pitviper {
namespace {

class GltfCheck {
 public:
  explicit GltfCheck(const ImportRequest& request) : request_(request), file_(request.file), text_(request.bytes) {}

  CheckedFile run() {
    CheckedFile checked;
    checked.partNames = check();
    checked.placements = takePlacements(root_);
    checked.bytes = canonical();
    checked.buffers = std::move(contents_);
    return checked;
  }

 private:
  /// Names of the nodes: their own, else their mesh's, else their number.
  std::vector<std::string> check() {
    if (text_.starts_with("glTF")) splitContainer();
    root_ = parseJson(file_, text_, base_);
    if (root_.kind != Json::Kind::Object) fail(root_, "the glTF text is no object", "an object");
    const Json* asset = root_.find("asset");
    const Json* version = asset != nullptr ? asset->find("version") : nullptr;
    if (version == nullptr || !version->text.starts_with("2.")) fail(root_, "this is not glTF 2", "\"asset\": {\"version\": \"2.0\"}");
    refuseExtensions();
    for (const Json& buffer : list(root_, "buffers")) checkBuffer(buffer);
    for (const Json& view : list(root_, "bufferViews")) checkView(view);
    for (const Json& accessor : list(root_, "accessors")) checkAccessor(accessor);
    double triangles = 0.0;
    for (const Json& mesh : list(root_, "meshes"))
      for (const Json& primitive : list(mesh, "primitives")) triangles += checkPrimitive(primitive);
    if (triangles > static_cast<double>(kMostImportedTriangles))
      fail(root_, "the file has too many triangles", "at most " + std::to_string(kMostImportedTriangles));
    checkNodes();
    for (const Json& scene : list(root_, "scenes")) indices(scene, "nodes", list(root_, "nodes").size());
    if (root_.find("scene") != nullptr) index(root_, "scene", list(root_, "scenes").size());
    std::vector<std::string> names;
    for (const Json& node : list(root_, "nodes")) {
      const Json* name = node.find("name");
      if ((name == nullptr || name->text.empty()) && node.find("mesh") != nullptr)
        name = list(root_, "meshes")[static_cast<std::size_t>(node.find("mesh")->number)].find("name");
      names.push_back(name != nullptr && !name->text.empty() ? name->text : "node " + std::to_string(names.size()));
    }
    return names;
  }

  /// The text with every buffer in a file of ours, and without what has no say in the shape.
  std::string canonical() {
    for (const char* name : {"images", "textures", "samplers", "materials", "extensions", "extensionsUsed", "extensionsRequired", "extras"})
      root_.members.erase(name);
    const auto items = [](Json& in, const char* name) -> std::vector<Json>& {
      static std::vector<Json> none;
      const auto found = in.members.find(name);
      return found == in.members.end() ? none : found->second.items;
    };
    for (Json& mesh : items(root_, "meshes"))
      for (Json& primitive : items(mesh, "primitives")) primitive.members.erase("material");
    std::size_t k = 0;
    for (Json& buffer : items(root_, "buffers")) {
      if (const auto& content = contents_[k++]) {
        Json uri;
        uri.kind = Json::Kind::String;
        uri.text = content->name();
        buffer.members.insert_or_assign("uri", std::move(uri));
      }
    }
    return writeJson(root_);
  }

  [[noreturn]] void fail(const Json& at, const std::string& wrong, const std::string& expected) const {
    failInJson(file_, text_, base_, at.offset, wrong, expected);
  }

  /// GLB: 12 bytes (magic, version, length), then chunks (length, type, content); JSON first, then BIN.
  void splitContainer() {
    const std::string_view all = text_;
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      if (all.size() < at + 4) failAtByte(file_, all.size(), "the file ends within a chunk's header", "a whole GLB file");
      std::memcpy(&value, all.data() + at, 4);
      return value;
    };
    if (word(4) != 2) failAtByte(file_, 4, "this is GLB version " + std::to_string(word(4)), "2");
    if (word(8) != all.size()) failAtByte(file_, 8, "the file says it has " + std::to_string(word(8)) + " bytes", std::to_string(all.size()));
    for (std::size_t at = 12; at < all.size();) {
      const std::uint32_t length = word(at), type = word(at + 4);
      if (length > all.size() - at - 8) failAtByte(file_, at, "a chunk of " + std::to_string(length) + " bytes goes beyond the file's end");
      const bool isFirst = at == 12;
      if (isFirst != (type == 0x4E4F534Au)) failAtByte(file_, at + 4, "the chunk's type is not possible here", "JSON first, and once");
      if (isFirst) {
        text_ = all.substr(at + 8, length);
        base_ = at + 8;
      } else if (type == 0x004E4942u && binarySize_ < 0.0) {
        binarySize_ = length;
        binary_ = all.substr(at + 8, length);
      }
      at += 8 + length;
    }
    if (base_ == 0) failAtByte(file_, 12, "the file has no content", "a JSON chunk");
  }

  const std::vector<Json>& list(const Json& in, std::string_view name) const {
    static const std::vector<Json> none;
    const Json* member = in.find(name);
    if (member == nullptr) return none;
    if (member->kind != Json::Kind::Array) fail(*member, std::string(name) + " is no array", "an array of objects");
    for (const Json& item : member->items)
      if (item.kind != Json::Kind::Object) fail(item, "an item of " + std::string(name) + " is no object", "an object");
    return member->items;
  }

  /// A whole number; `otherwise` if it is not there and otherwise >= 0.
  double whole(const Json& in, std::string_view name, double otherwise, double most) const {
    const Json* member = in.find(name);
    if (member == nullptr && otherwise >= 0.0) return otherwise;
    if (member == nullptr) fail(in, "'" + std::string(name) + "' is missing", "a whole number");
    if (member->kind != Json::Kind::Number || member->number < 0.0 || member->number > most || member->number != std::floor(member->number))
      fail(*member, "'" + std::string(name) + "' is not possible", "a whole number in 0.." + std::to_string(static_cast<long long>(most)));
    return member->number;
  }

  std::size_t index(const Json& in, std::string_view name, std::size_t count) const {
    const Json* member = in.find(name);
    if (count == 0) fail(member != nullptr ? *member : in, "'" + std::string(name) + "' refers to nothing", "one that exists");
    return static_cast<std::size_t>(whole(in, name, -1.0, static_cast<double>(count - 1)));
  }

  std::vector<std::size_t> indices(const Json& in, std::string_view name, std::size_t count) const {
    std::vector<std::size_t> out;
    const Json* member = in.find(name);
    if (member == nullptr) return out;
    for (const Json& item : member->items) {
      if (item.kind != Json::Kind::Number || !(item.number >= 0.0 && item.number < static_cast<double>(count)) || item.number != std::floor(item.number))
        fail(item, "an index in '" + std::string(name) + "' refers to nothing", "below " + std::to_string(count));
      out.push_back(static_cast<std::size_t>(item.number));
    }
    return out;
  }

  void refuseExtensions() const {
    const Json* required = root_.find("extensionsRequired");
    if (required == nullptr) return;
    for (const Json& name : required->items)  // those about materials and textures don't change the shape
      if (!name.text.starts_with("KHR_materials") && !name.text.starts_with("KHR_texture"))
        fail(name, "the file needs the extension '" + name.text.substr(0, 60) + "'", "plain glTF 2.0 (export without compression)");
  }

  void checkBuffer(const Json& buffer) {
    const double length = whole(buffer, "byteLength", -1.0, 4e9);
    const Json* uri = buffer.find("uri");
    double available = binarySize_;
    std::unique_ptr<const MemoryFile> content;
    if (uri != nullptr && uri->text.starts_with("data:")) {
      const std::size_t comma = uri->text.find(";base64,");
      if (comma == std::string::npos) fail(*uri, "a data URI is not in base64", "data:...;base64,...");
      const std::string_view data = std::string_view(uri->text).substr(comma + 8);
      const std::size_t padding = static_cast<std::size_t>(std::count(data.begin(), data.end(), '='));
      if (data.size() % 4 != 0 || padding > 2 || (padding > 0 && data.find('=') + padding != data.size()) ||
          data.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=") != data.npos)
        fail(*uri, "a data URI's base64 is damaged", "base64 with padding");
      available = static_cast<double>(data.size() / 4 * 3 - padding);
    } else if (uri != nullptr) {
      std::string bytes, problem;
      if (!request_.readNamed(uri->text, bytes, problem)) fail(*uri, "the file of a buffer cannot be read: " + problem, "a file beside this one");
      available = static_cast<double>(bytes.size());
      content = std::make_unique<const MemoryFile>(bytes);
    } else if (available < 0.0 || !buffers_.empty()) {
      fail(buffer, "a buffer has no content", "a uri, or the first buffer of a GLB with a BIN chunk");
    } else {
      content = std::make_unique<const MemoryFile>(binary_);
    }
    if (length > available)
      fail(buffer, "a buffer of " + std::to_string(static_cast<long long>(length)) + " bytes has only " + std::to_string(static_cast<long long>(available)),
           "all of them");
    buffers_.push_back(length);
    contents_.push_back(std::move(content));
  }

  void checkView(const Json& view) {
    const double size = buffers_.empty() ? 0.0 : buffers_[index(view, "buffer", buffers_.size())];
    const double offset = whole(view, "byteOffset", 0.0, 4e9), length = whole(view, "byteLength", -1.0, 4e9);
    if (offset + length > size) fail(view, "a buffer view goes beyond its buffer", "up to byte " + std::to_string(static_cast<long long>(size)));
    views_.push_back({length, whole(view, "byteStride", 0.0, 252.0)});
  }

  void checkAccessor(const Json& accessor) {
    if (const Json* sparse = accessor.find("sparse")) fail(*sparse, "sparse accessors are not supported", "plain ones");
    const double count = whole(accessor, "count", -1.0, 4e9), offset = whole(accessor, "byteOffset", 0.0, 4e9);
    const auto type = static_cast<int>(whole(accessor, "componentType", -1.0, 1e6));
    const double size = type == 5120 || type == 5121 ? 1.0 : type == 5122 || type == 5123 ? 2.0 : type == 5125 || type == 5126 ? 4.0 : 0.0;
    if (size == 0.0) fail(*accessor.find("componentType"), "the component type is unknown", "5120..5126");
    const Json* shape = accessor.find("type");
    constexpr std::array<std::pair<std::string_view, double>, 7> kShapes{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    const auto known = std::find_if(kShapes.begin(), kShapes.end(), [&](const auto& s) { return shape != nullptr && s.first == shape->text; });
    if (known == kShapes.end()) fail(accessor, "an accessor's type is unknown", "SCALAR, VEC2 .. MAT4");
    const View view = views_.empty() ? View{} : views_[index(accessor, "bufferView", views_.size())];
    const double item = size * known->second, stride = view.stride > 0.0 ? view.stride : item;
    if (stride < item || (count > 0.0 && offset + (count - 1.0) * stride + item > view.length))
      fail(accessor, "an accessor goes beyond its buffer view", "at most " + std::to_string(static_cast<long long>(view.length)) + " bytes");
    accessors_.push_back({known->second, type, count});
  }

  double checkPrimitive(const Json& primitive) const {
    const Json* attributes = primitive.find("attributes");
    if (attributes == nullptr || attributes->find("POSITION") == nullptr) fail(primitive, "a primitive has no POSITION", "one");
    const double points = accessors_.empty() ? 0.0 : accessors_[index(*attributes, "POSITION", accessors_.size())].count;
    for (const auto& [name, value] : attributes->members) {
      const Accessor& a = accessors_.at(index(*attributes, name, accessors_.size()));
      if (a.count != points) fail(value, "the attribute " + name.substr(0, 40) + " has another count than POSITION", "equal counts");
      const double width = name == "POSITION" || name == "NORMAL" ? 3.0 : name.starts_with("TEXCOORD") ? 2.0 : a.width;
      const bool isFloat = a.type == 5126 || (name != "POSITION" && name != "NORMAL");
      if (a.width != width || !isFloat) fail(value, "the attribute " + name.substr(0, 40) + " has another type than glTF 2.0 allows", "floats");
    }
    for (const Json& target : list(primitive, "targets"))
      for (const auto& [name, value] : target.members)
        if (accessors_.at(index(target, name, accessors_.size())).count != points)
          fail(value, "a morph target has another count than POSITION", "equal counts");
    double corners = points;
    if (primitive.find("indices") != nullptr) {
      const Accessor& a = accessors_.at(index(primitive, "indices", accessors_.size()));
      if (a.width != 1.0 || (a.type != 5121 && a.type != 5123 && a.type != 5125))
        fail(primitive, "the indices have another type than glTF 2.0 allows", "unsigned scalars");
      corners = a.count;
    }
    const double mode = whole(primitive, "mode", 4.0, 6.0);
    if (mode == 4.0 && std::fmod(corners, 3.0) != 0.0) fail(primitive, "the indices of triangles are no multiple of three", "three each");
    return mode < 4.0 ? 0.0 : mode == 4.0 ? corners / 3.0 : corners;
  }

  /// Every node has one parent at most, so that the tree ends.
  void checkNodes() {
    const std::vector<Json>& nodes = list(root_, "nodes");
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].find("mesh") != nullptr) index(nodes[i], "mesh", list(root_, "meshes").size());
      for (const auto& [name, width] : {std::pair{"matrix", 16u}, {"translation", 3u}, {"rotation", 4u}, {"scale", 3u}})
        if (const Json* numbers = nodes[i].find(name))
          if (numbers->items.size() != width ||
              std::any_of(numbers->items.begin(), numbers->items.end(), [](const Json& n) { return n.kind != Json::Kind::Number; }))
            fail(*numbers, std::string("a node's ") + name + " is damaged", std::to_string(width) + " numbers");
      for (const std::size_t child : indices(nodes[i], "children", nodes.size())) {
        if (parent[child] != nodes.size()) fail(nodes[i], "a node has two parents", "a tree");
        parent[child] = i;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::size_t depth = 0;
      for (std::size_t up = i; up != nodes.size(); up = parent[up])
        if (++depth > 256) fail(nodes[i], "the nodes form a circle, or a tree too deep", "256 levels at most");
    }
  }

  struct View {
    double length = 0.0, stride = 0.0;
  };
  struct Accessor {
    double width = 0.0;
    int type = 0;
    double count = 0.0;
  };

  const ImportRequest& request_;
  std::string file_;
  std::string_view text_, binary_;
  std::size_t base_ = 0;
  double binarySize_ = -1.0;  ///< bytes of the GLB's BIN chunk; negative: none
  Json root_;
  std::vector<double> buffers_;
  std::vector<std::unique_ptr<const MemoryFile>> contents_;  ///< of each buffer; null: a data URI
  std::vector<View> views_;
  std::vector<Accessor> accessors_;
};

}  // namespace

CheckedFile checkGltf(const ImportRequest& request) { return GltfCheck(request).run(); }

}  // namespace pitviper
