#include "limber/document/clip/clip_moment.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/gltf_builder.h"

namespace limber {

namespace {

// An arm along x, a triangle on each of its two joints at x = 0 and x = 1. The clip "Rig|bend" turns the second upwards
// by 90 degrees within two seconds.
Asset bendingArm() {
  testing::GltfBuilder file;
  const std::vector<float> corners = {0, 0, 0, 0.5f, 0, 0, 0, 0.2f, 0, 1, 0, 0, 2, 0, 0, 1, 0.2f, 0};
  const Index positions = file.accessor(corners, 5126, "VEC3", 6);
  file.push("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  file.push("nodes", {{"mesh", 0}});
  file.push("scenes", {{"nodes", {0}}});
  Asset asset = readAsset(file.glb(), "arm.glb");

  Skeleton skeleton;
  skeleton.joints.push_back({"upper", std::nullopt, {}, 0});
  Transform along;
  along.translation = Vec3::UnitX();
  skeleton.joints.push_back({"lower", Index{0}, along, 0});
  SkinWeights weights;
  weights.slots = 1;
  weights.joints = {0, 0, 0, 1, 1, 1};
  weights.weights.assign(6, 1.0f);
  attachRig(asset, collectGeometry(asset), skeleton, weights);

  Clip clip;
  clip.name = "Rig|bend";
  const Eigen::Quaternionf up(Eigen::AngleAxisf(static_cast<float>(kPi / 2), Vec3f::UnitZ()));
  clip.rotations.push_back({1, Interpolation::kLinear, {0, 2}, {Eigen::Quaternionf::Identity(), up}});
  addClips(asset, readSkeleton(asset), {&clip, 1});
  return asset;
}

}  // namespace

TEST(ClipMoment, MeshAndJointsStandAsTheClipSays) {
  Asset asset = bendingArm();
  standAt(asset, {"bend", 1});  // halfway: 45 degrees
  const double half = std::sqrt(0.5);
  const std::vector<Vec3f> positions = collectGeometry(asset).positions;
  EXPECT_LT((positions[1] - Vec3f(0.5f, 0, 0)).norm(), 1e-6);
  EXPECT_LT((positions[4].cast<double>() - Vec3(1 + half, half, 0)).norm(), 1e-6);
  const std::vector<Affine> globals = restGlobals(readSkeleton(asset).skeleton);
  EXPECT_LT((globals[1].translation() - Vec3::UnitX()).norm(), 1e-6);
  EXPECT_LT((globals[1].linear() * Vec3::UnitX() - Vec3(half, half, 0)).norm(), 1e-6);
}

TEST(ClipMoment, ThatIsNotThereIsRefused) {
  Asset asset = bendingArm();
  EXPECT_THROW(standAt(asset, {"walk", 0}), Error);
  Asset still = readAsset(testing::GltfBuilder().glb(), "still.glb");
  EXPECT_THROW(standAt(still, {}), Error);
}

}  // namespace limber
