#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_layout.h"
#include "limber/asset/codec_library.h"
#include "limber/asset/codecs_detail.h"
#include "limber/asset/extensions.h"

namespace limber {

namespace {

constexpr int kMaxDecodes = 8;            // of one buffer view
constexpr double kWeightRounding = 0.05;  // of a sum of weights, at Draco's coarsest usual setting

// The fixed start of Draco data: magic, version, kind of geometry.
constexpr std::string_view kDracoMagic = "DRACO";
constexpr std::size_t kDracoMajor = 5, kDracoMinor = 6, kDracoGeometry = 7, kDracoHeaderSize = 11;  // bytes
constexpr std::uint8_t kTriangularMesh = 1;

[[noreturn]] void failBroken(const JsonView& place) {
  place.fail("its Draco data are broken or do not hold what the accessors say");
}

// glTF allows triangle meshes of one version of the bitstream.
void checkHeader(ByteSpan bytes, const JsonView& place) {
  if (bytes.size() < kDracoHeaderSize || std::memcmp(bytes.data(), kDracoMagic.data(), kDracoMagic.size()) != 0)
    failBroken(place);
  if (bytes[kDracoGeometry] != kTriangularMesh) place.fail("its Draco data are not a mesh");
  if (bytes[kDracoMajor] != 2 || bytes[kDracoMinor] != 2) {
    throw Error(
        ErrorCode::kUnsupported,
        fmt::format("is Draco of version {}.{}, glTF holds version 2.2", bytes[kDracoMajor], bytes[kDracoMinor]),
        place.path(), "export the model again");
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
void copyIndices(const DracoMesh& mesh, const JsonView& place, Piece& piece) {
  if (mesh.points() > 0 && mesh.points() - 1 > std::numeric_limits<T>::max()) {
    place.fail("has more vertices than its indices can count");
  }
  std::vector<std::uint32_t> points(3 * mesh.faces());
  mesh.copyFaces(points.data());
  std::uint8_t* out = piece.bytes.data();
  for (const std::uint32_t point : points) {
    if (point >= mesh.points()) failBroken(place);
    const T value = static_cast<T>(point);
    std::memcpy(out, &value, sizeof(T));
    out += sizeof(T);
  }
}

class DracoReader {
 public:
  DracoReader(Asset& asset, DecodeBudget& budget) : asset_(asset), budget_(budget) {}

  void readPrimitive(const JsonView& primitive) {
    const JsonView extension = extensionOf(primitive, kDraco);
    const JsonView accessors = JsonView(asset_).array("accessors"), views = JsonView(asset_).array("bufferViews");
    const Index view = extension.requireIndex("bufferView", views.size());
    const Index indices = primitive.requireIndex("indices", accessors.size());
    const bool isStrip = primitive.index("mode", 7).value_or(4) == 5;

    std::map<Index, int> attributes;  // accessor -> Draco's unique id
    std::vector<Index> weights;
    extension.object("attributes").forEachMember([&](std::string_view name, const JsonView& id) {
      const Index accessor = primitive.object("attributes").requireIndex(name, accessors.size());
      attributes[accessor] = static_cast<int>(id.asIndex(std::numeric_limits<int>::max()));
      if (name.substr(0, 8) == "WEIGHTS_") weights.push_back(accessor);
    });
    if (attributes.empty()) extension.fail("has no attributes");
    if (isKnown(view, indices, attributes)) return;
    if (++timesDecoded_[view] > kMaxDecodes) {
      throw Error(ErrorCode::kLimit, "too many primitives take differing accessors from the same Draco data",
                  extension.path());
    }

    DracoBounds bounds;
    bounds.points = accessors[attributes.begin()->first].member("count").asCount();
    if (!isStrip) bounds.faces = accessors[indices].member("count").asCount() / 3;
    bounds.memory = budget_.left();
    const ByteSpan bytes = viewLayout(asset_, views[view]).bytes;
    checkHeader(bytes, extension);
    const std::unique_ptr<DracoMesh> mesh = decodeDracoData(bytes, bounds);
    if (!mesh) failBroken(extension);
    for (const auto& [accessor, id] : attributes) addAttribute(*mesh, view, accessor, id, accessors[accessor]);
    addIndices(*mesh, view, indices, accessors[indices]);
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

  void addAttribute(const DracoMesh& mesh, Index view, Index accessor, int id, const JsonView& place) {
    const AccessorLayout layout = shapeOf(accessor);
    const std::optional<Index> components = mesh.components(id);
    if (components != layout.info.components || layout.info.count != mesh.points()) failBroken(place);
    // Vertex attributes stand at multiples of four bytes.
    Piece piece{view, id, layout.info.count, (layout.elementSize + 3) / 4 * 4, {}};
    allocate(piece, place);
    Bytes packed(piece.count * layout.elementSize);
    if (!mesh.copyValues(id, layout.info.type, packed.data())) failBroken(place);
    for (std::size_t i = 0; i < piece.count; ++i) {
      std::memcpy(&piece.bytes[i * piece.stride], &packed[i * layout.elementSize], layout.elementSize);
    }
    store(accessor, std::move(piece), place);
  }

  void addIndices(const DracoMesh& mesh, Index view, Index accessor, const JsonView& place) {
    const AccessorLayout layout = shapeOf(accessor);
    if (layout.info.components != 1) failBroken(place);
    Piece piece{view, std::nullopt, 3 * mesh.faces(), layout.componentBytes, {}};
    allocate(piece, place);
    if (layout.info.type == ComponentType::kU8) {
      copyIndices<std::uint8_t>(mesh, place, piece);
    } else if (layout.info.type == ComponentType::kU16) {
      copyIndices<std::uint16_t>(mesh, place, piece);
    } else if (layout.info.type == ComponentType::kU32) {
      copyIndices<std::uint32_t>(mesh, place, piece);
    } else {
      place.fail("indices must be unsigned integers");
    }
    store(accessor, std::move(piece), place);
  }

  // The accessor's type and count. Its data are what is being decoded, so the count is held to what was.
  AccessorLayout shapeOf(Index accessor) const { return accessorShape(JsonView(asset_).array("accessors")[accessor]); }

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

  void allocate(Piece& piece, const JsonView& place) {
    budget_.take(piece.count * piece.stride, place.path());
    piece.bytes.resize(piece.count * piece.stride);
  }

  void store(Index accessor, Piece&& piece, const JsonView& place) {
    const auto [known, isNew] = pieces_.try_emplace(accessor, std::move(piece));
    if (!isNew && known->second.bytes != piece.bytes) place.fail("is used for two differing Draco attributes");
  }

  Asset& asset_;
  DecodeBudget& budget_;
  std::map<Index, Piece> pieces_;            // by accessor
  std::map<Index, int> timesDecoded_;        // by buffer view
  std::set<std::vector<Index>> weightSets_;  // accessors of one primitive's weights
};

// The buffer views that something in the document refers to, extensions included.
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
void placePieces(Asset& asset, const std::map<Index, Piece>& pieces) {
  std::vector<bool> used(JsonView(asset).array("bufferViews").size(), false);
  collectViewReferences(asset.json(), used);
  for (const auto& [index, piece] : pieces) {
    Json& accessor = asset.json()["accessors"][index];
    Index view = addBufferView(asset, piece.bytes, piece.attribute ? kVertexTarget : kIndexTarget);
    Json& views = asset.json()["bufferViews"];
    if (piece.stride % 4 == 0 && piece.attribute) views[view]["byteStride"] = piece.stride;
    if (!used[piece.view]) {
      used[piece.view] = true;
      views[piece.view] = std::move(views[view]);
      views.erase(view);
      view = piece.view;
    }
    accessor["bufferView"] = view;
    accessor["count"] = piece.count;
    accessor.erase("byteOffset");
  }
}

}  // namespace

void decodeDraco(Asset& asset, DecodeBudget& budget, Decoded& decoded) {
  DracoReader reader(asset, budget);
  const JsonView meshes = JsonView(asset).array("meshes"), views = JsonView(asset).array("bufferViews");
  std::vector<std::pair<std::size_t, std::size_t>> primitives;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const JsonView all = meshes[m].array("primitives");
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (!extensionOf(all[p], kDraco).exists()) continue;
      reader.readPrimitive(all[p]);
      primitives.emplace_back(m, p);
    }
  }
  reader.finish();
  for (const auto& [accessor, piece] : reader.pieces()) {
    decoded.accessors.insert(accessor);
    decoded.buffers.insert(views[piece.view].requireIndex("buffer", asset.buffers.size()));
  }
  for (const auto& [m, p] : primitives) {
    Json& primitive = asset.json()["meshes"][m]["primitives"][p];
    eraseExtension(primitive, kDraco);
    // Strips come out of Draco as single triangles.
    if (primitive.value("mode", 4) == 5) primitive["mode"] = 4;
  }
  placePieces(asset, reader.pieces());
}

}  // namespace limber
