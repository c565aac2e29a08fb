#include "limber/session/edit/movement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/file/file.h"
#include "limber/core/known_error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "limber/document/scene/turn_scene.h"
#include "limber/document/write.h"
#include "limber/session/drag/measures.h"
#include "limber/session/edit/clip_curves.h"
#include "limber/session/scene/session_file.h"
#include "limber/session/session.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"
#include "limber/skeleton/clip/keys/keyframes.h"
#include "shared_data.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

// The person lies on its face, as in a file with Z up.
Bytes lyingGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "person.glb");
  turnScene(asset, testing::turn(Vec3::UnitX(), 90), "z_up");
  return writeGlb(asset);
}

// Walks a hand's breadth over the ground of its rest pose, by a clip of its own; a hand moves against its arm.
Bytes movingGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "moving.glb");
  const AssetSkeleton skeleton = readSkeleton(asset);
  PoseSequence walk = testing::walk(skeleton.skeleton, 31, 30);
  for (Pose& pose : walk.poses) {
    pose.locals[0].translation.y() += 0.1;
    pose.locals[skeleton.skeleton.find("leftHand").value()].translation *= 1.1;
  }
  addClips(asset, skeleton, std::vector{clipOf(skeleton.skeleton, walk, "walk")});
  return writeGlb(asset);
}

// With shins that are a third longer.
Bytes tallGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "tall.glb");
  for (gltf::Node& node : asset.document.nodes) {
    if (node.name == "leftFoot" || node.name == "rightFoot") node.translation.value() *= 1.33;
  }
  return writeGlb(asset);
}

std::optional<Bytes> movingFiles(std::string_view path) {
  if (path == "moving.glb") return movingGlb();
  if (path == "person.glb") return testing::namedPersonGlb();
  if (path == "tall.glb") return tallGlb();
  if (path == "lying.glb") return lyingGlb();
  return path == "walk.bvh" ? std::optional<Bytes>(testing::walkBvh()) : std::nullopt;
}

void act(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Session person() {
  Session session(movingFiles);
  act(session, OpenFile{"person.glb"});
  return session;
}

Session walking() {
  Session session = person();
  act(session, AddMotion{"walk.bvh"});
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}});
  return session;
}

Quat turnOf(const Session& session, const char* joint) {
  return session.state().pose.locals[session.state().rig->skeleton().find(joint).value()].rotation;
}

TEST(Movement, KeysOverARecordedMotionHoldNoScale) {
  Session session = walking();
  EXPECT_THROW(act(session, SetScale{"head", 1.5}), Error);
  EXPECT_THROW(act(session, BeginDrag{"head", DragMode::kScale, {}}), Error);
  act(session, BeginDrag{"head", DragMode::kTurn, {}});
}

TEST(Movement, AMotionOntoAModelIsAClipThatCanBeScrubbed) {
  Session session = person();
  const Pose before = session.state().pose;
  act(session, AddMotion{"walk.bvh"});
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}, .contacts = false});
  const Movement& movement = session.state().movement;
  ASSERT_EQ(movement.clips.size(), 1u);
  EXPECT_EQ(movement.clip()->name, "walk");
  EXPECT_NEAR(movement.clip()->duration(), 1, 1e-3);
  const std::size_t recorded = session.record().size();
  for (const double seconds : {0.1, 0.5, 0.3}) act(session, SetTime{seconds});
  EXPECT_EQ(session.record().size(), recorded + 1);
  EXPECT_EQ(session.undoName(), "retarget");
  // The model and the motion have the same skeleton: what the walk says at that moment is what is shown.
  const PoseSequence walk = testing::walk(practiceHumanoid(), 31, 30);
  for (const char* joint : {"leftUpperLeg", "rightLowerLeg", "chest", "head"}) {
    const Quat expected = walk.poses[9].locals[practiceHumanoid().find(joint).value()].rotation;
    EXPECT_LT(turnOf(session, joint).angularDistance(expected), 0.02) << joint;
  }
  const std::vector<Vec3> source = sourceJoints(movement);
  EXPECT_EQ(source.size(), movement.motions[0]->skeleton.joints.size());
  EXPECT_FALSE(sessionState(session)["match"].empty());
  act(session, Undo{});
  EXPECT_TRUE(session.state().movement.clips.empty());
  EXPECT_TRUE(samePose(session.state().pose, before));
}

// How far a joint of the model goes along the ground between two moments of the chosen clip.
double slideOf(const Session& session, const char* joint, double from, double to) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  const auto at = [&](double seconds) -> Vec3 {
    Pose pose = restPose(skeleton);
    sampleClip(*session.state().movement.clip(), seconds, pose);
    return posePositions(skeleton, pose)[skeleton.find(joint).value()];
  };
  const Vec3 displacement = at(to) - at(from);
  return std::hypot(displacement.x(), displacement.z());
}

TEST(Movement, AUserSaysWhetherAFootStands) {
  Session session(movingFiles);
  act(session, OpenFile{"tall.glb"});
  act(session, AddMotion{"walk.bvh"});
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}});
  const auto feet = [&] { return sessionState(session)["clips"][0]["feet"]; };
  const Json found = feet();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0]["part"], "leftFoot");
  EXPECT_FALSE(found[0]["edited"].get<bool>());
  ASSERT_FALSE(found[0]["planted"].empty());
  const double from = found[0]["planted"][0][0], to = found[0]["planted"][0][1];
  ASSERT_GT(to - from, 0.2);
  const double middle = (from + to) / 2, pinnedSlide = slideOf(session, "leftFoot", middle, to);

  act(session, SetContact{"leftFoot", from, to, ContactChange::kFree});
  EXPECT_TRUE(feet()[0]["edited"].get<bool>());
  for (const Json& span : feet()[0]["planted"]) EXPECT_TRUE(span[1] < from || span[0] > to);
  EXPECT_GT(slideOf(session, "leftFoot", middle, to), pinnedSlide + 1e-4)
      << "legs of other proportions slide by themselves";
  // By another method the same is kept.
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .method = "spacetime", .map = {}});
  EXPECT_TRUE(feet()[0]["edited"].get<bool>());
  act(session, Undo{});
  act(session, SetContact{"leftFoot", from, to, ContactChange::kFound});
  EXPECT_EQ(feet(), found);
  EXPECT_NEAR(slideOf(session, "leftFoot", middle, to), pinnedSlide, 1e-6);

  // Where it swings, it can be set to be planted.
  const double swing = to + 0.15;
  const double swung = slideOf(session, "leftFoot", swing, swing + 0.1);
  act(session, SetContact{"leftFoot", swing - 0.1, swing + 0.1});
  EXPECT_LT(slideOf(session, "leftFoot", swing, swing + 0.1), 0.5 * swung);
  EXPECT_EQ(session.undoName(), "set_contact");
  EXPECT_ANY_THROW(act(session, SetContact{"leftHand", 0, 1}));
  EXPECT_ANY_THROW(act(session, SetContact{"leftFoot", 1, 0}));
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}, .contacts = false});
  EXPECT_TRUE(feet().empty());
}

TEST(Movement, ClipsAreJoinedOverlappingAndJoinedAnew) {
  Session session = walking();
  act(session, JoinClips{{"walk", "walk"}, 0.2, {}});
  const auto shown = [&]() -> const SessionClip& {
    return session.state().movement.clips[session.state().movement.chosen.value()];
  };
  EXPECT_EQ(shown().clip->name, "walk_walk");
  EXPECT_TRUE(shown().base);
  const Json sequence = sessionState(session)["clips"][1]["sequence"];
  ASSERT_EQ(sequence["clips"].size(), 2u);
  EXPECT_EQ(sequence["clips"][0]["from"], 0);
  EXPECT_NEAR(sequence["clips"][0]["to"].get<double>() - sequence["clips"][1]["from"].get<double>(), 0.2, 0.04);
  EXPECT_NEAR(sequence["clips"][1]["to"].get<double>(), shown().clip->duration(), 1e-6);
  EXPECT_TRUE(sessionState(session)["clips"][0]["sequence"].is_null());

  // Replaced, with the corrections on top.
  act(session, SetTime{0.1});
  act(session, testing::turnedBy("head", Vec3::UnitX(), 20));
  act(session, SetKey{0.1});
  act(session, JoinClips{{"walk", "walk", "walk"}, 0.2, "walk_walk"});
  EXPECT_EQ(session.state().movement.clips.size(), 2u);
  EXPECT_EQ(shown().clip->name, "walk_walk");
  EXPECT_EQ(sessionState(session)["clips"][1]["sequence"]["clips"].size(), 3u);
  EXPECT_FALSE(shown().layer.empty());
  EXPECT_EQ(session.undoName(), "join_clips");

  act(session, RenameClip{"walk", "stroll"});
  EXPECT_EQ(sessionState(session)["clips"][1]["sequence"]["clips"][2]["clip"], "stroll");
  act(session, AddClip{"empty"});
  const std::size_t clips = session.state().movement.clips.size();
  EXPECT_THROW(act(session, JoinClips{{"stroll"}, 0.2, {}}), Error);
  EXPECT_THROW(act(session, JoinClips{{"stroll", "walk"}, 0.2, {}}), Error) << "is called otherwise now";
  EXPECT_THROW(act(session, JoinClips{{"stroll", "stroll"}, 0, {}}), Error);
  EXPECT_THROW(act(session, JoinClips{{"stroll", "stroll"}, 0.2, "stroll"}), Error) << "is no sequence";
  EXPECT_THROW(act(session, JoinClips{{"stroll", "walk_walk"}, 0.2, "walk_walk"}), Error);
  EXPECT_EQ(session.state().movement.clips.size(), clips);

  // On another rig it stays what it is, and can be joined anew there.
  act(session, ChooseClip{"walk_walk"});
  act(session, SetHandles{25});
  EXPECT_FALSE(sessionState(session)["clips"][1]["sequence"].is_null());
}

TEST(Movement, ASequenceHoldsPosesAndTellsOfShortTransitions) {
  Session session = walking();
  act(session, AddClip{"empty"});
  const std::size_t before = sessionState(session)["warnings"].size();
  act(session, JoinClips{{"walk", "empty"}, 0.2, {}});
  EXPECT_EQ(sessionState(session)["warnings"].size(), before);
  act(session, JoinClips{{"walk", "walk"}, 50, {}});
  EXPECT_EQ(sessionState(session)["warnings"].back()["kind"], "short-transitions");
}

TEST(Movement, ASequenceGoesOnWithoutAClipThatWasRemoved) {
  Session session = walking();
  act(session, JoinClips{{"walk", "walk"}, 0.2, {}});
  act(session, RenameClip{"walk_walk", "long"});
  act(session, JoinClips{{"walk", "long", "walk"}, 0.2, {}});
  act(session, RemoveClip{"long"});
  const std::string name = "walk_long_walk";
  EXPECT_EQ(sessionState(session)["clips"][1]["sequence"]["clips"].size(), 3u) << "stays as it was joined";
  EXPECT_THROW(act(session, JoinClips{{"walk", "jump", "walk"}, 0.3, name}), Error) << "never was there";
  EXPECT_THROW(act(session, JoinClips{{"walk", "long"}, 0.3, name}), Error) << "of one clip";
  const std::size_t before = sessionState(session)["warnings"].size();
  act(session, JoinClips{{"walk", "long", "walk"}, 0.3, name});
  const Json state = sessionState(session);
  EXPECT_EQ(state["clips"][1]["sequence"]["clips"].size(), 2u);
  ASSERT_EQ(state["warnings"].size(), before + 1);
  EXPECT_EQ(state["warnings"].back()["kind"], "removed-clips");
}

TEST(Movement, AModelsOwnMotionPutBackIsTheSame) {
  for (const char* method : {"limb-ik", "spacetime", "aligned"}) {
    Session session(movingFiles);
    act(session, OpenFile{"moving.glb"});
    act(session, AddMotion{"moving.glb"});
    act(session, RetargetMotion{.motion = "moving", .clip = {}, .method = method, .map = {}});
    const Movement& movement = session.state().movement;
    ASSERT_EQ(movement.clips.size(), 2u);
    const Skeleton& skeleton = session.state().rig->skeleton();
    const auto at = [&](std::size_t clip, double seconds) {
      Pose pose = restPose(skeleton);
      sampleClip(*movement.clips[clip].clip, seconds, pose);
      return posePositions(skeleton, pose);
    };
    for (const double seconds : {0.1, 0.4, 0.8}) {
      const std::vector<Vec3> own = at(0, seconds), back = at(1, seconds);
      for (Index j = 0; j < skeleton.jointCount(); ++j) {
        EXPECT_LT((own[j] - back[j]).norm(), 1e-4) << method << ' ' << skeleton.joints[j].name;
      }
    }
  }
}

TEST(Movement, OneWhoLiesAtRestStandsInMotion) {
  const auto headOverHips = [](const Session& session, const Pose& pose) -> Vec3 {
    const Skeleton& skeleton = session.state().rig->skeleton();
    const std::vector<Affine> globals = poseGlobals(skeleton, pose);
    const auto at = [&](const char* joint) { return globals[skeleton.find(joint).value()].translation(); };
    return (at("head") - at("hips")).normalized();
  };
  Session session(movingFiles);
  act(session, OpenFile{"lying.glb"});
  EXPECT_GT(headOverHips(session, restPose(session.state().rig->skeleton())).z(), 0.9);
  act(session, AddMotion{"walk.bvh"});
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}});
  act(session, SetTime{0.3});
  EXPECT_GT(headOverHips(session, session.state().pose).y(), 0.9);
  const SessionMeasures measures = measureSession(session), upright = measureSession(walking());
  ASSERT_TRUE(measures.motion && upright.motion);
  EXPECT_NEAR(measures.motion->boneDirection, upright.motion->boneDirection, 0.1);
}

TEST(Movement, SampleMotionsNeedNoFile) {
  Session session = person();
  act(session, AddSampleMotion{"walk"});
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}});
  EXPECT_EQ(session.state().movement.clip()->name, "walk");
  EXPECT_GT(session.state().movement.clip()->duration(), 1);
  EXPECT_THROW(act(session, AddSampleMotion{"flight"}), Error);
}

TEST(Movement, AnotherMethodTakesTheClipsPlaceAndAMapIsObeyed) {
  Session session = walking();
  act(session, SetTime{0.4});
  const Quat before = turnOf(session, "leftLowerLeg");
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .method = "aligned", .map = {}});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  EXPECT_EQ(session.state().movement.seconds, 0.4);
  EXPECT_EQ(sessionState(session)["clips"][0]["source"]["method"], "aligned");
  // Without the right arm in the map it stays at rest.
  Json map = {{"matches", sessionState(session)["match"]}};
  Json& matches = map["matches"];
  for (std::size_t i = matches.size(); i-- > 0;) {
    if (matches[i]["part"].get<std::string>().rfind("right", 0) == 0) matches.erase(i);
  }
  RetargetMotion left{.motion = "walk", .clip = {}, .method = "aligned", .map = map.dump()};
  act(session, left);
  EXPECT_LT(turnOf(session, "rightUpperArm").angularDistance(Quat::Identity()), 1e-6);
  EXPECT_GT(turnOf(session, "leftLowerLeg").angularDistance(Quat::Identity()), 0.05);
  EXPECT_LT(turnOf(session, "leftLowerLeg").angularDistance(before), 0.3);
}

TEST(Movement, PosesBecomeKeys) {
  Session session = person();
  act(session, AddClip{"nod"});
  act(session, SetKey{});
  act(session, SetTime{0.5});
  act(session, testing::turnedBy("head", Vec3::UnitX(), 30));
  act(session, SetKey{});
  act(session, SetTime{1});
  act(session, ResetJoint{"head"});
  act(session, SetKey{});
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 0.5, 1));
  act(session, SetTime{0.25});
  EXPECT_NEAR(turnOf(session, "head").angularDistance(Quat::Identity()), 15 * EIGEN_PI / 180, 1e-5);
  act(session, SetInterpolation{Interpolation::kStep});
  EXPECT_NEAR(turnOf(session, "head").angularDistance(Quat::Identity()), 0, 1e-5);
  act(session, EditKeys{.keys = {{"", 0.5}}, .shift = -0.3});
  EXPECT_NEAR(turnOf(session, "head").angularDistance(Quat::Identity()), 30 * EIGEN_PI / 180, 1e-5);
  act(session, DeleteKeys{{{"", 0.2}}});
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 1));
  EXPECT_THROW(act(session, DeleteKeys{{{"", 0.2}}}), Error);
  act(session, Undo{});
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 0.2f, 1));
}

// The fastest that any joint turns from one frame to the next, degrees per second, between two moments.
double fastestTurn(const Session& session, const Clip& clip, double from, double to) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  Pose last = restPose(skeleton), now = last;
  double fastest = 0;
  for (int frame = 0; from + frame / 30.0 <= to; ++frame) {
    sampleClip(clip, from + frame / 30.0, now);
    for (std::size_t j = 0; frame > 0 && j < now.locals.size(); ++j) {
      const double angle = now.locals[j].rotation.angularDistance(last.locals[j].rotation);
      fastest = std::max(fastest, angle * 30 * 180 / static_cast<double>(EIGEN_PI));
    }
    last = now;
  }
  return fastest;
}

Json chosenJson(const Session& session) {
  const Json state = sessionState(session);
  return state["clips"][state["clip"].get<std::size_t>()];
}

void expectSameKeys(const Clip& a, const Clip& b) {
  const auto same = [](const auto& x, const auto& y) {
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t t = 0; t < x.size(); ++t) {
      EXPECT_EQ(x[t].joint, y[t].joint);
      EXPECT_EQ(x[t].times, y[t].times);
      ASSERT_EQ(x[t].values.size(), y[t].values.size());
      for (std::size_t k = 0; k < x[t].values.size(); ++k) {
        if constexpr (std::is_same_v<std::decay_t<decltype(x[t].values[k])>, Vec3f>) {
          EXPECT_EQ(x[t].values[k], y[t].values[k]);
        } else {
          EXPECT_EQ(x[t].values[k].coeffs(), y[t].values[k].coeffs());
        }
      }
    }
  };
  same(a.rotations, b.rotations);
  same(a.translations, b.translations);
  same(a.scales, b.scales);
}

Session correctedWalk() {
  Session session = walking();
  act(session, SetTime{0.5});
  act(session, testing::turnedBy("leftLowerArm", Vec3(0, 1, 0), 40));
  act(session, SetKey{.span = 0.3});
  return session;
}

TEST(Movement, ACorrectionOfRecordedMotionComesAndGoesWithoutASpike) {
  Session session = walking();
  const std::shared_ptr<const Clip> base = session.state().movement.clips[0].clip;
  EXPECT_TRUE(chosenJson(session)["recorded"].get<bool>());
  EXPECT_TRUE(chosenJson(session)["keys"].empty()) << "it has one for every frame";
  act(session, SetTime{0.5});
  const Quat before = turnOf(session, "leftLowerArm");
  act(session, testing::turnedBy("leftLowerArm", Vec3(0, 1, 0), 40));
  act(session, SetKey{.span = 0.3});
  EXPECT_EQ(chosenJson(session)["joint_keys"].size(), 1u) << "one joint was corrected";
  EXPECT_THAT(chosenJson(session)["keys"], ElementsAre(0.5));
  act(session, SetTime{0.5});
  EXPECT_NEAR(turnOf(session, "leftLowerArm").angularDistance(before), 40 * EIGEN_PI / 180, 1e-3);

  const Clip& corrected = *session.state().movement.clip();
  EXPECT_NO_THROW(checkClip(corrected, session.state().rig->skeleton()));
  const double was = fastestTurn(session, *base, 0.1, 0.9), is = fastestTurn(session, corrected, 0.1, 0.9);
  EXPECT_LT(is, 3 * was);
  RecordProperty("base_degrees_per_second", std::to_string(was));
  RecordProperty("corrected_degrees_per_second", std::to_string(is));
  // The arm itself: a key of one frame, as without a layer, would turn it by 1200 degrees a second.
  const auto armAt = [&](double seconds) {
    Pose pose = restPose(session.state().rig->skeleton());
    sampleClip(corrected, seconds, pose);
    return pose.locals[session.state().rig->skeleton().find("leftLowerArm").value()].rotation;
  };
  for (int frame = 1; frame < 30; ++frame) {
    EXPECT_LT(armAt(frame / 30.0).angularDistance(armAt((frame - 1) / 30.0)) * 30 * 180 / EIGEN_PI, 300) << frame;
  }

  act(session, DeleteKeys{{{"", 0.5}}});
  EXPECT_EQ(session.state().movement.clips[0].clip, base) << "without keys the layer is gone";
}

TEST(Movement, ACorrectionStaysWhenTheMotionBelowIsMadeAnew) {
  Session session = correctedWalk();
  const Clip corrected = *session.state().movement.clip();
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .method = "aligned", .map = {}});
  const Clip other = *session.state().movement.clip();
  EXPECT_EQ(chosenJson(session)["source"]["method"], "aligned");
  EXPECT_THAT(chosenJson(session)["keys"], ElementsAre(0.5));
  act(session, SetTime{0.5});
  const Pose below = [&] {
    Pose pose = restPose(session.state().rig->skeleton());
    sampleClip(*session.state().movement.clips[0].base, 0.5, pose);
    return pose;
  }();
  const Index arm = session.state().rig->skeleton().find("leftLowerArm").value();
  EXPECT_NEAR(turnOf(session, "leftLowerArm").angularDistance(below.locals[arm].rotation), 40 * EIGEN_PI / 180, 1e-3);
  act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}});
  expectSameKeys(*session.state().movement.clip(), corrected);
  act(session, Undo{});
  expectSameKeys(*session.state().movement.clip(), other);
}

TEST(Movement, KeysOfALayerAreMovedScaledCopiedAndDeleted) {
  Session session = correctedWalk();
  const auto times = [&](const char* joint) {
    const Json clip = chosenJson(session);
    for (const Json& of : clip["joint_keys"]) {
      const Skeleton& skeleton = session.state().rig->skeleton();
      if (skeleton.joints[of["joint"].get<Index>()].name == joint) return of["seconds"].get<std::vector<double>>();
    }
    return std::vector<double>();
  };
  act(session, EditKeys{.keys = {{"leftLowerArm", 0.5}}, .shift = 0.2, .copy = true});
  EXPECT_THAT(times("leftLowerArm"), ElementsAre(0.5, 0.7));
  act(session, EditKeys{.keys = {{"leftLowerArm", 0.5}, {"leftLowerArm", 0.7}}, .scale = 1.5, .pivot = 0.5});
  EXPECT_THAT(times("leftLowerArm"), ElementsAre(0.5, ::testing::DoubleNear(0.8, 1e-9)));
  // Between keys whose spans meet, the correction stays.
  act(session, SetTime{0.65});
  Pose below = restPose(session.state().rig->skeleton());
  sampleClip(*session.state().movement.clips[0].base, 0.65, below);
  const Index arm = session.state().rig->skeleton().find("leftLowerArm").value();
  EXPECT_NEAR(turnOf(session, "leftLowerArm").angularDistance(below.locals[arm].rotation), 40 * EIGEN_PI / 180, 1e-3);

  EXPECT_THROW(act(session, EditKeys{.keys = {{"leftLowerArm", 0.1}}, .shift = 0.2}), Error);
  EXPECT_THROW(act(session, EditKeys{.keys = {{"leftLowerArm", 0.5}}, .shift = -0.6}), Error);
  EXPECT_THROW(act(session, EditKeys{.keys = {}}), Error);
  EXPECT_THROW(act(session, DeleteKeys{{{"wing", 0.5}}}), Error);
  act(session, DeleteKeys{{{"leftLowerArm", 0.5}, {"leftLowerArm", times("leftLowerArm")[1]}}});
  EXPECT_EQ(session.state().movement.clips[0].clip, session.state().movement.clips[0].base);
  act(session, Undo{});
  EXPECT_EQ(times("leftLowerArm").size(), 2u);
}

TEST(Movement, KeysOfOneJointOfAClipMadeByHand) {
  Session session = person();
  act(session, AddClip{"nod"});
  act(session, testing::turnedBy("head", Vec3::UnitX(), 10));
  act(session, SetKey{});
  act(session, SetTime{0.5});
  act(session, testing::turnedBy("head", Vec3::UnitX(), 30));
  act(session, SetKey{});
  EXPECT_FALSE(chosenJson(session)["recorded"].get<bool>());
  act(session, EditKeys{.keys = {{"head", 0.5}}, .shift = 0.5});
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 0.5, 1)) << "the root has a key there still";
  act(session, SetTime{1});
  EXPECT_NEAR(turnOf(session, "head").angularDistance(Quat::Identity()), 40 * EIGEN_PI / 180, 1e-4);
  act(session, DeleteKeys{{{"hips", 0.5}}});
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 1));
}

TEST(Movement, AMotionIsAddedAndPutOnAtOnceOrNotAtAll) {
  Session session = person();
  act(session, AddMotion{.file = "walk.bvh", .retarget = true});
  Session apart = walking();
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  EXPECT_EQ(session.state().movement.clip()->rotations.front().values.size(),
            apart.state().movement.clip()->rotations.front().values.size());
  EXPECT_EQ(turnOf(session, "leftUpperLeg").coeffs(), turnOf(apart, "leftUpperLeg").coeffs());
  act(session, Undo{});
  EXPECT_TRUE(session.state().movement.clips.empty());
  EXPECT_TRUE(session.state().movement.motions.empty());

  const std::size_t recorded = session.record().size();
  try {
    act(session, AddSampleMotion{.name = "gallop", .retarget = true});
    FAIL() << "a person does not gallop";
  } catch (const KnownError& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUnlikeBodies);
  }
  EXPECT_TRUE(session.state().movement.motions.empty());
  EXPECT_EQ(session.record().size(), recorded);
  EXPECT_EQ(session.redoName(), "add_motion") << "what was undone can still be done again";
}

TEST(Movement, WhatIsRefusedHasAKind) {
  Session session = walking();
  const auto kindOf = [&](const Command& command) -> std::optional<ErrorKind> {
    try {
      act(session, command);
    } catch (const KnownError& error) {
      return error.kind();
    } catch (const Error&) {
    }
    return std::nullopt;
  };
  const std::string twice =
      R"({"matches": [{"part": "leftHand", "source": ["leftHand"], "target": ["rightFoot"]},
                      {"part": "rightFoot", "source": ["rightFoot"], "target": ["rightFoot"]}]})";
  const Json before = sessionState(session)["match"];
  EXPECT_EQ(kindOf(RetargetMotion{.motion = "walk", .clip = {}, .map = twice}), ErrorKind::kJointMatchedTwice);
  EXPECT_EQ(sessionState(session)["match"], before);
  EXPECT_EQ(kindOf(RenameClip{"walk", ""}), ErrorKind::kNameMissing);
  EXPECT_EQ(kindOf(AddClip{"walk"}), ErrorKind::kNameTaken);
  EXPECT_EQ(kindOf(RenameJoint{"head", "hips"}), ErrorKind::kNameTaken);
  EXPECT_EQ(kindOf(DeleteJoint{"hips"}), ErrorKind::kOnlyRoot);
  EXPECT_EQ(kindOf(ReparentJoint{"hips", "head"}), ErrorKind::kJointBelowItself);
  EXPECT_EQ(kindOf(SetLimits{"{}"}), ErrorKind::kNoLimitsFile);
  EXPECT_EQ(kindOf(Redo{}), ErrorKind::kNothingToRedo);
  EXPECT_EQ(kindOf(BeginDrag{}), std::nullopt) << "a joint without a name";
  act(session, ChooseClip{""});
  EXPECT_EQ(kindOf(SetKey{}), ErrorKind::kNoClip);
}

// At rest, 90 degrees, at rest, in two seconds.
Session bowing(Interpolation interpolation) {
  Session session = person();
  act(session, AddClip{"bow"});
  act(session, SetKey{});
  for (const double seconds : {0.0, 1.0, 2.0}) {
    act(session, SetJointKey{"leftLowerArm", seconds, {0, seconds == 1 ? 90.0 : 0.0, 0}, Vec3::Zero()});
  }
  act(session, SetInterpolation{interpolation});
  return session;
}

std::vector<CurveTangent> armTangents(const Session& session) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  return curveTangents(session.state().movement, skeleton, skeleton.find("leftLowerArm").value());
}

double armTurnAt(const Session& session, double seconds) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  const Index arm = skeleton.find("leftLowerArm").value();
  return jointCurve(session.state().movement, skeleton, arm, std::vector<double>{seconds})[0].turn.y();
}

TEST(Movement, TangentsSetByHandStayThroughEditsAndFiles) {
  Session session = bowing(Interpolation::kCubic);
  ASSERT_EQ(armTangents(session).size(), 3u);
  EXPECT_EQ(armTangents(session)[1].tangents, KeyTangents::kAuto);
  const double before = armTurnAt(session, 0.75);
  act(session, SetTangents{{{"leftLowerArm", 1}}, KeyTangents::kFree, {0, 60, 0}, Vec3::Zero()});
  const auto isKept = [](const Session& kept) {
    const std::vector<CurveTangent> tangents = armTangents(kept);
    ASSERT_EQ(tangents.size(), 3u);
    EXPECT_EQ(tangents[1].tangents, KeyTangents::kFree);
    EXPECT_NEAR(tangents[1].slope.turn.y(), 60, 0.1);
    EXPECT_EQ(tangents[0].tangents, KeyTangents::kAuto);
  };
  isKept(session);
  EXPECT_LT(armTurnAt(session, 0.75), before - 2) << "it comes from below";
  EXPECT_GT(armTurnAt(session, 1.1), 90) << "and goes on upwards";
  const double during = armTurnAt(session, 0.75);

  act(session, SetJointKey{"leftLowerArm", 3, {0, 45, 0}, Vec3::Zero()});
  isKept([&] {
    Session shorter = session.fork();
    act(shorter, DeleteKeys{{{"leftLowerArm", 3}}});
    return shorter;
  }());
  act(session, Undo{});
  isKept(session);

  Session reopened(movingFiles);
  Progress progress;
  reopened.open(session.saveSession(), "saved.glb", progress);
  act(reopened, ChooseClip{"bow"});
  isKept(reopened);
  EXPECT_NEAR(armTurnAt(reopened, 0.75), during, 1e-3);

  act(session, EditKeys{.keys = {{"leftLowerArm", 0}, {"leftLowerArm", 1}, {"leftLowerArm", 2}}, .scale = 2});
  EXPECT_NEAR(armTangents(session)[1].slope.turn.y(), 30, 0.1) << "twice as slow";
  EXPECT_NEAR(armTurnAt(session, 1.5), during, 1e-3);
  act(session, SetTangents{{{"leftLowerArm", 2}}, KeyTangents::kFlat});
  EXPECT_EQ(armTangents(session)[1].tangents, KeyTangents::kAuto) << "level is what the spline has there";
  act(session, Undo{});
  act(session, Undo{});
  act(session, SetTangents{{{"leftLowerArm", 1}}, KeyTangents::kAuto});
  EXPECT_NEAR(armTurnAt(session, 0.75), before, 1e-3);
}

TEST(Movement, OnlyCubicKeysMadeByHandHaveTangents) {
  Session linear = bowing(Interpolation::kLinear);
  EXPECT_TRUE(armTangents(linear).empty());
  EXPECT_THROW(act(linear, SetTangents{{{"leftLowerArm", 1}}}), Error);
  Session session = correctedWalk();
  EXPECT_TRUE(armTangents(session).empty());
  EXPECT_THROW(act(session, SetTangents{{{"leftLowerArm", 0.5}}}), Error);
}

TEST(Movement, KeysArePastedIntoAnotherClipAndOntoAnotherCharacter) {
  Session session = bowing(Interpolation::kLinear);
  act(session, SetTime{1});
  const std::string pose = session.savePose("bow");
  act(session, AddClip{"other"});
  act(session, ResetPose{});
  act(session, SetKey{});
  act(session, PasteKeys{{{pose, {"leftLowerArm"}, 0.5}}});
  EXPECT_NEAR(armTurnAt(session, 0.5), 90, 1e-2);
  EXPECT_NEAR(armTurnAt(session, 0.25), 45, 1e-2);
  EXPECT_EQ(session.undoName(), "paste_keys");
  act(session, ChooseClip{"bow"});
  EXPECT_NEAR(armTurnAt(session, 0.5), 45, 1e-2) << "the clip that it came from is as it was";

  Session other(movingFiles);
  act(other, OpenSample{"biped"});
  act(other, ChooseMethods{"template", "bone-heat"});
  act(other, AddClip{"bow"});
  act(other, SetKey{});
  const Skeleton& skeleton = other.state().rig->skeleton();
  const auto bend = [&] {
    const Index arm = skeleton.find("leftLowerArm").value();
    return other.state().pose.locals[arm].rotation.angularDistance(skeleton.joints[arm].rest.rotation);
  };
  act(other, SetTime{0.5});
  const double straight = bend();
  act(other, PasteKeys{{{pose, {"leftLowerArm"}, 0.5}}});
  EXPECT_NEAR(bend() - straight, 90 * EIGEN_PI / 180, 0.35);
  EXPECT_THROW(act(other, PasteKeys{{{pose, {"wing"}, 0.5}}}), Error);
}

TEST(Movement, AJointsKeyIsGivenAValue) {
  Session session = correctedWalk();
  const auto jointAt = [&](double seconds) {
    const Index arm = session.state().rig->skeleton().find("leftLowerArm").value();
    return jointCurve(session.state().movement, session.state().rig->skeleton(), arm, std::vector<double>{seconds})[0];
  };
  act(session, SetJointKey{"leftLowerArm", 0.5, {5, 25, -10}, {0, 0.02, 0}});
  EXPECT_THAT(chosenJson(session)["keys"], ElementsAre(0.5));
  EXPECT_LT((jointAt(0.5).turn - Vec3(5, 25, -10)).norm(), 1e-3);
  EXPECT_LT((jointAt(0.5).offset - Vec3(0, 0.02, 0)).norm(), 1e-5);
  EXPECT_THROW(act(session, SetJointKey{"wing", 0.5}), Error);

  act(session, AddClip{"bow"});
  act(session, ResetPose{});
  act(session, SetKey{});
  act(session, SetJointKey{"leftLowerArm", 1, {0, 90, 0}, Vec3::Zero()});
  EXPECT_LT((jointAt(1).turn - Vec3(0, 90, 0)).norm(), 1e-3);
  EXPECT_LT((jointAt(0.5).turn - Vec3(0, 45, 0)).norm(), 1e-3);
}

// A turn of more than half a circle does not come back from the other side.
TEST(Movement, CurvesAndPathsRunThroughTheClip) {
  Session session = person();
  act(session, AddClip{"spin"});
  act(session, SetKey{});
  for (int k = 1; k <= 4; ++k) {
    act(session, SetTime{0.5 * k});
    act(session, testing::turnedBy("hips", Vec3::UnitY(), 75));
    act(session, SetKey{});
  }
  const Movement& movement = session.state().movement;
  const Skeleton& skeleton = session.state().rig->skeleton();
  const std::vector<double> moments = evenMoments(movement, 30, 1000);
  ASSERT_EQ(moments.size(), 61u);
  EXPECT_EQ(moments.back(), 2);
  EXPECT_EQ(evenMoments(movement, 30, 11).size(), 11u);
  const std::vector<CurvePoint> curve = jointCurve(movement, skeleton, skeleton.find("hips").value(), moments);
  for (std::size_t k = 0; k < curve.size(); ++k) {
    EXPECT_NEAR(curve[k].turn.y(), 150 * moments[k], 0.1) << moments[k];
  }
  EXPECT_EQ(curveMoments(movement, skeleton.find("hips").value(), 30, 2), (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  const std::vector<Vec3> paths = jointPaths(movement, skeleton, moments);
  ASSERT_EQ(paths.size(), moments.size() * skeleton.joints.size());
  const std::vector<Vec3> first = posePositions(skeleton, restPose(skeleton));
  EXPECT_LT((paths[3] - first[3]).norm(), 1e-6);
  act(session, ChooseClip{});
  EXPECT_TRUE(evenMoments(session.state().movement, 30, 100).empty());
}

TEST(Movement, ASavedSessionKeepsTheLayerOnItsMotion) {
  Session session = correctedWalk();
  Session saved;
  Progress progress;
  saved.open(session.saveSession(), "saved.glb", progress);
  EXPECT_THAT(chosenJson(saved)["keys"], ElementsAre(0.5));
  EXPECT_LT(turnOf(saved, "leftLowerArm").angularDistance(turnOf(session, "leftLowerArm")), 1e-5);
  act(saved, SetTime{0.4});
  act(session, SetTime{0.4});
  EXPECT_LT(turnOf(saved, "leftLowerArm").angularDistance(turnOf(session, "leftLowerArm")), 1e-5);
  act(saved, DeleteKeys{{{"", 0.5}}});
  act(session, DeleteKeys{{{"", 0.5}}});
  EXPECT_LT(turnOf(saved, "leftLowerArm").angularDistance(turnOf(session, "leftLowerArm")), 1e-5);
}

TEST(Movement, ASavedLayerThatBreaksTheFormatIsNamed) {
  const auto saved = [](const LayerKey& first, const LayerKey& second, const char* joint, const char* clip) {
    Asset asset = readAsset(correctedWalk().saveSession(), "saved.glb");
    SavedSession session = takeSession(asset).value();
    session.layers = {{clip, {{joint, {first, second}}}}};
    putSession(asset, session);
    return writeGlb(asset);
  };
  const auto expectRefused = [](const Bytes& bytes, const char* where) {
    Session session;
    Progress progress;
    try {
      session.open(bytes, "saved.glb", progress);
      ADD_FAILURE() << where << " is taken";
    } catch (const Error& error) {
      EXPECT_THAT(error.where(), ::testing::HasSubstr(where));
    }
  };
  const LayerKey early{0.2, 0.1, Vec3::Zero(), Quat::Identity()}, late{0.4, 0.1, Vec3::Zero(), Quat::Identity()};
  LayerKey bent = late, before = early;
  bent.rotation.coeffs() *= 2;
  before.seconds = -1;
  expectRefused(saved(late, early, "head", "walk"), "layers[0].tracks[0].keys[1]");
  expectRefused(saved(early, bent, "head", "walk"), "layers[0].tracks[0].keys[1].rotation");
  expectRefused(saved(before, late, "head", "walk"), "layers[0].tracks[0].keys[0]");
  expectRefused(saved(early, late, "wing", "walk"), "layers[0]");
  expectRefused(saved(early, late, "head", "run"), "layers[0]");
}

TEST(Movement, ClipsAreChosenRenamedAndRemoved) {
  Session session = walking();
  act(session, AddClip{"wave"});
  EXPECT_EQ(session.state().movement.clip()->name, "wave");
  EXPECT_THROW(act(session, AddClip{"walk"}), Error);
  act(session, RenameClip{"walk", "stroll"});
  EXPECT_THROW(act(session, RenameClip{"stroll", "wave"}), Error);
  EXPECT_THROW(act(session, ChooseClip{"walk"}), Error);
  act(session, ChooseClip{"stroll"});
  EXPECT_FALSE(samePose(session.state().pose, session.state().rig->home));
  act(session, ChooseClip{});
  EXPECT_TRUE(samePose(session.state().pose, session.state().rig->home));
  EXPECT_THROW(act(session, SetTime{0}), Error);
  EXPECT_THROW(act(session, SetKey{}), Error);
  act(session, RemoveClip{"stroll"});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  EXPECT_THROW(act(session, RetargetMotion{.motion = "none", .clip = {}, .map = {}}), Error);
  EXPECT_THROW(act(session, RetargetMotion{.motion = "walk", .clip = "other", .map = {}}), Error);
  EXPECT_THROW(act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = "{"}), Error);
  EXPECT_THROW(act(session, RetargetMotion{.motion = "walk", .clip = {}, .map = {}, .reach = 2}), Error);
  EXPECT_THROW(act(session, AddMotion{"person.png"}), Error);
  act(session, AddMotion{"walk.bvh"});
  EXPECT_EQ(session.state().movement.motions[1]->name, "walk 2");
}

TEST(Movement, ExportedAndSavedClipsComeBack) {
  Session session = walking();
  act(session, AddClip{"nod"});
  act(session, testing::turnedBy("head", Vec3::UnitX(), 30));
  act(session, SetKey{});
  act(session, RenameJoint{"jaw", "mandible"});
  act(session, ChooseClip{"walk"});
  act(session, SetTime{0.5});

  const Bytes glb = session.exportModel(ExportFormat::kGlb);
  writeFile(testing::testOutputFolder() / "session_clips.glb", glb);
  Session exported;
  Progress progress;
  exported.open(glb, "out.glb", progress);
  const Movement& read = exported.state().movement;
  ASSERT_EQ(read.clips.size(), 2u);
  EXPECT_EQ(read.clips[1].clip->name, "nod");
  EXPECT_NEAR(read.clips[0].clip->duration(), 1, 1e-3);
  EXPECT_TRUE(exported.state().rig->skeleton().find("mandible"));
  act(exported, ChooseClip{"walk"});
  act(exported, SetTime{0.5});
  EXPECT_LT(turnOf(exported, "leftLowerLeg").angularDistance(turnOf(session, "leftLowerLeg")), 1e-5);
  // Untouched clips stay as the file has them, changed ones are written anew and not twice.
  EXPECT_EQ(exported.state().rig->clips[0], read.clips[0].clip);
  act(exported, RemoveClip{"walk"});
  act(exported, RenameClip{"nod", "yes"});
  Session third;
  third.open(exported.exportModel(ExportFormat::kGlb), "third.glb", progress);
  ASSERT_EQ(third.state().movement.clips.size(), 1u);
  EXPECT_EQ(third.state().movement.clips[0].clip->name, "yes");

  Session saved;
  saved.open(session.saveSession(), "saved.glb", progress);
  ASSERT_TRUE(saved.state().movement.clip());
  EXPECT_EQ(saved.state().movement.clip()->name, "walk");
  EXPECT_EQ(saved.state().movement.seconds, 0.5);
  EXPECT_LT(turnOf(saved, "leftLowerLeg").angularDistance(turnOf(session, "leftLowerLeg")), 1e-5);
}

TEST(Movement, TheRecordReplayedGivesTheSameBytes) {
  Session session = walking();
  act(session, SetTime{0.25});
  act(session, testing::turnedBy("head", Vec3::UnitY(), 20));
  act(session, SetKey{});
  act(session, RenameJoint{"head", "skull"});
  act(session, SetInterpolation{Interpolation::kCubic});
  act(session, AddClip{"still"});
  act(session, testing::movedBy("hips", {0.1, 0.2, 0}));
  act(session, SetRestPose{});
  act(session, Undo{});
  act(session, Redo{});
  Session again(movingFiles);
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) act(again, command);
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));
  EXPECT_EQ(sessionState(again).dump(), sessionState(session).dump());
}

TEST(Movement, ThePoseBecomesTheRestPose) {
  Session session(movingFiles);
  Progress progress;
  session.open(testing::bipedGlb(), "biped.glb", progress);
  act(session, SetHandles{12});
  const std::string name = session.state().rig->skeleton().joints.back().name;
  act(session, testing::turnedBy(name, Vec3::UnitZ(), 25));
  act(session, testing::movedBy(session.state().rig->skeleton().joints[0].name, {0, 0.5, 0}));
  const std::vector<Vec3f> posed = posedPositions(*session.state().rig, session.state().pose);
  act(session, SetRestPose{});
  EXPECT_FALSE(sessionState(session)["posed"].get<bool>());
  double furthest = 0;
  for (std::size_t v = 0; v < posed.size(); ++v) {
    furthest = std::max(furthest, double{(session.state().rig->geometry().positions[v] - posed[v]).norm()});
  }
  EXPECT_LT(furthest, 1e-5);
  // Other handles are made for the new shape.
  act(session, SetHandles{8});
  double lowest = 1e9;
  for (const Vec3f& p : session.state().rig->geometry().positions) lowest = std::min(lowest, double{p.y()});
  EXPECT_NEAR(lowest, 0.5, 0.2);
  act(session, Undo{});
  act(session, Undo{});
  EXPECT_TRUE(sessionState(session)["posed"].get<bool>());
  EXPECT_EQ(session.state().rig->skeleton().joints.back().name, name);
}

TEST(Movement, KeysGoOverToOtherHandlesAndBack) {
  Session session(movingFiles);
  Progress progress;
  session.open(testing::bipedGlb(), "biped.glb", progress);
  act(session, SetHandles{20});
  const std::string last = session.state().rig->skeleton().joints.back().name;
  act(session, AddClip{"wave"});
  act(session, SetKey{});
  act(session, SetTime{1});
  act(session, testing::turnedBy(last, Vec3::UnitZ(), 50));
  act(session, testing::movedBy(session.state().rig->skeleton().joints[0].name, {0, 0.2, 0}));
  act(session, SetKey{});
  const std::vector<Vec3f> posed = posedPositions(*session.state().rig, session.state().pose);
  const auto clip = session.state().movement.clips[0].clip;
  const auto gap = [&] {
    const std::vector<Vec3f> now = posedPositions(*session.state().rig, session.state().pose);
    double sum = 0;
    for (std::size_t v = 0; v < now.size(); ++v) sum += (now[v] - posed[v]).norm();
    return sum / static_cast<double>(now.size());
  };
  act(session, SetHandles{30});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  EXPECT_EQ(session.state().movement.clip()->name, "wave");
  EXPECT_THAT(keyTimes(*session.state().movement.clip()), ElementsAre(0, 1));
  act(session, SetTime{0});
  EXPECT_GT(gap(), 0.15);
  act(session, SetTime{1});
  EXPECT_LT(gap(), 0.02);
  act(session, SetHandles{20});
  EXPECT_EQ(session.state().movement.clips[0].clip->rotations.size(), clip->rotations.size());
  for (std::size_t t = 0; t < clip->rotations.size(); ++t) {
    EXPECT_EQ(session.state().movement.clips[0].clip->rotations[t].values.back().coeffs(),
              clip->rotations[t].values.back().coeffs());
  }
}

TEST(Movement, AMotionIsRetargetedAnewForOtherJointsWhereItFits) {
  Session session = walking();
  act(session, SetTime{0.4});
  const std::vector<Vec3f> posed = posedPositions(*session.state().rig, session.state().pose);
  const std::shared_ptr<const Clip> before = session.state().movement.clips[0].clip;
  act(session, SetHandles{40});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  EXPECT_EQ(session.state().movement.seconds, 0.4);
  EXPECT_NO_THROW(checkClip(*session.state().movement.clip(), session.state().rig->skeleton()));
  EXPECT_EQ(session.state().movement.clip()->name, "walk");
  EXPECT_NEAR(session.state().movement.clip()->duration(), before->duration(), 1e-3);
  sessionState(session);  // the match, if there is one, names joints that there are
  act(session, Undo{});
  EXPECT_EQ(session.state().movement.clips[0].clip, before);
}

TEST(Movement, EditsStayOnOtherRigs) {
  Session session = walking();
  const auto handAt = [&](const char* name) {
    const Skeleton& skeleton = session.state().rig->skeleton();
    return Vec3(poseGlobals(skeleton, session.state().pose)[skeleton.find(name).value()].translation());
  };
  act(session, SetTime{0.5});
  act(session, testing::turnedBy("leftUpperArm", Vec3(0, 0, 1), 60));
  act(session, SetKey{.span = 0.3});
  const Vec3 edited = handAt("leftHand");
  act(session, RenameJoint{"leftHand", "paw"});
  EXPECT_TRUE(session.state().movement.clips[0].source) << "it still comes from the motion";
  EXPECT_LT((handAt("paw") - edited).norm(), 1e-6);
  const std::vector<Vec3f> raised = posedPositions(*session.state().rig, session.state().pose);
  act(session, SetHandles{40});
  const std::vector<Vec3f> now = posedPositions(*session.state().rig, session.state().pose);
  EXPECT_THAT(chosenJson(session)["keys"], ElementsAre(0.5)) << "the layer came along";
  double furthest = 0;
  for (std::size_t v = 0; v < now.size(); ++v) {
    furthest = std::max(furthest, static_cast<double>((now[v] - raised[v]).norm()));
  }
  EXPECT_LT(furthest, 0.3) << "metres: the arm is still up";
  act(session, Undo{});
  EXPECT_LT((handAt("paw") - edited).norm(), 1e-6);
}

TEST(Movement, RenamedJointsKeepTheirLimits) {
  Session session = person();
  act(session, SetLimits{R"({"limber_limits": 1, "joints": {"leftLowerLeg": {"type": "hinge", "x": [0, 30]}}})"});
  act(session, RenameJoint{"leftLowerLeg", "shin"});
  EXPECT_TRUE(sessionState(session)["limits"].contains("shin"));
  act(session, testing::turnedBy("shin", Vec3::UnitX(), 80));
  EXPECT_NEAR(turnOf(session, "shin").angularDistance(Quat::Identity()), 30 * EIGEN_PI / 180, 1e-6);
  EXPECT_THROW(act(session, RenameJoint{"shin", "head"}), Error);
  EXPECT_THROW(act(session, RenameJoint{"shin", ""}), Error);
  Session again;
  Progress progress;
  again.open(session.saveSession(), "again.glb", progress);
  EXPECT_TRUE(again.state().limits);
}

}  // namespace
}  // namespace limber
