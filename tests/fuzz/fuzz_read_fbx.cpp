// Any bytes as an FBX file, binary or text: an Error, or a document that passes every check and comes back from
// writing.
#include <cstdlib>

#include "limber/document/asset.h"
#include "limber/document/fbx/import_fbx.h"
#include "limber/document/read.h"
#include "limber/document/write.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const limber::ByteSpan bytes(data, size);
  limber::Bytes written;
  try {
    const limber::Asset asset =
        limber::importFbx(bytes, [&](std::string_view) { return limber::Bytes(data, data + size); });
    limber::checkAsset(asset);
    written = limber::writeGlb(asset);
  } catch (const limber::Error&) {
    return 0;
  }
  // What limber writes it must read again, and write the same.
  if (limber::writeGlb(limber::readAsset(written, "again.glb")) != written) std::abort();
  return 0;
}
