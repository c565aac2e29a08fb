// The decoders of meshopt and Draco data: the systems' libraries in a program (codec_library_native.cpp), those that
// the page brings in a browser (codec_library_page.cpp). What the data are for, glTF's accessors, is not known here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "limber/document/gltf/accessor.h"

namespace limber {

// A compressed buffer view; mode and filter by their names in EXT_meshopt_compression, which go together.
struct MeshoptData {
  ByteSpan bytes;
  std::size_t count = 0, stride = 0;  // elements, and bytes of each
  std::string_view mode, filter;
};

// Writes count * stride bytes. False where the data are broken.
bool decodeMeshoptData(const MeshoptData& data, std::uint8_t* out);

// What the accessors say that Draco data decode to, and what may be spent on it.
struct DracoBounds {
  std::optional<std::size_t> faces;  // unknown for a strip
  std::size_t points = 0;
  std::size_t memory = 0;  // bytes
};

// A triangle mesh out of Draco data. Attributes go by the ids that KHR_draco_mesh_compression names.
class DracoMesh {
 public:
  virtual ~DracoMesh() = default;
  virtual std::size_t faces() const = 0;
  virtual std::size_t points() const = 0;
  // Three points for each face.
  virtual void copyFaces(std::uint32_t* out) const = 0;
  // Values of a point; none where there is no such attribute.
  virtual std::optional<Index> components(int attribute) const = 0;
  // The values of all points as that type, one behind the other. False where they do not fit into it.
  virtual bool copyValues(int attribute, ComponentType type, std::uint8_t* out) const = 0;
};

// Null where the data are broken or beyond the bounds. The data begin with the header of a mesh of bitstream 2.2.
std::unique_ptr<DracoMesh> decodeDracoData(ByteSpan data, const DracoBounds& bounds);

}  // namespace limber
