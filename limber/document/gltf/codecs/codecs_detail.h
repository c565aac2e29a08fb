// Common parts of the decoders of compressed geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "limber/document/asset.h"

namespace limber {

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

// Memory that decoding may still allocate. Draco's files grow ten to fifty times; what a small file can claim is
// limited to a multiple of its size (read_bounds.h).
class DecodeBudget {
 public:
  explicit DecodeBudget(std::uint64_t bytes) : left_(static_cast<std::size_t>(bytes)) {}
  std::size_t left() const { return left_; }
  void take(std::size_t bytes, const std::string& where);  // throws Error kLimit

 private:
  std::size_t left_;
};

// What decoding did to the document.
struct Decoded {
  std::set<Index> accessors;  // whose values are new
  std::set<Index> buffers;    // that contained compressed bytes
};

// Which of kMeshopt the view is compressed by; null where by none.
const char* meshoptOf(const gltf::BufferView& view);

// Decode all buffer views, all primitives.
void decodeMeshopt(Asset& asset, DecodeBudget& budget, Decoded& decoded);
void decodeDraco(Asset& asset, DecodeBudget& budget, Decoded& decoded);

}  // namespace limber
