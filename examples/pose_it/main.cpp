// pose_it RIGGED POSED.glb STATUE.obj: turns one joint, reaches with another; as a pose of the rig, and as a mesh for
// good.
#include <cstdio>

#include <limber/limber.h>

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: pose_it RIGGED POSED.glb STATUE.obj\n"), 2;
  try {
    limber::Asset model = limber::readAsset(argv[1]);
    const limber::AssetSkeleton rig = limber::readSkeleton(model);
    limber::Pose pose = limber::restPose(rig.skeleton);

    // World space, metres: the head turns by 30 degrees, the left hand goes 10 cm up and 20 cm to the front.
    const limber::Index hand = rig.skeleton.find("leftHand").value_or(rig.skeleton.jointCount() - 1);
    limber::PoseEdits edits;
    if (rig.skeleton.find("head")) edits.turns = limber::parseTurn("head=y:30");
    edits.reaches.push_back({.joint = rig.skeleton.joints[hand].name,
                             .target = limber::restPositions(rig.skeleton)[hand] + limber::Vec3(0, 0.1, 0.2),
                             .pole = std::nullopt,
                             .base = std::nullopt});
    for (const limber::ReachReport& reach : limber::editPose(rig.skeleton, pose, edits)) {
      std::printf("%s: %.1f mm left\n", reach.joint.c_str(), 1000 * reach.distance);
    }

    // The posed surface, by any deformer: an OBJ to print.
    const limber::PosedGeometry posed = limber::posedGeometry(model, rig, pose, limber::findDeformer("delta-mush"));
    limber::writeMesh(limber::exportMesh(model, posed.geometry), argv[3]);

    // The posed rig, which can be posed further.
    limber::writeNodePose(model, rig, pose);
    limber::writeAsset(model, argv[2]);
  } catch (const limber::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
