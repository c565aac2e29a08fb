// A clip from each format into each and back: where all joints and the surface are, it is the same motion, or a warning
// says what is lost.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/actions/export/testing/gltf_player.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "limber/document/testing/npy_bytes.h"
#include "limber/document/testing/stored_zip.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "testing/cli_fixture.h"

namespace limber {
namespace {

constexpr double kTolerance = 1e-4;  // of the model's size
constexpr int kMoments = 20;

// A mesh of its own format, whose joints are called as VRM's bones.
Asset walker() {
  Motion walk = makeSampleMotion("walk");
  walk.clips[0] = trimClip(walk.clips[0], 0, 1);
  return testing::avatarOf(walk);
}

// Two arms that turn, the lower one against the upper.
std::string collada() {
  std::string times, upper, lower;
  for (int frame = 0; frame <= 10; ++frame) {
    const double angle = 0.1 * frame, c = std::cos(angle), s = std::sin(angle);
    times += fmt::format("{} ", frame / 20.0);
    upper += fmt::format("{} {} 0 0 {} {} 0 1 0 0 1 0 0 0 0 1 ", c, -s, s, c);
    lower += fmt::format("{} {} 0 0.5 {} {} 0 0 0 0 1 0 0 0 0 1 ", c, s, -s, c);
  }
  const auto source = [](const std::string& id, const std::string& values, int count, int stride) {
    return fmt::format(
        "<source id='{0}'><float_array id='{0}-a' count='{1}'>{2}</float_array><technique_common>"
        "<accessor source='#{0}-a' count='{3}' stride='{4}'><param name='X' type='{5}'/></accessor>"
        "</technique_common></source>",
        id, count * stride, values, count, stride, stride == 16 ? "float4x4" : "float");
  };
  const auto animation = [&](const std::string& joint, const std::string& values) {
    std::string lines;
    for (int key = 0; key <= 10; ++key) lines += "LINEAR ";
    return "<animation>" + source(joint + "-t", times, 11, 1) + source(joint + "-v", values, 11, 16) +
           fmt::format(
               "<source id='{0}-i'><Name_array id='{0}-n' count='11'>{1}</Name_array><technique_common>"
               "<accessor source='#{0}-n' count='11' stride='1'><param name='I' type='name'/></accessor>"
               "</technique_common></source><sampler id='{0}-s'><input semantic='INPUT' source='#{0}-t'/>"
               "<input semantic='OUTPUT' source='#{0}-v'/><input semantic='INTERPOLATION' source='#{0}-i'/>"
               "</sampler><channel source='#{0}-s' target='{0}/transform'/></animation>",
               joint, lines);
  };
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
         "<asset><unit meter='1'/><up_axis>Y_UP</up_axis></asset><library_animations>" +
         animation("upper", upper) + animation("lower", lower) +
         "</library_animations><library_visual_scenes><visual_scene id='s'>"
         "<node id='upper' name='upper' type='JOINT'><matrix sid='transform'>1 0 0 0 0 1 0 1 0 0 1 0 0 0 0 1</matrix>"
         "<node id='lower' name='lower' type='JOINT'><matrix sid='transform'>1 0 0 .5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
         "<node id='hand' name='hand' type='JOINT'><matrix sid='transform'>1 0 0 .5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
         "</node></node></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

std::string smplArrays() {
  std::vector<double> poses, distances;
  for (int frame = 0; frame < 10; ++frame) {
    std::vector<double> row(66, 0.0);
    row[3 * 16 + 2] = 0.1 * frame;
    row[3 * 4 + 0] = 0.05 * frame;
    poses.insert(poses.end(), row.begin(), row.end());
    distances.insert(distances.end(), {0, 0, 0.02 * frame});
  }
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [name, bytes] :
       std::vector<std::pair<std::string, Bytes>>{{"poses.npy", testing::npyDoubles({10, 66}, poses)},
                                                  {"trans.npy", testing::npyDoubles({10, 3}, distances)},
                                                  {"mocap_framerate.npy", testing::npyDoubles({1}, {20})}}) {
    files.emplace_back(name, std::string(bytes.begin(), bytes.end()));
  }
  const Bytes archive = testing::storedZip(files);
  return {archive.begin(), archive.end()};
}

// SMPL's names of bones as VRM has them, which a VRMA knows alone.
std::string boneName(const std::string& joint) {
  static const std::map<std::string, std::string> kNames = {{"pelvis", "hips"},
                                                            {"left_hip", "leftUpperLeg"},
                                                            {"right_hip", "rightUpperLeg"},
                                                            {"left_knee", "leftLowerLeg"},
                                                            {"right_knee", "rightLowerLeg"},
                                                            {"left_ankle", "leftFoot"},
                                                            {"right_ankle", "rightFoot"},
                                                            {"left_shoulder", "leftUpperArm"},
                                                            {"right_shoulder", "rightUpperArm"},
                                                            {"left_elbow", "leftLowerArm"},
                                                            {"right_elbow", "rightLowerArm"},
                                                            {"left_wrist", "leftHand"},
                                                            {"right_wrist", "rightHand"}};
  const auto found = kNames.find(joint);
  return found == kNames.end() ? joint : found->second;
}

std::map<std::string, Vec3> jointsAt(const Motion& motion, double seconds) {
  std::map<std::string, Vec3> points;
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips.at(0), seconds, pose);
  const std::vector<Vec3> positions = posePositions(motion.skeleton, pose);
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j)
    points[boneName(motion.skeleton.joints[j].name)] = positions[j];
  return points;
}

// How far `b` is from `a` at the worst of the moments, as a part of the size; HUGE_VAL where fewer than `least` joints
// are in both.
double jointsMoved(const Motion& a, const Motion& b, std::size_t least) {
  double moved = 0;
  Box box;
  for (int moment = 0; moment < kMoments; ++moment) {
    const double seconds = a.clips.at(0).duration() * moment / (kMoments - 1);
    const std::map<std::string, Vec3> before = jointsAt(a, seconds), after = jointsAt(b, seconds);
    std::size_t common = 0;
    for (const auto& [name, position] : before) {
      box.add(position);
      const auto found = after.find(name);
      if (found == after.end()) continue;
      ++common;
      moved = std::max(moved, (found->second - position).norm());
    }
    if (common < least) return HUGE_VAL;
  }
  return moved / box.diagonal();
}

double surfaceMoved(const Asset& a, const Asset& b) {
  const testing::GltfPlayer before(a), after(b);
  const double end = before.keys(0).back();
  double moved = 0;
  Box box;
  for (int moment = 0; moment < kMoments; ++moment) {
    const double seconds = end * moment / (kMoments - 1);
    const std::vector<Vec3> p = before.vertices(0, seconds), q = after.vertices(0, seconds);
    if (p.size() != q.size()) return HUGE_VAL;
    for (std::size_t v = 0; v < p.size(); ++v) {
      box.add(p[v]);
      moved = std::max(moved, (p[v] - q[v]).norm());
    }
  }
  return moved / box.diagonal();
}

class CliRoundTrip : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    const Bytes model = writeGlb(walker());
    put("walker.glb", std::string(model.begin(), model.end()));
    for (const char* file : {"from.glb", "from.gltf", "from.fbx", "from.vrm", "from.bvh", "from.vrma"}) {
      const Result done = run({"convert", "walker.glb", file, "-q"});
      ASSERT_EQ(done.code, 0) << done.error;
    }
    put("from.npz", smplArrays());
    put("from.dae", collada());
  }
  Motion motion(const std::string& file) const { return readMotion(folder_ / file); }
};

// The lists of formats that can be read, and written.
const std::vector<std::string> kSources = {".glb", ".gltf", ".fbx", ".vrm", ".bvh", ".vrma", ".npz", ".dae"};
const std::vector<std::string> kTargets = {".glb", ".gltf", ".fbx", ".vrm", ".bvh", ".vrma"};

const std::vector<std::string> kModels = {".glb", ".gltf", ".fbx", ".vrm"};  // that hold a surface, too

bool isModel(const std::string& format) {
  return std::find(kModels.begin(), kModels.end(), format) != kModels.end();
}
bool holdsPeopleAlone(const std::string& format) {
  return format == ".vrm" || format == ".vrma";
}

TEST_F(CliRoundTrip, EveryPairOfFormatsKeepsTheMotion) {
  for (const std::string& source : kSources) {
    const Motion before = motion("from" + source);
    for (const std::string& target : kTargets) {
      const std::string file = "from_" + source.substr(1) + target;
      const Result done = run({"convert", "from" + source, file});
      if ((source == ".dae" && target == ".vrma") || (!isModel(source) && target == ".vrm")) {
        EXPECT_EQ(done.code, 1) << source << " to " << target;  // two arms are no person, and an avatar has a surface
        EXPECT_FALSE(fs::exists(folder_ / file)) << source << " to " << target;
        continue;
      }
      ASSERT_EQ(done.code, 0) << source << " to " << target << ": " << done.error;
      const Motion after = motion(file);
      ASSERT_EQ(after.clips.size(), 1u) << source << " to " << target;
      EXPECT_NEAR(after.clips[0].duration(), before.clips[0].duration(), 1e-3) << source << " to " << target;
      const std::size_t least = source == ".dae" ? 3 : holdsPeopleAlone(target) || source == ".vrma" ? 13 : 20;
      EXPECT_LT(jointsMoved(before, after, least), kTolerance) << source << " to " << target << ": " << done.error;
    }
  }
}

TEST_F(CliRoundTrip, EveryPairOfFormatsKeepsTheSurfaceThatMoves) {
  for (const std::string& source : kModels) {
    const Asset before = readAsset(folder_ / ("from" + source));
    for (const std::string& target : kModels) {
      ASSERT_EQ(run({"convert", "from" + source, "to" + target, "-q"}).code, 0) << source << " to " << target;
      EXPECT_LT(surfaceMoved(before, readAsset(folder_ / ("to" + target))), kTolerance) << source << " to " << target;
    }
  }
}

// What a USD holds is read by three.js and tinyusdz in tests/three_surfaces.mjs.
TEST_F(CliRoundTrip, EveryModelBecomesAUsdWithTheClip) {
  for (const std::string& source : kModels) {
    const Result done = run({"convert", "from" + source, "to.usda"});
    ASSERT_EQ(done.code, 0) << source << ": " << done.error;
    EXPECT_THAT(content("to.usda"), ::testing::HasSubstr("rotations.timeSamples")) << source;
  }
}

// The measure notices a joint that is displaced by a thousandth of the size, and a clip that is late.
TEST_F(CliRoundTrip, AMotionThatIsSpoiledIsNotTheSame) {
  const Motion before = motion("from.bvh");
  Motion moved = before;
  moved.skeleton.joints.back().rest.translation.x() += 2e-3;
  EXPECT_GT(jointsMoved(before, moved, 20), kTolerance);
  Motion late = before;
  late.clips[0] = trimClip(late.clips[0], 0.05, 1);
  EXPECT_GT(jointsMoved(before, late, 20), kTolerance);
}

}  // namespace
}  // namespace limber
