#include "limber/actions/pose/pose_tasks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/pose/pose_edits.h"
#include "limber/actions/rig/body_masses.h"
#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

std::string refusalOf(std::string_view text) {
  try {
    parseTask(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing refused";
}

TEST(PoseTasks, EveryFormOfTextIsRead) {
  TaskEdit task = parseTask("position:mixamorig:LeftHand=0.1,-2,3e-1");
  EXPECT_EQ(task.kind, TaskKind::kPosition);
  EXPECT_EQ(task.joint, "mixamorig:LeftHand");
  EXPECT_EQ(task.point, Vec3(0.1, -2, 0.3));
  EXPECT_EQ(task.weight, 1);
  EXPECT_EQ(task.priority, 0);
  task = parseTask("look-at:head=0,1.6,2@weight=2.5,priority=3");
  EXPECT_EQ(task.kind, TaskKind::kLookAt);
  EXPECT_EQ(task.weight, 2.5);
  EXPECT_EQ(task.priority, 3);
  task = parseTask("orientation:hand@home=x:90,y:90@priority=1");
  EXPECT_EQ(task.joint, "hand@home");
  EXPECT_LT((task.turn * Vec3(Vec3::UnitY()) - Vec3(1, 0, 0)).norm(), 1e-12);  // y to z, z to x
  task = parseTask("distance:leftHand=a:b:0.2");
  EXPECT_EQ(task.other, "a:b");
  EXPECT_EQ(task.amount, 0.2);
  task = parseTask("distance:leftHand=1,2,3:0.2");
  EXPECT_EQ(task.other, "");
  EXPECT_EQ(task.point, Vec3(1, 2, 3));
  task = parseTask("plane:foot=on:0,1,0,0.1");
  EXPECT_TRUE(task.exact);
  EXPECT_EQ(task.amount, 0.1);
  EXPECT_FALSE(parseTask("plane:foot=above:0,1,0,0.1").exact);
  task = parseTask("balance:l+r=centred");
  EXPECT_EQ(task.supports, (std::vector<std::string>{"l", "r"}));
  EXPECT_TRUE(task.exact);
  EXPECT_TRUE(parseTask("balance=within").supports.empty());
  task = parseTask("keep-out:hand=sphere:1,2,3,0.5");
  EXPECT_EQ(task.point, task.end);
  EXPECT_EQ(task.amount, 0.5);
  task = parseTask("keep-out:hand=capsule:1,2,3,4,5,6,0.5");
  EXPECT_EQ(task.end, Vec3(4, 5, 6));
  task = parseTask("coupling:neck=head:-0.5");
  EXPECT_EQ(task.other, "head");
  EXPECT_EQ(task.amount, -0.5);
}

TEST(PoseTasks, BadTextsAreRefusedWithWhatIsAccepted) {
  EXPECT_THAT(refusalOf("stare:head=1,2,3"), HasSubstr("'stare:head=1,2,3': no kind of task is called 'stare'"));
  EXPECT_THAT(refusalOf("stare:head=1,2,3"), HasSubstr("look-at, distance"));
  EXPECT_THAT(refusalOf("look-at:head"), HasSubstr("has no value (write look-at:JOINT=x,y,z"));
  EXPECT_THAT(refusalOf("look-at:head=1,2"), HasSubstr("has no point"));
  EXPECT_THAT(refusalOf("look-at=1,2,3"), HasSubstr("names no joint"));
  EXPECT_THAT(refusalOf("orientation:head=w:3"), HasSubstr("has no turn"));
  EXPECT_THAT(refusalOf("distance:head=neck"), HasSubstr("has no distance"));
  EXPECT_THAT(refusalOf("distance:head=:1"), HasSubstr("says no joint"));
  EXPECT_THAT(refusalOf("plane:foot=under:0,1,0,0"), HasSubstr("has no plane"));
  EXPECT_THAT(refusalOf("balance=somehow"), HasSubstr("neither within nor centred"));
  EXPECT_THAT(refusalOf("keep-out:hand=sphere:1,2,3"), HasSubstr("has no sphere or capsule"));
  EXPECT_THAT(refusalOf("keep-out:hand=box:1,2,3,4"), HasSubstr("has no sphere or capsule"));
  EXPECT_THAT(refusalOf("coupling:neck=head"), HasSubstr("has no ratio"));
  EXPECT_THAT(refusalOf("look-at:head=1,2,3@weight=0"), HasSubstr("weight that is not above 0"));
  EXPECT_THAT(refusalOf("look-at:head=1,2,3@priority=0.5"), HasSubstr("priority that cannot be"));
  EXPECT_THAT(refusalOf("look-at:head=1,2,3@weight=1,wait=2"), HasSubstr("something else"));
  EXPECT_THAT(refusalOf(""), HasSubstr("no kind of task is called ''"));
}

TEST(PoseTasks, NumbersAndJointsThatCannotBeAreRefusedAtTheirTask) {
  const Skeleton humanoid = practiceHumanoid();
  for (const char* text :
       {"position:nobody=1,2,3", "distance:head=head:1", "distance:head=neck:-1", "plane:head=on:0,0,0,1",
        "keep-out:head=sphere:0,0,0,0", "coupling:neck=neck:1", "balance:nobody=within"}) {
    try {
      resolveTasks(humanoid, {parseTask(text)});
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "'" + std::string(text) + "'");
    }
  }
}

// The same tasks, out of a file.
TEST(PoseTasks, FilesSayWhatTextsSay) {
  const char* json = R"({"poses": [{"name": "p", "tasks": [
    {"kind": "position", "joint": "leftHand", "target": [0.4, 1.2, 0.3], "weight": 2, "priority": 1},
    {"kind": "orientation", "joint": "head", "axis": [0, 2, 0], "degrees": 30},
    {"kind": "look-at", "joint": "head", "target": [0, 1.6, 2], "axis": [0, 0, 3]},
    {"kind": "distance", "joint": "leftHand", "from": "rightHand", "distance": 0.2},
    {"kind": "distance", "joint": "leftHand", "from": [1, 2, 3], "distance": 0.2},
    {"kind": "plane", "joint": "leftFoot", "normal": [0, 1, 0], "offset": 0.1, "side": "on"},
    {"kind": "balance", "over": "centred"},
    {"kind": "keep-out", "joint": "leftHand", "from": [0, 1, 0], "radius": 0.3},
    {"kind": "keep-out", "joint": "leftHand", "from": [0, 1, 0], "to": [0, 2, 0], "radius": 0.3},
    {"kind": "coupling", "joint": "neck", "leader": "head", "ratio": 0.5}]}]})";
  const std::vector<TaskEdit> tasks = parsePoses(json, "p.json")[0].edits.tasks;
  const char* texts[] = {"position:leftHand=0.4,1.2,0.3@weight=2,priority=1",
                         "orientation:head=y:30",
                         "look-at:head=0,1.6,2",
                         "distance:leftHand=rightHand:0.2",
                         "distance:leftHand=1,2,3:0.2",
                         "plane:leftFoot=on:0,1,0,0.1",
                         "balance=centred",
                         "keep-out:leftHand=sphere:0,1,0,0.3",
                         "keep-out:leftHand=capsule:0,1,0,0,2,0,0.3",
                         "coupling:neck=head:0.5"};
  ASSERT_EQ(tasks.size(), std::size(texts));
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const TaskEdit text = parseTask(texts[t]);
    EXPECT_EQ(tasks[t].kind, text.kind);
    EXPECT_EQ(tasks[t].joint, text.joint);
    EXPECT_EQ(tasks[t].other, text.other);
    EXPECT_EQ(tasks[t].point, text.point);
    EXPECT_EQ(tasks[t].end, text.end);
    EXPECT_EQ(tasks[t].amount, text.amount);
    EXPECT_EQ(tasks[t].exact, text.exact);
    EXPECT_EQ(tasks[t].weight, text.weight);
    EXPECT_EQ(tasks[t].priority, text.priority);
    EXPECT_LT((tasks[t].turn.coeffs() - text.turn.coeffs()).norm(), 1e-12);
  }
  EXPECT_EQ(tasks[3].where, "p.json: poses[0].tasks[3]");
  EXPECT_EQ(resolveTasks(practiceHumanoid(), tasks).size(), tasks.size());
}

TEST(PoseTasks, BadEntriesOfFilesAreRefusedWithTheirPlace) {
  const auto refusal = [](const std::string& task) {
    try {
      parsePoses(R"({"poses": [{"name": "p", "tasks": [)" + task + "]}]}", "p.json");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing refused");
  };
  EXPECT_THAT(refusal("7"), HasSubstr("p.json: poses[0].tasks[0]"));
  EXPECT_THAT(refusal(R"({"joint": "head"})"), HasSubstr("has no \"kind\""));
  EXPECT_THAT(refusal(R"({"kind": "stare", "joint": "head"})"),
              HasSubstr("tasks[0].kind: no kind of task is called 'stare'"));
  EXPECT_THAT(refusal(R"({"kind": "look-at", "joint": "head"})"), HasSubstr("has no \"target\""));
  EXPECT_THAT(refusal(R"({"kind": "position", "joint": "head", "target": [1, 2, 3], "radius": 1})"),
              HasSubstr("tasks[0].radius: is not part of a pose"));
  EXPECT_THAT(refusal(R"({"kind": "plane", "joint": "a", "normal": [0, 1, 0], "offset": 0, "side": "in"})"),
              HasSubstr("neither \"above\" nor \"on\""));
  EXPECT_THAT(refusal(R"({"kind": "balance", "supports": [1]})"), HasSubstr("supports[0]: is not the name of a joint"));
  EXPECT_THAT(refusal(R"({"kind": "balance", "weight": 0})"), HasSubstr("weight: is not above 0"));
  EXPECT_THAT(refusal(R"({"kind": "balance", "priority": -1})"), HasSubstr("priority"));
}

// Joints with names of their own are found by the bones that they play; a head looks to the body's front.
TEST(PoseTasks, BonesOfVrmAreFoundUnderOtherNames) {
  Skeleton other = practiceHumanoid();
  const Index head = other.find("head").value(), hand = other.find("leftHand").value();
  for (Index j = 0; j < other.jointCount(); ++j) other.joints[j].name = "joint " + std::to_string(j);
  Pose pose = restPose(other);
  const IkTaskResult result =
      applyTasks(other, pose, {parseTask("look-at:head=2,1.6,2"), parseTask("position:leftHand=0.4,1.2,0.3")});
  EXPECT_TRUE(result.met());
  const std::vector<Affine> globals = poseGlobals(other, pose), rest = poseGlobals(other, restPose(other));
  const Vec3 look = globals[head].linear() * rest[head].linear().inverse() * Vec3::UnitZ();
  EXPECT_LT((look - (Vec3(2, 1.6, 2) - globals[head].translation()).normalized()).norm(), 2e-3);
  EXPECT_LT((globals[hand].translation() - Vec3(0.4, 1.2, 0.3)).norm(), 1e-3);
}

TEST(PoseTasks, OutcomesAreSaid) {
  EXPECT_EQ(taskOutcome({0, false, true}), "met");
  EXPECT_EQ(taskOutcome({0.25, false, false, IkTaskObstacle::kOtherTasks}),
            "not met, 0.2500 m left: other tasks are in the way");
  EXPECT_EQ(taskOutcome({10 * kDegree, true, false, IkTaskObstacle::kLimits}),
            "not met, 10.00 degrees left: the joints' limits are in the way");
}

// Two icosahedra, stretched, on two joints.
TEST(BodyMasses, ClosedPartsWeighTheirVolumeAtTheirMiddle) {
  Skeleton skeleton;
  skeleton.joints.resize(2);
  skeleton.joints[0].name = "a";
  skeleton.joints[1].name = "b";
  skeleton.joints[1].parent = 0;
  skeleton.joints[1].rest.translation = Vec3(3, 0, 0);
  skeleton.joints[1].rest.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  Geometry geometry;
  SkinWeights weights;
  weights.slots = 1;
  for (Index j = 0; j < 2; ++j) {
    const auto first = static_cast<Index>(geometry.positions.size());
    const TriMesh part = j == 0 ? testing::moved(testing::icosphere(0), Vec3f(1, 2, 3), Vec3f(0.5f, 1, 1.5f))
                                : testing::moved(testing::icosphere(0), Vec3f(1, 1, 1), Vec3f(3.5f, 1.5f, 0.5f));
    for (const Vec3f& p : part.positions) {
      geometry.positions.push_back(p);
      weights.joints.push_back(j);
      weights.weights.push_back(1);
    }
    for (Triangle t : part.triangles) {
      for (Index& corner : t) corner += first;
      geometry.triangles.push_back(t);
    }
  }
  const std::vector<PointMass> masses = bodyMasses(geometry, weights, skeleton);
  ASSERT_EQ(masses.size(), 2u);
  constexpr double kIcosahedron = 2.5361507;  // volume, radius 1
  EXPECT_NEAR(masses[0].mass, 6 * kIcosahedron, 1e-5);
  EXPECT_LT((masses[0].offset - Vec3(0.5, 1, 1.5)).norm(), 1e-6);
  EXPECT_NEAR(masses[1].mass, kIcosahedron, 1e-5);
  EXPECT_LT((masses[1].offset - Vec3(1.5, -0.5, 0.5)).norm(), 1e-6);
}

}  // namespace
}  // namespace limber
