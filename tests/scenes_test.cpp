// The example scenes (samples/scenes): lists of commands that give, done again, the poses that lie beside them.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/file/file.h"
#include "limber/document/clip/pose_file.h"
#include "limber/session/scene/scene.h"
#include "limber/skeleton/pose.h"
#include "shared_data.h"
#include "source_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

fs::path exampleFolder() {
  return limber::testing::sourceFolder() / "samples/scenes";
}

std::string textOf(const fs::path& path) {
  const Bytes bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

Bytes bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

struct ExampleScene {
  const char* name;
  Index handles;
  std::vector<std::string> feet;  // handles that stand on the floor
};

std::ostream& operator<<(std::ostream& out, const ExampleScene& scene) {
  return out << scene.name;
}

class ExampleScenes : public ::testing::TestWithParam<ExampleScene> {
 protected:
  void SetUp() override {
    Progress progress;
    for (const Command& command :
         commandsFromJson(textOf(exampleFolder() / (std::string(GetParam().name) + ".json")))) {
      scene_.run(command, progress);
    }
  }
  const SessionState& state() const { return scene_.session().state(); }

  SessionScene scene_;
};

TEST_P(ExampleScenes, StandsInThePoseThatIsKeptBesideIt) {
  const Skeleton& skeleton = state().rig->skeleton();
  EXPECT_EQ(skeleton.jointCount(), GetParam().handles);
  writeFile(testing::testOutputFolder() / (std::string(GetParam().name) + ".pose.json"),  // to look at, or to keep
            bytesOf(scene_.session().savePose(GetParam().name)));
  const PortablePose kept =
      poseFromJson(textOf(exampleFolder() / "poses" / (std::string(GetParam().name) + ".pose.json")));
  const std::optional<Pose> pose = poseByNames(kept, skeleton);
  ASSERT_TRUE(pose);
  const std::vector<Affine> expected = poseGlobals(skeleton, *pose), globals = poseGlobals(skeleton, state().pose);
  for (std::size_t j = 0; j < globals.size(); ++j) {
    EXPECT_LT((globals[j].matrix() - expected[j].matrix()).norm(), 1e-5) << skeleton.joints[j].name;
  }
}

// Of the surface that a handle moves more than any other one.
double lowestOf(const SessionState& state, Index joint) {
  const std::vector<Vec3f> posed = posedPositions(*state.rig, state.pose);
  double lowest = 1e30;
  for (Index v = 0; v < posed.size(); ++v) {
    if (state.rig->weights.jointsOf(v)[0] == joint) lowest = std::min(lowest, double(posed[v].y()));
  }
  return lowest;
}

TEST_P(ExampleScenes, StandsOnTheFloor) {
  constexpr double kNear = 0.015;  // metres
  double lowest = 1e30;
  for (const Vec3f& p : posedPositions(*state().rig, state().pose)) lowest = std::min(lowest, double(p.y()));
  EXPECT_GT(lowest, -kNear);
  for (const std::string& foot : GetParam().feet) {
    const std::optional<Index> joint = state().rig->skeleton().find(foot);
    ASSERT_TRUE(joint) << foot;
    EXPECT_NEAR(lowestOf(state(), *joint), 0, kNear) << foot;
  }
}

// No triangle is turned inside out or stretched into a needle where the model folds: nearly all keep more than a tenth
// of their area.
TEST_P(ExampleScenes, KeepsItsSurfaceWhole) {
  const RiggedModel& rig = *state().rig;
  const std::vector<Vec3f> posed = posedPositions(rig, state().pose);
  const auto area = [](const std::vector<Vec3f>& at, const Triangle& t) {
    return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm();
  };
  std::size_t collapsed = 0;
  for (const Triangle& t : rig.geometry().triangles) {
    collapsed += area(posed, t) < 0.1f * area(rig.geometry().positions, t);
  }
  EXPECT_LT(collapsed, rig.geometry().triangles.size() / 100);
}

TEST_P(ExampleScenes, IsTheSameWhenDoneTwice) {
  Progress progress;
  SessionScene again;
  for (const Command& command : scene_.record()) again.run(command, progress);
  const Bytes once = scene_.exportModel(ExportFormat::kGlb);
  EXPECT_TRUE(once == again.exportModel(ExportFormat::kGlb));
  writeFile(testing::testOutputFolder() / ("scene_" + std::string(GetParam().name) + ".glb"), once);
}

INSTANTIATE_TEST_SUITE_P(
    All, ExampleScenes,
    ::testing::Values(ExampleScene{"dancing-stool", 10, {"handle_04.R", "handle_05.L", "handle_05.R"}},
                      ExampleScene{"standing-dinosaur", 20, {"handle_12.L", "handle_12.R"}},
                      ExampleScene{"eating-dinosaur", 20, {"handle_12.L", "handle_12.R"}},
                      ExampleScene{"sitting-dragon", 20, {"handle_09.L", "handle_09.R", "handle_10.L", "handle_10.R"}}),
    [](const auto& scene) {
      std::string name = scene.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

// What came with a rig and a flight is a mesh with handles then.
TEST(SittingDragon, HasNoClipLeft) {
  Progress progress;
  SessionScene scene;
  scene.run(OpenSample{"flying", true}, progress);
  ASSERT_EQ(scene.session().state().movement.clips.size(), 1u);
  ASSERT_TRUE(scene.session().state().rig->skeleton().find("wing_hand.L"));
  for (const Command& command : commandsFromJson(textOf(exampleFolder() / "sitting-dragon.json"))) {
    scene.run(command, progress);
  }
  EXPECT_TRUE(scene.session().state().movement.clips.empty());
  EXPECT_FALSE(scene.session().state().rig->skeleton().find("wing_hand.L"));
}

}  // namespace
}  // namespace limber
