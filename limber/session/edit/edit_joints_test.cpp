#include "limber/session/edit/edit_joints.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/document/read.h"
#include "limber/document/rig/pose_io.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {
namespace {

std::optional<Bytes> editedFile(std::string_view path) {
  if (path == "walk.bvh") return testing::walkBvh();
  return path == "biped.glb" ? testing::bipedGlb() : testing::namedPersonGlb();
}

void edit(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Session editing(const char* file = "person.glb") {
  Session session(editedFile);
  edit(session, OpenFile{file});
  return session;
}

std::vector<Joint> jointsOf(const Session& session) {
  return session.state().rig->skeleton().joints;
}

Vec3 positionOf(const Session& session, const std::string& joint) {
  const SessionState& state = session.state();
  return posePositions(state.rig->skeleton(), state.pose)[*state.rig->skeleton().find(joint)];
}

// The largest distance between two surfaces.
double apart(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double most = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) most = std::max(most, double{(a[v] - b[v]).norm()});
  return most;
}

std::vector<Vec3f> surfaceOf(const Session& session) {
  return posedPositions(*session.state().rig, session.state().pose);
}

// What the file holds is what the session shows.
void expectWrittenAsShown(const Session& session) {
  const Asset written = readAsset(session.exportModel(ExportFormat::kGlb), "written.glb");
  checkAsset(written);
  const std::shared_ptr<const RiggedModel> model = openRiggedModel(written);
  const RiggedModel& shown = *session.state().rig;
  ASSERT_EQ(model->skeleton().jointCount(), shown.skeleton().jointCount());
  for (Index j = 0; j < shown.skeleton().jointCount(); ++j) {
    EXPECT_EQ(model->skeleton().joints[j].name, shown.skeleton().joints[j].name);
    EXPECT_EQ(model->skeleton().joints[j].parent, shown.skeleton().joints[j].parent);
  }
  EXPECT_LT(apart(posedPositions(*model, readNodePose(model->asset(), model->binding())), surfaceOf(session)), 1e-4);
}

TEST(EditJoints, EachJointCanBeDeletedInTurn) {
  for (const char* file : {"person.glb", "biped.glb"}) {
    const Session opened = editing(file);
    const std::vector<Vec3f> rest = opened.state().rig->geometry().positions;
    for (const Joint& joint : jointsOf(opened)) {
      Session session = opened.fork();
      if (!joint.parent) {
        EXPECT_THROW(edit(session, DeleteJoint{joint.name}), Error);
        continue;
      }
      edit(session, DeleteJoint{joint.name});
      EXPECT_EQ(jointsOf(session).size() + 1, jointsOf(opened).size());
      EXPECT_FALSE(session.state().rig->skeleton().find(joint.name));
      for (const Joint& left : jointsOf(session)) {
        EXPECT_LT((positionOf(session, left.name) - positionOf(opened, left.name)).norm(), 1e-5) << left.name;
      }
      EXPECT_LT(apart(surfaceOf(session), rest), 1e-5) << joint.name;
      for (Index v = 0; v < rest.size(); ++v) {
        float sum = 0;
        for (const float weight : session.state().rig->weights.weightsOf(v)) sum += weight;
        ASSERT_NEAR(sum, 1, 1e-5);
      }
      expectWrittenAsShown(session);
      edit(session, Undo{});
      EXPECT_EQ(session.state().rig, opened.state().rig);
    }
  }
}

TEST(EditJoints, ADeletedJointsSurfaceFollowsTheJointAbove) {
  Session session = editing();
  edit(session, DeleteJoint{"leftLowerArm"});
  const RiggedModel& rig = *session.state().rig;
  const Index hand = *rig.skeleton().find("leftHand"), upper = *rig.skeleton().find("leftUpperArm");
  EXPECT_EQ(rig.skeleton().joints[hand].parent, upper);
  EXPECT_TRUE(rig.edited);
}

TEST(EditJoints, ANewJointStandsWhereItIsToldAndMovesNothing) {
  Session session = editing();
  edit(session, testing::turnedBy("leftUpperArm", Vec3::UnitZ(), 40));
  const std::vector<Vec3f> before = surfaceOf(session);
  const Vec3 position = positionOf(session, "leftHand") + Vec3(0.1, 0.05, 0);
  edit(session, AddJoint{"leftHand", position, "thumb"});
  EXPECT_LT((positionOf(session, "thumb") - position).norm(), 1e-6);
  EXPECT_LT(apart(surfaceOf(session), before), 1e-5);
  expectWrittenAsShown(session);
  edit(session, testing::turnedBy("thumb", Vec3::UnitZ(), 60));
  EXPECT_LT(apart(surfaceOf(session), before), 1e-5);
  edit(session, AddJoint{"thumb", position + Vec3(0.1, 0, 0), ""});
  EXPECT_TRUE(session.state().rig->skeleton().find("joint_1"));
  EXPECT_THROW(edit(session, AddJoint{"thumb", position, "hips"}), Error);
  EXPECT_THROW(edit(session, AddJoint{"tail", position, "tip"}), Error);

  PaintWeights paint;
  paint.joint = "thumb";
  paint.radius = 0.5;
  paint.strength = 1;
  paint.dabs = {{0, 0.3, 0.3}};
  edit(session, paint);
  edit(session, testing::movedBy("thumb", {0.2, 0, 0}));
  EXPECT_GT(apart(surfaceOf(session), before), 0.05) << "once it has weights";
  expectWrittenAsShown(session);
}

TEST(EditJoints, AJointHungElsewhereStaysInPlaceAndFollowsItsNewParent) {
  Session session = editing();
  edit(session, testing::turnedBy("chest", Vec3::UnitX(), 25));
  edit(session, testing::turnedBy("leftUpperArm", Vec3::UnitZ(), 40));
  edit(session, LockWeights{"leftHand", true});
  edit(session, SetTarget{"rightHand", positionOf(session, "rightHand")});
  const std::vector<Vec3f> before = surfaceOf(session);
  const Vec3 hand = positionOf(session, "leftHand");
  EXPECT_THROW(edit(session, ReparentJoint{"leftUpperArm", "leftHand"}), Error);
  EXPECT_THROW(edit(session, ReparentJoint{"leftUpperArm", "leftUpperArm"}), Error);
  edit(session, ReparentJoint{"leftUpperArm", "hips"});
  EXPECT_LT((positionOf(session, "leftHand") - hand).norm(), 1e-6);
  EXPECT_LT(apart(surfaceOf(session), before), 1e-5);
  EXPECT_EQ(session.state().targets.size(), 1u);
  EXPECT_EQ(jointsOf(session)[session.state().targets[0].joint].name, "rightHand");
  EXPECT_TRUE(session.state().locked.count("leftHand"));
  expectWrittenAsShown(session);
  edit(session, testing::turnedBy("chest", Vec3::UnitX(), 25));
  EXPECT_LT((positionOf(session, "leftHand") - hand).norm(), 1e-6) << "the chest does not move it any more";
}

TEST(EditJoints, ClipsMoveWhatIsLeftAsBefore) {
  const Session opened = [] {
    Session session = editing();
    edit(session, AddMotion{"walk.bvh"});
    edit(session, RetargetMotion{"walk", "", "aligned", "", 0, true});
    return session;
  }();
  for (const Command& command : {Command(ReparentJoint{"leftUpperArm", "hips"}), Command(DeleteJoint{"neck"}),
                                 Command(AddJoint{"head", {0, 1.9, 0}, "hat"})}) {
    Session was = opened.fork(), is = opened.fork();
    edit(is, command);
    ASSERT_EQ(is.state().movement.clips.size(), 1u);
    const Clip& clip = *is.state().movement.clips[0].clip;
    checkClip(clip, is.state().rig->skeleton());
    const std::vector<double> keys = keyTimes(clip);
    for (std::size_t k = 0; k < keys.size(); k += 5) {
      edit(was, SetTime{keys[k]});
      edit(is, SetTime{keys[k]});
      for (const Joint& joint : jointsOf(is)) {
        if (!was.state().rig->skeleton().find(joint.name)) continue;
        EXPECT_LT((positionOf(is, joint.name) - positionOf(was, joint.name)).norm(), 1e-4) << joint.name;
      }
    }
    expectWrittenAsShown(is);
    const Asset written = readAsset(is.exportModel(ExportFormat::kGlb), "written.glb");
    EXPECT_EQ(openRiggedModel(written)->clips.size(), 1u);
  }
}

TEST(EditJoints, ARecordGivesTheSameBytesAndAKeptSessionTheSameRig) {
  Session session = editing("biped.glb");
  const std::vector<Joint> joints = jointsOf(session);
  const std::string last = joints.back().name;
  edit(session, AddJoint{last, positionOf(session, last) + Vec3(0, 0.1, 0), "tip"});
  edit(session, DeleteJoint{joints[joints.size() - 2].name});
  edit(session, ReparentJoint{"tip", joints[0].name});
  Session again(editedFile);
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) edit(again, command);
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));
  Session restored;
  Progress progress;
  restored.open(session.saveSession(), "kept.glb", progress);
  EXPECT_EQ(jointsOf(restored).size(), jointsOf(session).size());
  EXPECT_LT(apart(surfaceOf(restored), surfaceOf(session)), 1e-5);
}

TEST(EditJoints, LimitsStayWithTheirJoints) {
  Session session = editing();
  edit(session, SetLimits{R"({"limber_limits": 1, "joints": {"leftLowerArm": {"type": "hinge", "x": [0, 135]}}})"});
  edit(session, ReparentJoint{"leftUpperArm", "hips"});
  edit(session, DeleteJoint{"neck"});
  ASSERT_TRUE(session.state().limits);
  const Index arm = *session.state().rig->skeleton().find("leftLowerArm");
  EXPECT_TRUE(std::holds_alternative<Hinge>(session.state().limits->joints[arm].motion));
  edit(session, DeleteJoint{"leftLowerArm"});
  ASSERT_TRUE(session.state().limits);
}

}  // namespace
}  // namespace limber
