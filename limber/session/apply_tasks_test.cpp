#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/session/rigged_model.h"
#include "limber/session/session.h"
#include "limber/session/session_state.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

void tell(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Vec3 positionOf(const Session& session, Index joint) {
  return posePositions(session.state().rig->skeleton(), session.state().pose)[joint];
}

// Handles have no names, so joints are those of the rig, by number; what is met and what is not is told with the state.
TEST(ApplyTasks, MovesTheModelAndSaysWhatBecameOfEach) {
  Session session;
  tell(session, OpenSample{"biped"});
  const Skeleton& skeleton = session.state().rig->skeleton();
  const Index last = skeleton.jointCount() - 1;
  const std::string name = skeleton.joints[last].name;
  const Vec3 before = positionOf(session, last);
  tell(session, ApplyTasks{{"plane:" + name + "=above:0,1,0," + std::to_string(before.y() + 0.05),
                            "position:" + name + "=9,9,9@priority=1"}});
  EXPECT_GE(positionOf(session, last).y(), before.y() + 0.05 - 1e-3);
  const Json state = sessionState(session);
  ASSERT_EQ(state["tasks"].size(), 2u);
  EXPECT_EQ(state["tasks"][0]["met"], true);
  EXPECT_EQ(state["tasks"][1]["met"], false);
  EXPECT_THAT(state["tasks"][1]["outcome"].get<std::string>(), HasSubstr("the bones are too short"));
  EXPECT_EQ(session.undoName(), "apply_tasks");
  tell(session, ResetPose{});
  EXPECT_TRUE(sessionState(session)["tasks"].empty());
}

TEST(ApplyTasks, WhatIsHeldStays) {
  Session session;
  tell(session, OpenSample{"biped", true});
  ASSERT_FALSE(session.state().targets.empty());
  std::vector<Vec3> feet;
  for (const PinnedTarget& foot : session.state().targets) feet.push_back(foot.position);
  tell(session, ApplyTasks{{"balance=centred"}, true});
  for (std::size_t f = 0; f < feet.size(); ++f) {
    EXPECT_LT((positionOf(session, session.state().targets[f].joint) - feet[f]).norm(), 1e-3);
  }
}

// A key of the pose leaves it as it is; another moment of the clip does not.
TEST(ApplyTasks, OutcomesStayWithThePose) {
  Session session;
  tell(session, OpenSample{"biped"});
  tell(session, AddClip{"looking"});
  tell(session, ApplyTasks{{"balance=centred"}, true});
  tell(session, SetKey{});
  EXPECT_EQ(session.state().tasks.size(), 1u);
  tell(session, SetTime{1});
  EXPECT_TRUE(session.state().tasks.empty());
}

TEST(ApplyTasks, BadTasksAreRefusedAndNothingChanges) {
  Session session;
  tell(session, OpenSample{"biped"});
  const Pose before = session.state().pose;
  for (const char* task : {"stare:head=1,2,3", "look-at:nobody=1,2,3", ""}) {
    EXPECT_THROW(tell(session, ApplyTasks{{task}}), Error);
  }
  EXPECT_THROW(tell(session, ApplyTasks{}), Error);
  EXPECT_TRUE(samePose(session.state().pose, before));
}

}  // namespace
}  // namespace limber
