// Any bytes as a BVH file: an Error, or a motion that keeps its rules, that can be written as BVH and as glTF, and that
// is read again from both.
#include <cstdlib>

#include "limber/document/bvh/bvh_read.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/write.h"

namespace {

void writeAndRead(const limber::Motion& motion) {
  limber::Bytes glb;
  try {
    const limber::Bytes bvh = limber::writeBvh(motion);
    limber::checkMotion(limber::readBvh(bvh, "again.bvh"));
    glb = limber::writeGlb(limber::motionAsset(motion));
  } catch (const limber::Error& error) {
    // Names that cannot stand in a BVH, and frames or numbers beyond what can be written.
    if (error.code() == limber::ErrorCode::kBadData && !glb.empty()) std::abort();
    return;
  }
  const limber::Motion back = limber::readMotion(glb, "again.glb");
  limber::checkMotion(back);
  if (back.skeleton.joints.size() < motion.skeleton.joints.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::Motion motion;
  try {
    motion = limber::readBvh(limber::ByteSpan(data, size), "input.bvh");
  } catch (const limber::Error&) {
    return 0;
  }
  limber::checkMotion(motion);
  // Frame rates far apart from what they are read with make long texts of short files.
  const bool writable = !motion.clips.empty() && limber::frameCount(motion.clips[0], motion.framesPerSecond) < 1000;
  if (writable) writeAndRead(motion);
  return 0;
}
