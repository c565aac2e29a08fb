#include "limber/evaluate/held_out.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(HeldOut, MakersAreReadOffNames) {
  EXPECT_EQ(makerOf("rigged/quaternius_cow.glb"), "quaternius");
  EXPECT_EQ(makerOf("rigged/kaykit_mannequin/manny_med_mod.gltf"), "kaykit");
  EXPECT_EQ(makerOf("motions/cmu1_jumping_jacks.bvh"), "cmu");
  EXPECT_EQ(makerOf("walk.bvh"), "walk");
}

TEST(HeldOut, FilesOfOneMakerAreInOneHalf) {
  EXPECT_EQ(isHeldOut("cmu_daz_02_01_walk.bvh"), isHeldOut("motions/cmu1_jumping_jacks.bvh"));
  EXPECT_NE(isHeldOut("a_1.bvh"), isHeldOut("b_1.bvh"));
}

}  // namespace
}  // namespace limber
