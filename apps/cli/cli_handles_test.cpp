// limber evaluate handles, as a user runs it, over the samples.
#include <string>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Handles : public Cli {
 protected:
  void make(const std::string& sample) { ASSERT_EQ(run({"sample", sample, "-o", sample + ".glb", "-q"}).code, 0); }
};

TEST_F(Handles, AreMeasuredAtEachCount) {
  for (const char* sample : {"quadruped", "winged", "robot"}) make(sample);
  const Result result = run({"evaluate", "handles", "quadruped.glb", "winged.glb", "robot.glb", "--counts", "8,20",
                             "--sheet", "sheet.png", "--moves", "moves.png", "-q"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, AllOf(HasSubstr("| quadruped | 8 |"), HasSubstr("| quadruped | 20 |"),
                                HasSubstr("| winged | 20 |"), HasSubstr("| robot | 8 |"), HasSubstr("**all 6**")));
  EXPECT_EQ(content("sheet.png").substr(1, 3), "PNG");
  EXPECT_EQ(content("moves.png").substr(1, 3), "PNG");
}

TEST_F(Handles, CountsAboveTheVerticesAreLeftOutAndSaid) {
  put("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Result result = run({"evaluate", "handles", "box.obj", "--counts", "3,9"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("| box | 3 |"));
  EXPECT_THAT(result.error, HasSubstr("fewer vertices than handles"));
}

TEST_F(Handles, RefuseAnUnknownRigger) {
  make("robot");
  EXPECT_THAT(run({"evaluate", "handles", "robot.glb", "--rigger", "magic"}).error, HasSubstr("magic"));
}

}  // namespace
}  // namespace limber
