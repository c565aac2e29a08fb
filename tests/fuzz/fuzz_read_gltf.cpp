// Any bytes as a GLB or glTF file: an Error, or an asset that passes every check, whose geometry and rig can be read,
// and that comes back from writing.
#include <cstdlib>
#include <vector>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/document/read.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"

namespace {

// What the document refers to, given out of the same bytes.
std::optional<limber::Bytes> anyFile(limber::ByteSpan bytes) {
  return limber::Bytes(bytes.begin(), bytes.end());
}

template <typename Use>
void allowErrors(const Use& use) {
  try {
    use();
  } catch (const limber::Error&) {
  }
}

void useAsset(const limber::Asset& asset) {
  allowErrors([&] {
    const limber::Geometry geometry = limber::collectGeometry(asset);
    limber::readNormals(asset, geometry);
    limber::exportMesh(asset, geometry);
  });
  allowErrors([&] {
    if (!limber::hasRig(asset)) return;
    const limber::AssetSkeleton skeleton = limber::readSkeleton(asset);
    limber::readWeights(asset, limber::collectGeometry(asset), skeleton);
  });
  allowErrors([&] {
    limber::Asset bare = asset.clone();
    limber::removeRig(bare);
    limber::checkAsset(bare);
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const limber::ByteSpan bytes(data, size);
  limber::Asset asset;
  try {
    asset = limber::readAsset(bytes, "input.gltf", [&](std::string_view) { return anyFile(bytes); });
  } catch (const limber::Error&) {
    return 0;
  }
  limber::checkAsset(asset);
  useAsset(asset);
  // What limber writes it must read again, and write the same.
  const limber::Bytes written = limber::writeGlb(asset);
  if (limber::writeGlb(limber::readAsset(written, "again.glb")) != written) std::abort();
  return 0;
}
