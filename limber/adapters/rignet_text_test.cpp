#include "limber/adapters/rignet_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "limber/core/random.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

// As RigNet writes it: children before parents, vertices with one to three joints.
constexpr std::string_view kText =
    "joints hand 2 0 0.5\n"
    "joints arm 1 0 0\n"
    "joints root0 0 -1e-1 0\n"
    "root root0\n"
    "hier arm hand\n"
    "hier root0 arm\n"
    "skin 0 root0 1.0000\n"
    "skin 2 arm 0.25 hand 0.5 root0 0.25 \n"
    "skin 1 arm 3 root0 1\n";

RignetRig read(std::string_view text, Index vertices = 3) {
  return readRignetText(text, "rig.txt", vertices);
}

std::string textProblem(const std::string& text, Index vertices = 3) {
  try {
    read(text, vertices);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    return error.what();
  }
  return "no error";
}

TEST(RignetText, ParentsComeBeforeChildrenAndPlacesAreLocal) {
  const RignetRig rig = read(kText);
  ASSERT_EQ(rig.skeleton.jointCount(), 3u);
  EXPECT_NO_THROW(checkSkeleton(rig.skeleton));
  EXPECT_EQ(rig.skeleton.joints[0].name, "root0");
  EXPECT_EQ(rig.skeleton.joints[2].name, "hand");
  EXPECT_EQ(rig.skeleton.joints[2].parent, Index{1});
  EXPECT_TRUE(restGlobals(rig.skeleton)[2].translation().isApprox(Vec3(2, 0, 0.5)));
  EXPECT_TRUE(rig.skeleton.joints[1].rest.translation.isApprox(Vec3(1, 0.1, 0)));
}

TEST(RignetText, WeightsAreSortedAndSumTo1) {
  const SkinWeights weights = read(kText).weights;
  ASSERT_EQ(weights.vertexCount(), 3u);
  EXPECT_EQ(weights.jointsOf(2)[0], 2u);
  EXPECT_EQ(weights.weightsOf(2)[0], 0.5f);
  EXPECT_EQ(weights.jointsOf(1)[0], 1u);
  EXPECT_EQ(weights.weightsOf(1)[0], 0.75f);
  EXPECT_EQ(weights.weightsOf(0)[0], 1.0f);
  EXPECT_EQ(weights.weightsOf(0)[1], 0.0f);
}

TEST(RignetText, BlanksLineEndsAndTheOtherWordForJointsAreTaken) {
  std::string text(kText);
  for (std::size_t at = 0; (at = text.find("joints", at)) != std::string::npos;) text.replace(at, 6, "joint");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 4) text.replace(at, 1, " \r\n\n");
  const RignetRig plain = read(kText), other = read(text);
  EXPECT_EQ(other.weights.weights, plain.weights.weights);
  EXPECT_EQ(other.skeleton.joints[2].name, plain.skeleton.joints[2].name);
}

TEST(RignetText, ASkeletonAloneHasNoWeights) {
  EXPECT_EQ(read(kText.substr(0, kText.find("skin"))).weights.slots, 0u);
}

TEST(RignetText, AVertexWithoutALineHasNoWeights) {
  const SkinWeights weights = read(kText, 5).weights;
  ASSERT_EQ(weights.vertexCount(), 5u);
  EXPECT_EQ(weights.weightsOf(4)[0], 0.0f);
}

TEST(RignetText, TheRootMayBeLeftOutAndOthersMayHangOnNothing) {
  const RignetRig rig = read("joints a 0 0 0\njoints b 1 0 0\njoints c 2 0 0\nhier b a\n");
  EXPECT_EQ(rig.skeleton.joints[0].name, "b");
  EXPECT_EQ(rig.skeleton.joints[2].name, "c");
  EXPECT_FALSE(rig.skeleton.joints[2].parent);
  ASSERT_EQ(rig.warnings.items().size(), 1u);
  EXPECT_EQ(rig.warnings.items()[0].kind, "loose-joints");
  EXPECT_EQ(read("joints a 0 0 0\njoints c 2 0 0\nroot c\n").skeleton.joints[0].name, "c");
}

TEST(RignetText, ErrorsNameTheLine) {
  const std::string text(kText);
  EXPECT_THAT(textProblem(""), HasSubstr("rig.txt: has no joint"));
  EXPECT_THAT(textProblem("Traceback (most recent call last):\n"), HasSubstr("line 1: begins with 'Traceback'"));
  EXPECT_THAT(textProblem(text + "joints arm 0 0 0\n"), HasSubstr("line 10: names the joint 'arm' a second time"));
  EXPECT_THAT(textProblem(text + "joints b 0 0\n"), HasSubstr("line 10: is not 'joints NAME x y z'"));
  EXPECT_THAT(textProblem(text + "joints b 0 0 nan\n"), HasSubstr("line 10: 'nan' is no number"));
  EXPECT_THAT(textProblem(text + "joints b 0 0 1m\n"), HasSubstr("'1m' is no number"));
  EXPECT_THAT(textProblem(text + "root arm\n"), HasSubstr("line 10: names a second root"));
  EXPECT_THAT(textProblem(text + "hier hand root0\n"), HasSubstr("the root 'root0' has a parent"));
  EXPECT_THAT(textProblem(text + "hier root0 hand\n"), HasSubstr("line 10: gives the joint 'hand' a second parent"));
  EXPECT_THAT(textProblem(text + "hier root0 leg\n"), HasSubstr("names the joint 'leg', which has no place"));
  EXPECT_THAT(textProblem(text + "skin 3 arm 1\n"),
              HasSubstr("binds vertex 3, but the model that was handed over has 3"));
  EXPECT_THAT(textProblem(text + "skin 1 arm 1\n"), HasSubstr("line 10: binds vertex 1 a second time"));
  EXPECT_THAT(textProblem(text + "skin -1 arm 1\n"), HasSubstr("'-1' is no vertex"));
  EXPECT_THAT(textProblem(text + "skin 0.5 arm 1\n"), HasSubstr("'0.5' is no vertex"));
  EXPECT_THAT(textProblem(text + "skin 3 arm 1\n", 4), "no error");
  EXPECT_THAT(textProblem(text + "skin 3 arm\n", 4), HasSubstr("is not 'skin VERTEX NAME w NAME w ...'"));
  EXPECT_THAT(textProblem(text + "skin 3 leg 1\n", 4), HasSubstr("names the joint 'leg'"));
  EXPECT_THAT(textProblem(text + "skin 3 arm -0.5\n", 4), HasSubstr("has the weight -0.5"));
  EXPECT_THAT(textProblem(text + "skin 3 arm 1 arm 1\n", 4), HasSubstr("has 'arm' a second time"));
  EXPECT_THAT(textProblem("joints a 0 0 0\njoints b 0 0 1\nhier a b\nhier b a\n"), HasSubstr("is below itself"));
}

// Whatever comes is read or refused, and what is read is sound.
TEST(RignetText, EveryLengthAndManyBytePatchesAreReadOrRefused) {
  const auto look = [](std::string_view text) {
    try {
      const RignetRig rig = read(text);
      checkSkeleton(rig.skeleton);
      for (const Index joint : rig.weights.joints) ASSERT_LT(joint, rig.skeleton.jointCount());
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  for (std::size_t length = 0; length <= kText.size(); ++length) look(kText.substr(0, length));
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string text(kText);
    for (int k = 0; k < 3; ++k) text[random.below(text.size())] = static_cast<char>(random.below(256));
    look(text);
  }
}

}  // namespace
}  // namespace limber
