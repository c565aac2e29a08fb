// evaluate RIGGED [ARTISTS]: how good a rig is by itself, and how near it comes to an artist's.
#include <cstdio>

#include <limber/limber.h>

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: evaluate RIGGED [ARTISTS]\n"), 2;
  try {
    const limber::Asset rigged = limber::readAsset(argv[1]);
    const limber::ModelQuality quality = limber::measureModel(rigged);
    std::printf("joints            %u, %.0f %% of them inside\n", quality.joints, 100 * quality.placement.inside);
    if (quality.motion) {
      std::printf("stretch           %.3f over %zu poses\n", quality.motion->mean.stretch.mean,
                  quality.motion->poses.size());
    }
    if (argc == 3) {
      const limber::RigComparison comparison = limber::compareRigs(rigged, limber::readAsset(argv[2]));
      std::printf("joint to joint    %.2f %% of the longest side\n", comparison.withoutFingers.jointToJoint);
      std::printf("joints in common  %.2f\n", comparison.withoutFingers.iou);
    }
  } catch (const limber::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
