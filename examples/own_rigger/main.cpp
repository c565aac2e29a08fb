// own_rigger MODEL RIGGED.glb: a rigger of one's own, a spine along the longest side, with limber's weights. Replace
// it by your method: a skeleton is all that it returns.
#include <cstdio>

#include <limber/limber.h>

namespace {

// Six joints evenly along the longest side of the mesh, through the middle of each slice.
limber::Skeleton spineOf(const limber::TriMesh& mesh) {
  constexpr limber::Index kJoints = 6;
  Eigen::AlignedBox3f box;
  for (const limber::Vec3f& p : mesh.positions) box.extend(p);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::vector<limber::Vec3> sums(kJoints, limber::Vec3::Zero());
  std::vector<double> counts(kJoints, 0);
  for (const limber::Vec3f& p : mesh.positions) {
    const double along = (p[axis] - box.min()[axis]) / box.sizes()[axis];
    const auto slice = std::min<std::size_t>(kJoints - 1, static_cast<std::size_t>(along * kJoints));
    sums[slice] += p.cast<double>();
    counts[slice] += 1;
  }
  limber::Skeleton skeleton;
  limber::Vec3 before = limber::Vec3::Zero();
  for (limber::Index j = 0; j < kJoints; ++j) {
    if (counts[j] == 0) continue;
    limber::Joint joint;
    joint.name = "spine_" + std::to_string(j);
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    const limber::Vec3 position = sums[j] / counts[j];
    joint.rest.translation = position - before;  // seen from its parent
    before = position;
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: own_rigger MODEL RIGGED.glb\n"), 2;
  try {
    limber::Asset model = limber::readAsset(argv[1]);
    const limber::Geometry geometry = limber::collectGeometry(model);
    const limber::TriMesh mesh{geometry.positions, geometry.triangles};
    const limber::Skeleton skeleton = spineOf(mesh);

    // Weights are made on one welded surface, and handed to every vertex of the file.
    limber::PreparedMesh welded = limber::prepareMesh(mesh.positions, mesh.triangles);
    for (limber::Vec3f& p : welded.mesh.positions) p = welded.frame.toSource(p.cast<double>()).cast<float>();
    limber::Progress progress;
    const limber::WeightResult weights =
        limber::findWeightMethod("bone-heat")
            .compute(welded.mesh, limber::bonesOf(skeleton), limber::WeightOptions(), progress);
    limber::attachRig(model, geometry, skeleton, limber::expandWeights(weights.weights, welded.weldedVertex));
    limber::writeAsset(model, argv[2]);
    std::printf("%u joints, %zu vertices without a bone near\n", skeleton.jointCount(), weights.bridged.size());
  } catch (const limber::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
