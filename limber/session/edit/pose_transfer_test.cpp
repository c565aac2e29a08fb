#include "limber/session/edit/pose_transfer.h"

#include <gtest/gtest.h>

#include "limber/samples/samples.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

double meanDistance(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).norm();
  return sum / static_cast<double>(a.size());
}

TEST(TransferPose, RestStaysRestToTheBit) {
  const auto few = testing::rigBiped(10), many = testing::rigBiped(30);
  const Pose pose = transferPose(*few, few->home, *many);
  for (Index j = 0; j < pose.locals.size(); ++j) {
    EXPECT_EQ(pose.locals[j].translation, many->home.locals[j].translation);
    EXPECT_EQ(pose.locals[j].rotation.coeffs(), many->home.locals[j].rotation.coeffs());
  }
}

TEST(TransferPose, AModelThatMovesAsAWholeMovesExactly) {
  const auto few = testing::rigBiped(6), many = testing::rigBiped(40);
  Pose pose = restPose(few->skeleton());
  Transform& root = pose.locals[0];
  root.rotation = Quat(Eigen::AngleAxisd(2.5, Vec3(1, 2, -1).normalized()));
  root.translation += Vec3(0.5, 3, -1);
  const std::vector<Vec3f> before = posedPositions(*few, pose);
  const std::vector<Vec3f> after = posedPositions(*many, transferPose(*few, pose, *many));
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_LT((before[v] - after[v]).norm(), 2e-5);
}

TEST(TransferPose, MoreAndFewerHandlesKeepWhatCanBeKept) {
  const auto from = testing::rigBiped(20);
  Pose pose = restPose(from->skeleton());
  for (Index j = 1; j < pose.locals.size(); j += 3) {
    pose.locals[j].rotation = Quat(Eigen::AngleAxisd(0.5, Vec3(1, j % 2 ? 1.0 : -1.0, 0.3).normalized()));
  }
  const std::vector<Vec3f> posed = posedPositions(*from, pose);
  const double moved = meanDistance(posed, from->geometry().positions);
  ASSERT_GT(moved, 0.02);
  for (const Index handles : {14, 30, 60}) {
    const auto to = testing::rigBiped(handles);
    const double left = meanDistance(posed, posedPositions(*to, transferPose(*from, pose, *to)));
    EXPECT_LT(left, moved * (handles < 20 ? 0.4 : 0.2)) << handles << " handles";
  }
}

TEST(TransferPose, ShareByShareIsWhatVertexByVertexGives) {
  const auto from = testing::rigBiped(20), to = testing::rigBiped(13);
  Pose pose = restPose(from->skeleton());
  for (Index j = 0; j < pose.locals.size(); j += 2) {
    pose.locals[j].rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(0.2, 1, j % 4 ? -1.0 : 0.5).normalized()));
  }
  const Pose given = transferPose(*from, pose, *to);
  const std::vector<Vec3f>&bound = to->geometry().positions, posed = posedPositions(*from, pose);
  const std::vector<Affine> rest = restGlobals(to->skeleton()), globals = poseGlobals(to->skeleton(), given);
  for (Index j = 0; j < to->skeleton().jointCount(); ++j) {
    double weight = 0;
    Vec3 before = Vec3::Zero(), after = Vec3::Zero();
    for (Index v = 0; v < to->weights.vertexCount(); ++v) {
      for (Index k = 0; k < to->weights.slots; ++k) {
        if (to->weights.jointsOf(v)[k] != j) continue;
        const double w = double{to->weights.weightsOf(v)[k]} * to->weights.weightsOf(v)[k];
        weight += w;
        before += w * bound[v].cast<double>();
        after += w * posed[v].cast<double>();
      }
    }
    // The rigid motion that fits best takes the one middle to the other.
    ASSERT_GT(weight, 0);
    const Vec3 moved = globals[j] * (rest[j].inverse(Eigen::Affine) * Vec3(before / weight));
    EXPECT_LT((moved - after / weight).norm(), 1e-5) << j;
  }
}

TEST(TransferPose, AClipGoesOverKeyByKey) {
  const auto from = testing::rigBiped(20), to = testing::rigBiped(28);
  Clip clip;
  clip.name = "nod";
  clip.rotations.push_back({5, Interpolation::kLinear, {0, 0.5f, 2}, {}});
  for (const float angle : {0.0f, 0.6f, -0.3f}) {
    clip.rotations[0].values.emplace_back(Eigen::AngleAxisf(angle, Vec3f::UnitX()));
  }
  const Clip moved = transferClip(PoseTransfer(*from, *to), *from, clip, *to);
  EXPECT_EQ(moved.name, "nod");
  EXPECT_NO_THROW(checkClip(moved, to->skeleton()));
  EXPECT_EQ(moved.duration(), 2);
  for (const double seconds : {0.0, 0.5, 2.0}) {
    Pose before = restPose(from->skeleton()), after = restPose(to->skeleton());
    sampleClip(clip, seconds, before);
    sampleClip(moved, seconds, after);
    const Pose expected = transferPose(*from, before, *to);
    EXPECT_LT(meanDistance(posedPositions(*to, expected), posedPositions(*to, after)), 1e-5) << seconds;
  }
}

TEST(TransferPose, NothingGoesFromOneModelToAnother) {
  Progress progress;
  const auto stool = makeRiggedModel(makeSample("stool"), {}, progress), person = testing::rigBiped(6);
  Pose pose = restPose(stool->skeleton());
  pose.locals[0].translation += Vec3(1, 0, 0);
  EXPECT_EQ(transferPose(*stool, pose, *person).locals[0].translation, person->home.locals[0].translation);
}

}  // namespace
}  // namespace limber
