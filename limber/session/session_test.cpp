#include "limber/session/session.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/document/write.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

std::optional<Bytes> files(std::string_view path) {
  return path == "biped.glb" ? std::optional<Bytes>(testing::bipedGlb()) : std::nullopt;
}

Session opened(Index handles = 20) {
  Session session(files);
  Progress progress;
  session.run(OpenFile{"biped.glb"}, progress);
  session.run(SetHandles{handles}, progress);
  return session;
}

void run(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

const Vec3 kForward(0, 0, -1), kCamera(0, 1, 10);

Vec3 jointAt(const Session& session, Index joint) {
  return poseGlobals(session.state().rig->skeleton(), session.state().pose)[joint].translation();
}

// The last joint: it hangs far out.
Index lastJoint(const Session& session) {
  return session.state().rig->skeleton().jointCount() - 1;
}

void drag(Session& session, Index joint, DragMode mode, const Vec3& displacement) {
  const Vec3 from = jointAt(session, joint);
  run(session,
      BeginDrag{session.state().rig->skeleton().joints[joint].name, mode, {kCamera, from - kCamera}, kForward});
  for (const double part : {0.3, 0.8, 1.0})
    run(session, UpdateDrag{{kCamera, from + part * displacement - kCamera}, kForward});
  run(session, EndDrag{});
}

TEST(Session, NothingCanBeDoneBeforeAModelIsOpen) {
  Session session;
  EXPECT_FALSE(session.isOpen());
  EXPECT_THROW(run(session, SetHandles{5}), Error);
  EXPECT_THROW(run(session, Undo{}), Error);
  EXPECT_THROW(run(session, UpdateDrag{}), Error);
  EXPECT_THROW(session.pick({}, 0), Error);
  EXPECT_THROW(session.exportModel(ExportFormat::kGlb), Error);
  EXPECT_THROW(run(session, OpenFile{"no.glb"}), Error);
  EXPECT_FALSE(session.isOpen());
}

TEST(Session, OpensASample) {
  Session session;
  run(session, OpenSample{"stool"});
  EXPECT_EQ(session.source().name, "stool");
  EXPECT_FALSE(session.state().rig->report->suggestions.empty());
}

TEST(Session, ADragIsOneStepThatCanBeUndoneAndDoneAgain) {
  Session session = opened();
  const Pose before = session.state().pose;
  const Index joint = lastJoint(session);
  const Vec3 from = jointAt(session, joint), displacement(0.2, -0.1, 0);
  drag(session, joint, DragMode::kMove, displacement);
  EXPECT_LT((jointAt(session, joint) - from - displacement).norm(), 1e-9);
  const Pose after = session.state().pose;
  EXPECT_EQ(session.undoName(), "end_drag");
  run(session, Undo{});
  EXPECT_TRUE(samePose(session.state().pose, before));
  EXPECT_EQ(session.redoName(), "end_drag");
  run(session, Redo{});
  EXPECT_TRUE(samePose(session.state().pose, after));
  EXPECT_FALSE(session.canRedo());
}

TEST(Session, ACancelledDragNeverHappened) {
  Session session = opened();
  const Pose before = session.state().pose;
  const std::size_t recorded = session.record().size();
  const std::string_view undo = session.undoName();
  run(session,
      BeginDrag{session.state().rig->skeleton().joints[3].name, DragMode::kMove, {kCamera, kForward}, kForward});
  EXPECT_EQ(session.draggedJoint(), Index{3});
  EXPECT_THROW(run(session, Undo{}), Error);
  EXPECT_THROW(run(session, SetHandles{8}), Error);
  run(session, UpdateDrag{{kCamera, kForward + Vec3(0.1, 0, 0)}, kForward});
  EXPECT_FALSE(samePose(session.state().pose, before));
  run(session, CancelDrag{});
  EXPECT_TRUE(samePose(session.state().pose, before));
  EXPECT_EQ(session.record().size(), recorded);
  EXPECT_EQ(session.undoName(), undo);
}

TEST(Session, AnotherNumberOfHandlesKeepsThePoseAndComesBackExactly) {
  Session session = opened();
  const std::vector<Affine> rest = restGlobals(session.state().rig->skeleton());
  const auto hand = std::max_element(rest.begin(), rest.end(), [](const Affine& a, const Affine& b) {
    return a.translation().x() < b.translation().x();
  });
  drag(session, static_cast<Index>(hand - rest.begin()), DragMode::kTurn, {0.1, 0.3, 0});
  const Pose posed = session.state().pose;
  const std::vector<Vec3f> surface = posedPositions(*session.state().rig, posed);
  run(session, SetHandles{50});
  const SessionState& many = session.state();
  EXPECT_NEAR(many.rig->skeleton().jointCount(), 50, 1);
  const std::vector<Vec3f> now = posedPositions(*many.rig, many.pose);
  double moved = 0, left = 0;
  for (std::size_t v = 0; v < surface.size(); ++v) {
    moved += (surface[v] - many.rig->geometry().positions[v]).norm();
    left += (surface[v] - now[v]).norm();
  }
  EXPECT_LT(left, 0.4 * moved);
  run(session, SetHandles{7});
  run(session, SetHandles{20});
  EXPECT_TRUE(samePose(session.state().pose, posed));
  // The three changes of the number are one step, as a slider that is pulled about.
  run(session, Undo{});
  EXPECT_TRUE(samePose(session.state().pose, posed));
  EXPECT_EQ(session.undoName(), "end_drag");
}

TEST(Session, FailuresAndCancellationLeaveEverythingAsItWas) {
  Session session = opened();
  drag(session, lastJoint(session), DragMode::kMove, {0.1, 0, 0});
  const Bytes before = session.exportModel(ExportFormat::kGlb);
  const std::string record = commandsToJson(session.record());
  const std::string state = sessionState(session).dump();
  for (const Command& bad : std::vector<Command>{
           SetHandles{0}, SetHandles{1000000}, ChooseMethods{"magic", "bone-heat"}, OpenSample{"unicorn"},
           ResetJoint{"no such joint"}, testing::turnedBy("no such joint", Vec3::UnitX(), 10), SetLimits{"{"},
           BeginDrag{
               session.state().rig->skeleton().joints[1].name, DragMode::kMove, {kCamera, Vec3::Zero()}, kForward}}) {
    EXPECT_THROW(run(session, bad), Error) << commandName(bad);
  }
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(session.run(SetHandles{9}, cancelled), Error);
  Progress progress;
  EXPECT_THROW(session.open(asBytes("glTF not really"), "bad.glb", progress), Error);
  EXPECT_EQ(session.exportModel(ExportFormat::kGlb), before);
  EXPECT_EQ(commandsToJson(session.record()), record);
  EXPECT_EQ(sessionState(session).dump(), state);
}

TEST(Session, IkPullsTheLimbAndTargetsHold) {
  Session session = opened(30);
  const Skeleton& skeleton = session.state().rig->skeleton();
  Index hand = kNoIndex;  // a joint with a limb of at least two joints, and that far from its end
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> base = limbBase(skeleton, j);
    if (base && *base != *skeleton.joints[j].parent) hand = j;
  }
  ASSERT_NE(hand, kNoIndex);
  run(session, SetIk{true});
  const Vec3 toBase = jointAt(session, *limbBase(skeleton, hand)) - jointAt(session, hand);
  Vec3 displacement = 0.2 * toBase + 0.2 * toBase.norm() * kForward.cross(toBase).normalized();
  displacement.z() = 0;
  const Vec3 goal = jointAt(session, hand) + displacement;
  drag(session, hand, DragMode::kMove, displacement);
  EXPECT_LT((jointAt(session, hand) - goal).norm(), 2e-3);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    EXPECT_EQ(session.state().pose.locals[j].translation, session.state().rig->home.locals[j].translation);
  }
  run(session, SetTarget{skeleton.joints[hand].name, goal});
  run(session, testing::movedBy(skeleton.joints[0].name, 0.1 * toBase));
  EXPECT_LT((jointAt(session, hand) - goal).norm(), 2e-3);
  run(session, ClearTarget{skeleton.joints[hand].name});
  EXPECT_TRUE(session.state().targets.empty());
}

TEST(Session, ResetPutsBackOneJointOrAll) {
  Session session = opened();
  const std::string name = session.state().rig->skeleton().joints[4].name;
  run(session, testing::turnedBy(name, Vec3::UnitX(), 40));
  const Pose turned = session.state().pose;
  run(session, testing::movedBy(name, {0.1, 0, 0}));
  run(session, testing::turnedBy(session.state().rig->skeleton().joints[2].name, Vec3::UnitY(), 20));
  run(session, ResetJoint{name});
  const Pose& home = session.state().rig->home;
  EXPECT_EQ(session.state().pose.locals[4].rotation.coeffs(), home.locals[4].rotation.coeffs());
  EXPECT_EQ(session.state().pose.locals[4].translation, home.locals[4].translation);
  EXPECT_FALSE(samePose(session.state().pose, home));
  run(session, ResetPose{});
  EXPECT_TRUE(samePose(session.state().pose, home));
  for (int i = 0; i < 4; ++i) run(session, Undo{});
  EXPECT_TRUE(samePose(session.state().pose, turned));
}

TEST(Session, MirrorSwapsTheSidesOfASymmetricModel) {
  Session session = opened();
  const Skeleton& skeleton = session.state().rig->skeleton();
  std::optional<Index> left;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].name.find(".L") != std::string::npos) left = j;
  }
  ASSERT_TRUE(left);
  std::string image = skeleton.joints[*left].name;
  image.back() = 'R';
  const Index right = skeleton.find(image).value();
  drag(session, *left, DragMode::kMove, {0.1, 0.25, 0});
  const Vec3 raised = jointAt(session, *left);
  run(session, MirrorPose{MirrorFrom::kBoth});
  EXPECT_LT((jointAt(session, right) - Vec3(-raised.x(), raised.y(), raised.z())).norm(), 1e-6);
  EXPECT_LT((jointAt(session, *left) - restGlobals(skeleton)[*left].translation()).norm(), 1e-6);
}

TEST(Session, LeftIsTheBodysOwn) {
  for (const bool facesBack : {false, true}) {
    Session session([&](std::string_view) { return testing::personGlb(facesBack); });
    run(session, OpenFile{"person.glb"});
    const Skeleton& skeleton = session.state().rig->skeleton();
    const Json joints = sessionState(session)["joints"];
    const Index hand = skeleton.find("leftHand").value(), otherHand = skeleton.find("rightHand").value();
    EXPECT_EQ(joints[hand]["part"], "left hand");
    EXPECT_EQ(joints[otherHand]["part"], "right hand");
    run(session, testing::turnedBy("leftUpperArm", Vec3(0, 0, 1), 40));
    const Vec3 raised = jointAt(session, hand);
    run(session, MirrorPose{MirrorFrom::kLeft});
    EXPECT_LT((jointAt(session, hand) - raised).norm(), 1e-6) << "it stays";
    EXPECT_LT((jointAt(session, otherHand) - Vec3(-raised.x(), raised.y(), raised.z())).norm(), 1e-6);
  }
}

// Something of everything. Returns how many commands it took.
std::size_t tellStory(Session& session) {
  std::size_t reported = 0;
  const auto tell = [&](const Command& command) {
    run(session, command);
    ++reported;
  };
  const auto joint = [&](std::size_t j) { return session.state().rig->skeleton().joints.at(j).name; };
  tell(OpenFile{"biped.glb"});
  tell(SetHandles{12});
  tell(SetHandles{24});
  tell(BeginDrag{joint(0), DragMode::kMove, {kCamera, kForward}, kForward});
  tell(UpdateDrag{{kCamera, Vec3(0.1, 0, -1)}, kForward});
  tell(UpdateDrag{{kCamera, Vec3(0.03, 0.02, -1)}, kForward});
  tell(EndDrag{});
  tell(testing::turnedBy(joint(3), Vec3(1, 1, 0), 35));
  tell(SetIk{true});
  tell(SetTarget{joint(12), Vec3(-0.3, 0.4, 0.2)});
  tell(testing::movedBy(joint(0), Vec3(0, 0.05, 0)));
  tell(Undo{});
  tell(Redo{});
  tell(BeginDrag{joint(8), DragMode::kTurn, {kCamera, kForward}, kForward});
  tell(CancelDrag{});
  tell(BeginDrag{joint(6), DragMode::kMove, {kCamera, kForward}, kForward});
  tell(MoveDrag{Vec3(0.1, 0, 0), Vec3(0, 0, 80)});
  tell(MoveDrag{Vec3(0.02, 0.05, -0.04), Vec3(10, 25, 0)});
  tell(EndDrag{});
  tell(SetHandles{30});
  tell(MirrorPose{MirrorFrom::kLeft});
  tell(ResetJoint{joint(5)});
  return reported;
}

TEST(Session, TheRecordReplayedGivesTheSameBytes) {
  Session session(files);
  const std::size_t reported = tellStory(session);
  const Bytes glb = session.exportModel(ExportFormat::kGlb);
  Session again(files);
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) run(again, command);
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), glb);
  EXPECT_EQ(again.saveSession(), session.saveSession());
  EXPECT_EQ(sessionState(again).dump(), sessionState(session).dump());
  EXPECT_LT(session.record().size(), reported);  // what never mattered is not in it
}

TEST(Session, ASavedSessionComesBackAsItWas) {
  Session session(files);
  tellStory(session);
  const std::string target = session.state().rig->skeleton().joints.at(9).name;
  run(session, SetTarget{target, Vec3(-0.3, 0.4, 0.2)});
  const Bytes file = session.saveSession();
  Session again;
  Progress progress;
  again.open(file, session.source().name, progress);
  EXPECT_EQ(again.saveSession(), file);
  EXPECT_TRUE(samePose(again.state().pose, session.state().pose));
  EXPECT_EQ(again.state().ik, true);
  ASSERT_EQ(again.state().targets.size(), 1u);
  EXPECT_EQ(again.state().targets[0].position, Vec3(-0.3, 0.4, 0.2));
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));
}

TEST(Session, AModelWithARigKeepsItUntilOthersAreAskedFor) {
  Session first = opened(9);
  run(first, testing::turnedBy(first.state().rig->skeleton().joints[2].name, Vec3::UnitZ(), 30));
  Session session;
  Progress progress;
  session.open(first.exportModel(ExportFormat::kGlb), "rigged.glb", progress);
  EXPECT_EQ(sessionState(session)["own_rig"], true);
  ASSERT_EQ(session.state().rig->skeleton().jointCount(), first.state().rig->skeleton().jointCount());
  for (Index j = 0; j < 9; ++j) EXPECT_LT((jointAt(session, j) - jointAt(first, j)).norm(), 1e-6);
  run(session, SetHandles{14});
  EXPECT_EQ(sessionState(session)["own_rig"], false);
  EXPECT_NEAR(session.state().rig->skeleton().jointCount(), 14, 1);
  run(session, Undo{});
  EXPECT_EQ(sessionState(session)["own_rig"], true);
}

Vec3 boundAt(const Session& session, const char* joint) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  return restGlobals(skeleton)[skeleton.find(joint).value()].translation();
}

TEST(Session, PinnedJointsOfATemplateStandWhereTheyArePinned) {
  Session session;
  run(session, OpenSample{"biped"});
  EXPECT_THROW(run(session, PinJoint{"leftHand", Vec3::Zero()}), Error) << "handles have no names";
  run(session, ChooseMethods{"template", "bone-heat"});
  const Vec3 found = boundAt(session, "leftLowerArm"), wanted = found + Vec3(0, -0.01, 0.015);
  EXPECT_THROW(run(session, PinJoint{"nobody", wanted}), Error);
  EXPECT_THROW(run(session, PinJoint{"leftLowerArm", Vec3(9, 9, 9)}), Error);
  EXPECT_TRUE(session.state().pins.empty());

  run(session, PinJoint{"leftLowerArm", found + Vec3(0, 0, -0.01)});
  run(session, PinJoint{"leftLowerArm", wanted});
  EXPECT_LT((boundAt(session, "leftLowerArm") - wanted).norm(), 1e-5);
  ASSERT_EQ(session.state().pins.size(), 1u) << "the second pin takes the place of the first";
  EXPECT_EQ(sessionState(session)["pins"][0]["joint"], "leftLowerArm");

  // Saved and opened, and done again from the record.
  Session again;
  Progress progress;
  again.open(session.saveSession(), "again.glb", progress);
  EXPECT_EQ(again.state().pins.size(), 1u);
  EXPECT_LT((boundAt(again, "leftLowerArm") - wanted).norm(), 1e-5);
  Session replayed;
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) run(replayed, command);
  EXPECT_EQ(replayed.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));

  run(session, UnpinJoint{"leftLowerArm"});
  EXPECT_LT((boundAt(session, "leftLowerArm") - found).norm(), 1e-5);
  EXPECT_THROW(run(session, UnpinJoint{"leftLowerArm"}), Error);
  run(session, Undo{});
  EXPECT_LT((boundAt(session, "leftLowerArm") - wanted).norm(), 1e-5);
}

TEST(Session, LimitsBendWhatIsTurned) {
  Session session = opened();
  const std::string name = session.state().rig->skeleton().joints[5].name;
  run(session, SetLimits{R"({"limber_limits": 1, "joints": {")" + name + R"(": {"type": "hinge", "x": [0, 30]}}})"});
  EXPECT_EQ(sessionState(session)["limited"], true);
  run(session, testing::turnedBy(name, Vec3::UnitX(), 80));
  const Quat turned = session.state().pose.locals[5].rotation;
  EXPECT_NEAR(turned.angularDistance(Quat(Eigen::AngleAxisd(30 * EIGEN_PI / 180, Vec3::UnitX()))), 0, 1e-9);
  run(session, SetLimits{});
  EXPECT_EQ(session.state().limits, nullptr);
}

TEST(Session, PickFindsHandlesBeforeTheSurface) {
  const Session session = opened();
  const Vec3 head = jointAt(session, 1);
  const auto handle = session.pick({kCamera, head - kCamera}, 0.01);
  ASSERT_TRUE(handle);
  EXPECT_TRUE(handle->onHandle);
  EXPECT_FALSE(session.pick({kCamera, Vec3(0, 1, 0.1)}, 0.01));
  EXPECT_THROW(session.pick({kCamera, Vec3::Zero()}, 0.01), Error);
}

TEST(Session, ExportsThePosedSurface) {
  Session session = opened(8);
  double before = 1e9;
  for (const Vec3f& position : session.state().rig->geometry().positions)
    before = std::min(before, double{position.y()});
  run(session, testing::movedBy(session.state().rig->skeleton().joints[0].name, {0, 2, 0}));
  const Bytes obj = session.exportModel(ExportFormat::kObj);
  const std::string text(obj.begin(), obj.end());
  EXPECT_THAT(text, HasSubstr("\nf "));
  double lowest = 1e9;
  for (std::size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) {
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + at, "\nv %lf %lf", &x, &y), 2);
    lowest = std::min(lowest, y);
  }
  EXPECT_NEAR(lowest, before + 2, 1e-5);
  const std::size_t triangles = session.state().rig->geometry().triangles.size();
  EXPECT_EQ(session.exportModel(ExportFormat::kStl).size(), 84 + 50 * triangles);
  EXPECT_FALSE(session.exportModel(ExportFormat::kPly).empty());
}

}  // namespace
}  // namespace limber
