// Any bytes as a packet of VMC's and as a BVH that comes in pieces: taken or refused, and what is taken is a pose of
// finite numbers.
#include <cstdlib>

#include "limber/document/bvh/bvh_stream.h"
#include "limber/document/live/live_text.h"
#include "limber/document/live/vmc_stream.h"

namespace {

void check(const limber::Skeleton& skeleton, const limber::Pose& pose) {
  limber::checkSkeleton(limber::liveSkeletonFrom(limber::liveSkeletonText(skeleton)));
  for (const limber::Transform& local : pose.locals) {
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::VmcStream vmc;
  vmc.take({data, size}, 0);
  if (const limber::Skeleton* skeleton = vmc.skeleton(1)) check(*skeleton, vmc.pose());
  limber::BvhStream bvh;
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    bvh.take(text.substr(0, size / 2));
    bvh.take(text.substr(size / 2));
    if (bvh.rows() > 0) check(*bvh.skeleton(), bvh.pose());
  } catch (const limber::Error&) {
  }
  return 0;
}
