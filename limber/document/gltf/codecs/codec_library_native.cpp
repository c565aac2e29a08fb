#ifdef LIMBER_CODECS

#include <array>
#include <cstring>
#include <exception>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <meshoptimizer.h>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/codecs/codec_library.h"

namespace limber {

namespace {

constexpr std::size_t kBytesPerFace = 48;  // of tables that Draco's decoder makes meanwhile

// A decoder of Draco's that looks at the counts in the data before memory is asked for.
template <typename Base, bool kFacesFirst>
class BoundedDecoder : public Base {
 public:
  explicit BoundedDecoder(const DracoBounds& bounds) : bounds_(bounds) {}

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    const std::size_t faces = kFacesFirst ? first : second, vertices = kFacesFirst ? second : first;
    if (bounds_.faces && faces != *bounds_.faces) return false;
    if (vertices > bounds_.points || faces * kBytesPerFace > bounds_.memory) return false;
    return Base::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    if (cloud.num_points() != bounds_.points) return false;
    std::size_t bytes = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      bytes += bounds_.points * static_cast<std::size_t>(cloud.attribute(i)->byte_stride());
    }
    return bytes <= bounds_.memory && Base::DecodeAllAttributes();
  }

 private:
  const DracoBounds& bounds_;
};

using EdgebreakerDecoder = BoundedDecoder<draco::MeshEdgebreakerDecoder, false>;
using SequentialDecoder = BoundedDecoder<draco::MeshSequentialDecoder, true>;

class NativeDracoMesh : public DracoMesh {
 public:
  std::size_t faces() const override { return mesh.num_faces(); }
  std::size_t points() const override { return mesh.num_points(); }

  void copyFaces(std::uint32_t* out) const override {
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
      for (const draco::PointIndex& point : mesh.face(face)) *out++ = point.value();
    }
  }

  std::optional<Index> components(int attribute) const override {
    const draco::PointAttribute* values = attributeOf(attribute);
    if (values == nullptr) return std::nullopt;
    return static_cast<Index>(values->num_components());
  }

  bool copyValues(int attribute, ComponentType type, std::uint8_t* out) const override {
    return withComponentType(type,
                             [&](auto component) { return copyAs<decltype(component)>(*attributeOf(attribute), out); });
  }

  draco::Mesh mesh;

 private:
  const draco::PointAttribute* attributeOf(int id) const {
    return mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  }

  template <typename T>
  bool copyAs(const draco::PointAttribute& attribute, std::uint8_t* out) const {
    std::array<T, 4> value;
    const std::size_t components = attribute.num_components();
    if (components > value.size()) return false;
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point, out += components * sizeof(T)) {
      const auto index = attribute.mapped_index(point);
      if (!attribute.ConvertValue(index, static_cast<std::int8_t>(components), value.data())) return false;
      std::memcpy(out, value.data(), components * sizeof(T));
    }
    return true;
  }
};

}  // namespace

bool decodeMeshoptData(const MeshoptData& data, std::uint8_t* out) {
  const std::size_t size = data.bytes.size();
  if (data.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(out, data.count, data.stride, data.bytes.data(), size) == 0;
  }
  if (data.mode == "INDICES") {
    return meshopt_decodeIndexSequence(out, data.count, data.stride, data.bytes.data(), size) == 0;
  }
  if (meshopt_decodeVertexBuffer(out, data.count, data.stride, data.bytes.data(), size) != 0) return false;
  if (data.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out, data.count, data.stride);
  if (data.filter == "QUATERNION") meshopt_decodeFilterQuat(out, data.count, data.stride);
  if (data.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out, data.count, data.stride);
  return true;
}

std::unique_ptr<DracoMesh> decodeDracoData(ByteSpan data, const DracoBounds& bounds) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return nullptr;
  const draco::DecoderOptions options;
  auto decoded = std::make_unique<NativeDracoMesh>();
  bool isWhole = false;
  try {
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
      isWhole = EdgebreakerDecoder(bounds).Decode(options, &buffer, &decoded->mesh).ok();
    } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
      isWhole = SequentialDecoder(bounds).Decode(options, &buffer, &decoded->mesh).ok();
    }
  } catch (const std::exception&) {
    isWhole = false;  // out of memory, or a length that no container takes
  }
  if (!isWhole) return nullptr;
  return decoded;
}

}  // namespace limber

#endif
