#include "limber/crowd/crowd_frames.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/crowd/crowd.h"
#include "limber/crowd/testing/dragon_crowd.h"
#include "limber/crowd/testing/moved_nodes.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"

namespace limber {
namespace {

Crowd twelve() {
  CrowdOptions options;
  options.bodies = 12;
  options.builds = 2;
  options.offsets = 5;
  options.heading = 40;
  std::vector<Motion> motions = {makeSampleMotion("flap"), makeSampleMotion("flap")};
  motions[1].name = "flap again";
  return dragonCrowd(options, motions);
}

Crowd& crowd() {
  static Crowd made = twelve();
  return made;
}

TEST(CrowdFrames, MembersAreWhatWasMade) {
  const Asset read = readAsset(writeGlb(crowd().asset), "crowd.glb");
  const std::vector<CrowdMember> members = crowdMembers(read);
  ASSERT_EQ(members.size(), crowd().bodies.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const CrowdBody& body = crowd().bodies[i];
    EXPECT_EQ(members[i].build, body.build);
    EXPECT_EQ(members[i].clip, crowd().clips[body.clip]);
    EXPECT_NEAR(members[i].offset / 30.0, body.offset, 1e-6);
    EXPECT_LT((members[i].transform.translation() - body.position).norm(), 1e-5);
  }
  EXPECT_TRUE(crowdMembers(dragon()).empty());
}

TEST(CrowdFrames, AMemberAloneHasOneBodysSurfaceAtTheOrigin) {
  const std::vector<CrowdMember> members = crowdMembers(crowd().asset);
  for (const std::size_t i : {std::size_t{0}, members.size() - 1}) {
    const Asset alone = crowdMemberAlone(crowd().asset, members[i]);
    const Asset& build = crowd().builds[members[i].build];
    EXPECT_EQ(readSkeleton(alone).skeleton.jointCount(), readSkeleton(build).skeleton.jointCount());
    const Geometry here = collectGeometry(alone), there = collectGeometry(build);
    ASSERT_EQ(here.positions.size(), there.positions.size());
    for (std::size_t v = 0; v < here.positions.size(); v += 97) {
      EXPECT_LT((here.positions[v] - there.positions[v]).norm(), 1e-4f);
    }
  }
}

// Each joint's position in its table, after the member's placement, is that of the file's nodes and channels.
TEST(CrowdFrames, TablesHoldWhatTheFileShows) {
  const Asset& asset = crowd().asset;
  const std::vector<CrowdMember> members = crowdMembers(asset);
  const CrowdAnimation animation = readCrowdAnimation(asset, members);
  EXPECT_NEAR(animation.seconds, crowd().seconds, 1e-6);
  for (const CrowdMember& member : members) {
    const auto table = std::find_if(animation.tables.begin(), animation.tables.end(), [&](const CrowdFrames& one) {
      return one.build == member.build && one.clip == member.clip;
    });
    ASSERT_NE(table, animation.tables.end());
    const Asset alone = crowdMemberAlone(asset, member);
    const AssetSkeleton binding = readSkeleton(alone);
    const std::vector<Vec3> bound = restPositions(binding.skeleton);
    for (const Index frame : {Index{0}, animation.frames / 3, animation.frames}) {
      const Index row = member.offset - table->first + frame;
      ASSERT_LT(row, table->frames);
      const std::vector<Vec3> moved =
          testing::nodesAt(alone, binding.jointNode, frame * animation.seconds / animation.frames);
      for (Index j = 0; j < table->joints; ++j) {
        const float* numbers = table->matrices.data() + 12 * (std::size_t{row} * table->joints + j);
        const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> rows(numbers);
        EXPECT_LT((rows.cast<double>() * bound[j].homogeneous() - moved[j]).norm(), 1e-4);
      }
    }
  }
}

TEST(CrowdFrames, NotesThatAreNoneAreRefused) {
  for (const char* note : {"7", "{}", R"({"build": 0, "offset_frames": 0})", R"({"build": 1})",
                           R"({"build": 1, "offset_frames": -1})", R"({"build": 1, "offset_frames": 4000000000})"}) {
    Asset asset = dragon();
    asset.document.nodes[1].extras.change()["limber_crowd"] = Json::parse(note);
    EXPECT_THROW(crowdMembers(asset), Error) << note;
  }
}

TEST(CrowdFrames, ABodyThatDoesNotMoveIsRefused) {
  Asset asset = crowd().asset.clone();
  asset.document.animations.clear();
  EXPECT_THROW(readCrowdAnimation(asset, crowdMembers(asset)), Error);
}

}  // namespace
}  // namespace limber
