// live_motion CHARACTER MOTION: a motion that comes frame by frame, as from a suit or a camera, put on the character as
// it comes.
#include <chrono>
#include <cstdio>

#include <limber/limber.h>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: live_motion CHARACTER MOTION\n"), 2;
  try {
    const limber::Asset character = limber::readAsset(argv[1]);
    const limber::AssetSkeleton rig = limber::readSkeleton(character);
    const limber::Motion motion = limber::readMotion(argv[2]);
    if (motion.clips.empty()) return std::fprintf(stderr, "%s: holds no motion\n", argv[2]), 1;

    // Once: which joint follows which, how the bodies' spaces compare, what the surface needs.
    limber::RetargetOptions options;
    options.characterOnGround = true;
    const limber::RetargetSetup setup(motion.skeleton, rig.skeleton,
                                      limber::matchSkeletons(motion.skeleton, rig.skeleton), options);
    const std::unique_ptr<limber::FrameRetargeter> retargeter = limber::findRetargetMethod("limb-ik").make(setup);
    const limber::AssetPoser poser(character, rig, limber::findDeformer("linear-blend"));

    // Each frame: what the source sent, the character's joints, its surface.
    limber::Pose source = limber::restPose(motion.skeleton), target = limber::restPose(rig.skeleton);
    const limber::Clip& clip = motion.clips.front();
    const limber::Index frames = limber::frameCount(clip, motion.framesPerSecond);
    const auto started = std::chrono::steady_clock::now();
    float highest = 0;
    for (limber::Index frame = 0; frame < frames; ++frame) {
      limber::sampleClip(clip, frame / motion.framesPerSecond, source);
      retargeter->next(source, frame == 0 ? 0 : 1 / motion.framesPerSecond, target);
      for (const limber::Vec3f& p : poser.posed(target).geometry.positions) highest = std::max(highest, p.y());
    }
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - started;
    std::printf("%u frames, the highest point at %.2f m\n", frames, highest);
    std::fprintf(stderr, "%.2f ms a frame\n", taken.count() / frames);
  } catch (const limber::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
