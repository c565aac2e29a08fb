// limber batch, run as a user runs it.
#include <string>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

std::string batchPlan(const std::string& inputs) {
  return R"({"limber_batch": 1, "command": ["convert", "{input}", "-o", "{output}"], "output": ".glb", "inputs": [)" +
         inputs + "]}";
}

TEST_F(Cli, ABatchTellsByItsCodeWhoseFaultItIs) {
  makeRobot();
  put("plan.json", batchPlan(R"("robot.glb")"));
  EXPECT_EQ(run({"batch", "plan.json", "-o", "out", "--quiet"}).code, 0);
  put("failing.json", batchPlan(R"("robot.glb", {"path": "none.glb"})"));
  expectOneLine(run({"batch", "failing.json", "-o", "failing", "--quiet"}), 1);
  put("wrong.json", batchPlan(R"("none.glb")"));
  expectOneLine(run({"batch", "wrong.json", "-o", "wrong"}), 2);
  expectOneLine(run({"batch", "none.json", "-o", "wrong"}), 2);
  expectOneLine(run({"batch", "plan.json", "-o", "out", "--shard", "3/2"}), 2);
  put("a_file", "mine");
  expectOneLine(run({"batch", "plan.json", "-o", "a_file"}), 4);
}

TEST_F(Cli, ABatchBelowItsInputsHasTheSameEntriesAgain) {
  makeRobot();
  put("plan.json", batchPlan(R"(".")"));
  for (const char* told : {"1 entry: 1 run", "1 entry: 0 run"}) {
    const Result result = run({"batch", "plan.json", "-o", "out"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr(told));
  }
}

}  // namespace
}  // namespace limber
