#include "limber/batch/batch_task.h"

#include <gtest/gtest.h>

#include <fstream>

#include "limber/jobs/own_program.h"
#include "temporary_folder.h"

namespace limber {
namespace {

TEST(BatchTask, PlannedOutputsComeBackFromTheirText) {
  BatchPlan plan;
  plan.command = {"rig"};
  plan.entries = {{"a.obj", "a.glb", {}, {}}, {"b.obj", "b.glb", {}, {"--handles", "9"}}, {"c.obj", "c.glb", {}, {}}};
  BatchTasks tasks(plan, ownProgram());
  const PlannedOutputs planned = plannedOutputs(plan, tasks);
  EXPECT_EQ(planned.taskOf(2), planned.task);
  EXPECT_NE(planned.taskOf(1), planned.task);
  const PlannedOutputs back = parsePlannedOutputs(plannedOutputsText(planned));
  EXPECT_EQ(back.outputs, planned.outputs);
  EXPECT_EQ(back.task, planned.task);
  EXPECT_EQ(back.others, planned.others);
  EXPECT_EQ(parsePlannedOutputs(R"({"limber_batch": 1, "outputs": ["a.glb"]})").taskOf(0), "");
  for (const char* wrong : {"", "{}", R"({"limber_batch": 1, "outputs": [1]})",
                            R"({"limber_batch": 1, "outputs": [], "tasks": [[0, "a"]]})"}) {
    EXPECT_THROW(parsePlannedOutputs(wrong), Error) << wrong;
  }
}

TEST(BatchTask, DependsOnWhereOptionsBegin) {
  BatchPlan plan;
  plan.command = {"rig", "--quiet"};
  BatchTasks tasks(plan, ownProgram());
  BatchPlan shorter;
  shorter.command = {"rig"};
  EXPECT_NE(tasks.of({}).digest, BatchTasks(shorter, ownProgram()).of({{}, {}, {}, {"--quiet"}}).digest);
}

// So that a changed adapter runs anew.
TEST(BatchTask, DependsOnTheAdaptersThatItNames) {
  const testing::TemporaryFolder folder;
  BatchPlan plan;
  plan.folder = "/";
  plan.command = {"rig", "--rigger", "mine"};
  const auto digest = [&](const std::string& adapter) {
    std::ofstream(folder.path() / "mine.json") << adapter;
    return BatchTasks(plan, ownProgram(), {folder.path()}).of({}).digest;
  };
  const std::string first = digest("one");
  EXPECT_EQ(digest("one"), first);
  EXPECT_NE(digest("two"), first);
}

}  // namespace
}  // namespace limber
