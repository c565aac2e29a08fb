#ifdef LIMBER_CODECS

#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_layout.h"
#include "limber/asset/codecs_detail.h"
#include "limber/asset/extensions.h"

namespace limber {

namespace {

constexpr std::uint16_t kBitstream = 0x0202;  // the one that glTF allows
constexpr int kMaxDecodes = 8;                // of one buffer view
constexpr double kWeightRounding = 0.05;      // of a sum of weights, at Draco's coarsest usual setting
constexpr std::size_t kBytesPerFace = 48;     // of tables that the decoder makes meanwhile

// What the accessors say that a mesh decodes to.
struct Promise {
  std::optional<std::size_t> faces;  // unknown for a strip
  std::size_t points = 0;
};

// A decoder of Draco's that looks at the counts in the data before memory is asked for.
template <typename Base, bool kFacesFirst>
class BoundedDecoder : public Base {
 public:
  BoundedDecoder(const Promise& promise, const DecodeBudget& budget) : promise_(promise), budget_(budget) {}

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    const std::size_t faces = kFacesFirst ? first : second, vertices = kFacesFirst ? second : first;
    if (promise_.faces && faces != *promise_.faces) return false;
    if (vertices > promise_.points || !budget_.allows(faces * kBytesPerFace)) return false;
    return Base::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    if (cloud.num_points() != promise_.points) return false;
    std::size_t bytes = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      bytes += promise_.points * static_cast<std::size_t>(cloud.attribute(i)->byte_stride());
    }
    return budget_.allows(bytes) && Base::DecodeAllAttributes();
  }

 private:
  const Promise& promise_;
  const DecodeBudget& budget_;
};

using EdgebreakerDecoder = BoundedDecoder<draco::MeshEdgebreakerDecoder, false>;
using SequentialDecoder = BoundedDecoder<draco::MeshSequentialDecoder, true>;

[[noreturn]] void failBroken(const JsonView& place) {
  place.fail("its Draco data are broken or do not hold what the accessors say");
}

void decodeMesh(ByteSpan bytes, const Promise& promise, const DecodeBudget& budget, const JsonView& place,
                draco::Mesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) failBroken(place);
  if (header.encoder_type != draco::TRIANGULAR_MESH) place.fail("its Draco data are not a mesh");
  if (header.version_major * 256 + header.version_minor != kBitstream) {
    throw Error(
        ErrorCode::kUnsupported,
        fmt::format("is Draco of version {}.{}, glTF holds version 2.2", header.version_major, header.version_minor),
        place.path(), "export the model again");
  }
  const draco::DecoderOptions options;
  bool decoded = false;
  try {
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
      decoded = EdgebreakerDecoder(promise, budget).Decode(options, &buffer, &mesh).ok();
    } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
      decoded = SequentialDecoder(promise, budget).Decode(options, &buffer, &mesh).ok();
    }
  } catch (const std::exception&) {
    decoded = false;  // out of memory, or a length that no container takes
  }
  if (!decoded) failBroken(place);
}

// The decoded data of one accessor.
struct Piece {
  Index view = 0;                // of the compressed data
  std::optional<int> attribute;  // Draco's unique id; none for the indices
  std::size_t count = 0, stride = 0;
  Bytes bytes;
};

template <typename T>
void copyAttribute(const draco::PointAttribute& attribute, const JsonView& place, Index components, Piece& piece) {
  std::array<T, 4> value;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (!attribute.ConvertValue(index, static_cast<std::int8_t>(components), value.data())) failBroken(place);
    std::memcpy(piece.bytes.data() + i * piece.stride, value.data(), components * sizeof(T));
  }
}

template <typename T>
void copyIndices(const draco::Mesh& mesh, const JsonView& place, Piece& piece) {
  if (mesh.num_points() > std::size_t{1} << (8 * sizeof(T))) place.fail("has more vertices than its indices can count");
  std::uint8_t* out = piece.bytes.data();
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
    for (const draco::PointIndex& point : mesh.face(face)) {
      const T value = static_cast<T>(point.value());
      std::memcpy(out, &value, sizeof(T));
      out += sizeof(T);
    }
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

    Promise promise;
    promise.points = accessors[attributes.begin()->first].member("count").asCount();
    if (!isStrip) promise.faces = accessors[indices].member("count").asCount() / 3;
    draco::Mesh mesh;
    decodeMesh(viewLayout(asset_, views[view]).bytes, promise, budget_, extension, mesh);
    for (const auto& [accessor, id] : attributes) addAttribute(mesh, view, accessor, id, accessors[accessor]);
    addIndices(mesh, view, indices, accessors[indices]);
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

  void addAttribute(const draco::Mesh& mesh, Index view, Index accessor, int id, const JsonView& place) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    const AccessorLayout layout = shapeOf(accessor);
    if (attribute == nullptr || attribute->num_components() != static_cast<int>(layout.info.components) ||
        layout.info.components > 4 || layout.info.count != mesh.num_points()) {
      failBroken(place);
    }
    // Vertex attributes stand at multiples of four bytes.
    Piece piece{view, id, layout.info.count, (layout.elementSize + 3) / 4 * 4, {}};
    allocate(piece, place);
    withComponentType(layout.info.type, [&](auto component) {
      copyAttribute<decltype(component)>(*attribute, place, layout.info.components, piece);
    });
    store(accessor, std::move(piece), place);
  }

  void addIndices(const draco::Mesh& mesh, Index view, Index accessor, const JsonView& place) {
    const AccessorLayout layout = shapeOf(accessor);
    if (layout.info.components != 1) failBroken(place);
    Piece piece{view, std::nullopt, std::size_t{mesh.num_faces()} * 3, layout.componentBytes, {}};
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

#endif
