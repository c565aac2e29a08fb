#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/codecs/codec_library.h"
#include "limber/document/gltf/codecs/codecs_detail.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/gltf_json.h"
#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

constexpr int kMaxDecodes = 8;            // of one buffer view
constexpr double kWeightRounding = 0.05;  // of a sum of weights, at Draco's coarsest usual setting

// The fixed start of Draco data: magic, version, kind of geometry.
constexpr std::string_view kDracoMagic = "DRACO";
constexpr std::size_t kDracoMajor = 5, kDracoMinor = 6, kDracoGeometry = 7, kDracoHeaderSize = 11;  // bytes
constexpr std::uint8_t kTriangularMesh = 1;

[[noreturn]] void failBroken(const std::string& location) {
  failAt(location, "its Draco data are broken or do not hold what the accessors say");
}

// glTF allows triangle meshes of one version of the bitstream.
void checkHeader(ByteSpan bytes, const std::string& location) {
  if (bytes.size() < kDracoHeaderSize || std::memcmp(bytes.data(), kDracoMagic.data(), kDracoMagic.size()) != 0)
    failBroken(location);
  if (bytes[kDracoGeometry] != kTriangularMesh) failAt(location, "its Draco data are not a mesh");
  if (bytes[kDracoMajor] != 2 || bytes[kDracoMinor] != 2) {
    throw Error(
        ErrorCode::kUnsupported,
        fmt::format("is Draco of version {}.{}, glTF holds version 2.2", bytes[kDracoMajor], bytes[kDracoMinor]),
        location, "export the model again");
  }
}

// The decoded data of one accessor.
struct Piece {
  Index view = 0;                // of the compressed data
  std::optional<int> attribute;  // Draco's unique id; none for the indices
  std::size_t count = 0, stride = 0;
  Bytes bytes;
};

template <typename T>
void copyIndices(const DracoMesh& mesh, const std::string& location, Piece& piece) {
  if (mesh.points() > 0 && mesh.points() - 1 > std::numeric_limits<T>::max()) {
    failAt(location, "has more vertices than its indices can count");
  }
  std::vector<std::uint32_t> points(3 * mesh.faces());
  mesh.copyFaces(points.data());
  std::uint8_t* out = piece.bytes.data();
  for (const std::uint32_t point : points) {
    if (point >= mesh.points()) failBroken(location);
    const T value = static_cast<T>(point);
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
  }
}

class DracoReader {
 public:
  DracoReader(Asset& asset, DecodeBudget& budget) : asset_(asset), budget_(budget) {}

  void readPrimitive(const gltf::Primitive& primitive, const std::string& location) {
    const std::string path = fmt::format("{}.extensions.{}", location, kDraco);
    const JsonView extension(extensionOf(primitive, kDraco), path);
    const std::vector<gltf::Accessor>& accessors = asset_.document.accessors;
    const Index view = extension.requireIndex("bufferView", asset_.document.bufferViews.size());
    if (!primitive.indices) failAt(location + ".indices", "is missing");
    const Index indices = *primitive.indices;
    requireElement(indices, accessors.size(), [&] { return location + ".indices"; });

    std::map<Index, int> attributes;  // accessor -> Draco's unique id
    std::vector<Index> weights;
    extension.object("attributes").forEachMember([&](std::string_view name, const JsonView& id) {
      const auto attribute = [&] { return fmt::format("{}.attributes.{}", location, name); };
      const std::optional<Index> accessor = primitive.attributes.find(name);
      if (!accessor) failAt(attribute(), "is missing");
      requireElement(accessor, accessors.size(), attribute);
      attributes[*accessor] = static_cast<int>(id.asIndex(std::numeric_limits<int>::max()));
      if (name.starts_with("WEIGHTS_")) weights.push_back(*accessor);
    });
    if (attributes.empty()) extension.fail("has no attributes");
    if (isKnown(view, indices, attributes)) return;
    if (++timesDecoded_[view] > kMaxDecodes) {
      throw Error(ErrorCode::kLimit, "too many primitives take differing accessors from the same Draco data",
                  extension.path());
    }

    DracoBounds bounds;
    bounds.points = accessors[attributes.begin()->first].count;
    if (primitive.mode != gltf::kTriangleStrip) bounds.faces = accessors[indices].count / 3;
    bounds.memory = budget_.left();
    const ByteSpan bytes = viewLayout(asset_, view).bytes;
    checkHeader(bytes, path);
    const std::unique_ptr<DracoMesh> mesh = decodeDracoData(bytes, bounds);
    if (!mesh) failBroken(path);
    for (const auto& [accessor, id] : attributes) addAttribute(*mesh, view, accessor, id);
    addIndices(*mesh, view, indices);
    if (!weights.empty()) weightSets_.insert(weights);
  }

  // To be called once all primitives are read.
  void finish() {
    for (const std::vector<Index>& accessors : weightSets_) normalizeWeights(accessors);
  }

  std::map<Index, Piece>& pieces() { return pieces_; }

 private:
  // Primitives that share accessors also share their compressed data.
  bool isKnown(Index view, Index indices, const std::map<Index, int>& attributes) const {
    const auto known = pieces_.find(indices);
    if (known == pieces_.end() || known->second.view != view || known->second.attribute) return false;
    for (const auto& [accessor, id] : attributes) {
      const auto piece = pieces_.find(accessor);
      if (piece == pieces_.end() || piece->second.view != view || piece->second.attribute != id) return false;
    }
    return true;
  }

  void addAttribute(const DracoMesh& mesh, Index view, Index accessor, int id) {
    const std::string location = accessorLocation(accessor);
    const AccessorLayout layout = shapeOf(accessor);
    const std::optional<Index> components = mesh.components(id);
    if (components != layout.info.components || layout.info.count != mesh.points()) failBroken(location);
    // Vertex attributes stand at multiples of four bytes.
    Piece piece{view, id, layout.info.count, (layout.elementSize + 3) / 4 * 4, {}};
    allocate(piece, location);
    Bytes packed(piece.count * layout.elementSize);
    if (!mesh.copyValues(id, layout.info.type, packed.data())) failBroken(location);
    for (std::size_t i = 0; i < piece.count; ++i) {
      std::memcpy(&piece.bytes[i * piece.stride], &packed[i * layout.elementSize], layout.elementSize);
    }
    store(accessor, std::move(piece), location);
  }

  void addIndices(const DracoMesh& mesh, Index view, Index accessor) {
    const std::string location = accessorLocation(accessor);
    const AccessorLayout layout = shapeOf(accessor);
    if (layout.info.components != 1) failBroken(location);
    Piece piece{view, std::nullopt, 3 * mesh.faces(), layout.componentBytes, {}};
    allocate(piece, location);
    if (layout.info.type == ComponentType::kU8) {
      copyIndices<std::uint8_t>(mesh, location, piece);
    } else if (layout.info.type == ComponentType::kU16) {
      copyIndices<std::uint16_t>(mesh, location, piece);
    } else if (layout.info.type == ComponentType::kU32) {
      copyIndices<std::uint32_t>(mesh, location, piece);
    } else {
      failAt(location, "indices must be unsigned integers");
    }
    store(accessor, std::move(piece), location);
  }

  // The accessor's type and count. Its data are still being decoded, so callers check the count against those.
  AccessorLayout shapeOf(Index accessor) const { return accessorShape(asset_, accessor); }

  // Draco rounds each skin weight by itself; the sum of a vertex's weights is made 1 again.
  void normalizeWeights(const std::vector<Index>& accessors) {
    for (const Index accessor : accessors) {
      const AccessorInfo info = shapeOf(accessor).info;
      if (info.type != ComponentType::kF32 || info.components != 4) return;
    }
    const std::size_t count = pieces_.at(accessors.front()).count;
    for (std::size_t vertex = 0; vertex < count; ++vertex) {
      double sum = 0;
      forEachWeight(accessors, vertex, [&](float weight) {
        sum += weight;
        return weight;
      });
      if (!(std::abs(sum - 1) < kWeightRounding)) continue;
      forEachWeight(accessors, vertex, [&](float weight) { return static_cast<float>(weight / sum); });
    }
  }

  template <typename Change>
  void forEachWeight(const std::vector<Index>& accessors, std::size_t vertex, const Change& change) {
    for (const Index accessor : accessors) {
      std::uint8_t* at = pieces_.at(accessor).bytes.data() + vertex * 4 * sizeof(float);
      for (std::size_t slot = 0; slot < 4; ++slot, at += sizeof(float)) {
        const float weight = change(loadAs<float>(at));
        std::memcpy(at, &weight, sizeof(float));
      }
    }
  }

  void allocate(Piece& piece, const std::string& location) {
    budget_.take(piece.count * piece.stride, location);
    piece.bytes.resize(piece.count * piece.stride);
  }

  void store(Index accessor, Piece&& piece, const std::string& location) {
    const auto [known, isNew] = pieces_.try_emplace(accessor, std::move(piece));
    if (!isNew && known->second.bytes != piece.bytes) failAt(location, "is used for two differing Draco attributes");
  }

  Asset& asset_;
  DecodeBudget& budget_;
  std::map<Index, Piece> pieces_;            // by accessor
  std::map<Index, int> timesDecoded_;        // by buffer view
  std::set<std::vector<Index>> weightSets_;  // accessors of one primitive's weights
};

// The buffer views that anything in the document seems to refer to, the application's own data included.
void collectViewReferences(const Json& json, std::vector<bool>& used) {
  for (auto it = json.begin(); it != json.end(); ++it) {
    if (it->is_structured()) {
      collectViewReferences(*it, used);
    } else if (json.is_object() && it.key() == "bufferView" && it->is_number_unsigned()) {
      const auto view = it->get<std::uint64_t>();
      if (view < used.size()) used[view] = true;
    }
  }
}

// Puts the pieces in new buffer views. The views of compressed data that nothing refers to any more are used first.
void storePieces(Asset& asset, const std::map<Index, Piece>& pieces) {
  gltf::Document& document = asset.document;
  std::vector<bool> used(document.bufferViews.size(), false);
  collectViewReferences(gltf::jsonOf(document), used);
  for (const auto& [index, piece] : pieces) {
    Index view = addBufferView(asset, piece.bytes, piece.attribute ? kVertexTarget : kIndexTarget);
    std::vector<gltf::BufferView>& views = document.bufferViews;
    if (piece.stride % 4 == 0 && piece.attribute) views[view].byteStride = piece.stride;
    if (!used[piece.view]) {
      used[piece.view] = true;
      views[piece.view] = std::move(views[view]);
      views.pop_back();
      view = piece.view;
    }
    gltf::Accessor& accessor = document.accessors[index];
    accessor.bufferView = view;
    accessor.count = piece.count;
    accessor.byteOffset = 0;
  }
}

}  // namespace

void decodeDraco(Asset& asset, DecodeBudget& budget, Decoded& decoded) {
  gltf::Document& document = asset.document;
  DracoReader reader(asset, budget);
  std::vector<gltf::Primitive*> primitives;
  for (std::size_t m = 0; m < document.meshes.size(); ++m) {
    std::vector<gltf::Primitive>& all = document.meshes[m].primitives;
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (extensionOf(all[p], kDraco) == nullptr) continue;
      reader.readPrimitive(all[p], fmt::format("meshes[{}].primitives[{}]", m, p));
      primitives.push_back(&all[p]);
    }
  }
  reader.finish();
  for (const auto& [accessor, piece] : reader.pieces()) {
    decoded.accessors.insert(accessor);
    decoded.buffers.insert(document.bufferViews[piece.view].buffer);
  }
  for (gltf::Primitive* primitive : primitives) {
    eraseExtension(*primitive, kDraco);
    // Strips come out of Draco as single triangles.
    if (primitive->mode == gltf::kTriangleStrip) primitive->mode = gltf::kTriangles;
  }
  storePieces(asset, reader.pieces());
}

}  // namespace limber
