#include "limber/samples/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"
#include "shared_data.h"

namespace limber {
namespace {

class Samples : public ::testing::TestWithParam<std::string_view> {};

using Point = std::array<float, 3>;
Point key(float x, float y, float z) {
  return {x == 0 ? 0.0f : x, y, z};
}

void expectClosed(const TriMesh& mesh) {
  std::map<std::pair<Index, Index>, int> directed;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) ++directed[{t[c], t[(c + 1) % 3]}];
  }
  int wrong = 0;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    if (count != 1 || back == directed.end() || back->second != 1) ++wrong;
  }
  EXPECT_EQ(wrong, 0) << "edges that do not have one triangle on either side";
}

void expectSymmetric(const Geometry& geometry) {
  std::set<Point> points;
  for (const Vec3f& p : geometry.positions) points.insert(key(p.x(), p.y(), p.z()));
  int alone = 0;
  for (const Vec3f& p : geometry.positions) alone += points.count(key(-p.x(), p.y(), p.z())) == 0;
  EXPECT_EQ(alone, 0) << "vertices without a mirror image";
}

// Six times the volume that the triangles enclose: positive where they are wound outwards.
double signedVolume(const Geometry& geometry) {
  double sum = 0;
  for (const Triangle& t : geometry.triangles) {
    const Vec3 a = geometry.positions[t[0]].cast<double>();
    sum += a.dot(geometry.positions[t[1]].cast<double>().cross(geometry.positions[t[2]].cast<double>()));
  }
  return sum;
}

TEST_P(Samples, IsAClosedSymmetricModelOnItsFeet) {
  const Asset asset = makeSample(GetParam());
  checkAsset(asset);
  const Geometry geometry = collectGeometry(asset);
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  EXPECT_TRUE(prepared.warnings.empty());
  EXPECT_GT(prepared.mesh.vertexCount(), 4000u);
  EXPECT_LT(prepared.mesh.vertexCount(), 12000u);
  expectClosed(prepared.mesh);
  expectSymmetric(geometry);
  EXPECT_GT(signedVolume(geometry), 0);
  Box box;
  for (const Vec3f& p : geometry.positions) box.add(p.cast<double>());
  EXPECT_NEAR(box.min.y(), 0, 2e-3);
  EXPECT_GT(box.size().minCoeff(), 0.2);
  EXPECT_LT(box.size().maxCoeff(), 2.0);
}

TEST_P(Samples, IsTheSameWithAnyNumberOfThreadsAndReadsBack) {
  setThreadCount(1);
  const Bytes one = writeGlb(makeSample(GetParam()));
  setThreadCount(3);
  const Bytes three = writeGlb(makeSample(GetParam()));
  setThreadCount(0);
  EXPECT_TRUE(one == three);
  const Asset again = readAsset(one, "sample.glb");
  EXPECT_TRUE(again.warnings.empty());
  writeFile(testing::testOutputFolder() / ("sample_" + std::string(GetParam()) + ".glb"), one);
}

INSTANTIATE_TEST_SUITE_P(All, Samples,
                         ::testing::Values("stool", "footstool", "biped", "quadruped", "winged", "theropod", "flying",
                                           "robot"),
                         [](const auto& sample) { return std::string(sample.param); });

TEST(SampleTable, ListsModelsWithASummaryEach) {
  std::set<std::string_view> names;
  for (const SampleModel& sample : sampleModels()) {
    names.insert(sample.name);
    EXPECT_FALSE(sample.summary.empty());
  }
  EXPECT_EQ(names.size(), 8u);
}

TEST(SampleTable, AnUnknownNameListsTheOthers) {
  try {
    makeSample("unicorn");
    FAIL() << "made a unicorn";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("stool, footstool, biped, quadruped, winged, theropod, flying, robot"));
  }
}

TEST(Flying, ComesWithARigAndABeatOfItsWingsThatRepeats) {
  const Asset flying = makeSample("flying");
  ASSERT_TRUE(hasRig(flying));
  const AssetSkeleton rig = readSkeleton(flying);
  Warnings warnings;
  const std::vector<Clip> clips = readClips(flying, rig, warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "fly");
  const Index hand = rig.skeleton.find("wing_hand.L").value(), other = rig.skeleton.find("wing_hand.R").value();
  const auto handsAt = [&](double fraction) {
    Pose pose = restPose(rig.skeleton);
    sampleClip(clips[0], fraction * clips[0].duration(), pose);
    const std::vector<Vec3> positions = posePositions(rig.skeleton, pose);
    return std::pair(positions[hand], positions[other]);
  };
  EXPECT_GT(handsAt(0).first.y() - handsAt(0.5).first.y(), 0.3);  // metres, up and down
  EXPECT_LT((handsAt(0).first - handsAt(1).first).norm(), 1e-5);
  for (const double fraction : {0.0, 0.3, 0.7}) {
    const auto [left, right] = handsAt(fraction);
    EXPECT_LT((left - Vec3(-right.x(), right.y(), right.z())).norm(), 1e-5);
  }
}

TEST(Robot, SharesMeshesAmongNodes) {
  const Asset robot = makeSample("robot");
  std::map<Index, int> uses;
  for (const gltf::Node& node : robot.document.nodes) {
    if (node.mesh) ++uses[*node.mesh];
  }
  int shared = 0;
  for (const auto& [mesh, count] : uses) shared += count > 1;
  EXPECT_GE(shared, 6);
  EXPECT_GT(collectGeometry(robot).instances.size(), 20u);
}

}  // namespace
}  // namespace limber
