// limber study, run as a user runs it.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "limber/core/sanitizers.h"
#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Two cells of the smallest sample.
constexpr std::string_view kPlan = R"({
  "limber_study": 1,
  "title": "Stools",
  "rig": {
    "models": ["sample:stool"],
    "riggers": ["sphere-mesh", "prop"]
  },
  "limits": {"seconds": 100, "memory_mb": 4096}
})";

std::string withoutSeconds(const std::string& csv) {
  std::string rest;
  for (std::size_t at = 0; at < csv.size();) {
    const std::size_t end = csv.find('\n', at) + 1;
    const std::string line = csv.substr(at, end - at);
    if (line.find(",seconds,") == std::string::npos) rest += line;
    at = end;
  }
  return rest;
}

std::size_t keptCells(const fs::path& report) {
  std::error_code unseen;
  std::size_t count = 0;
  for (fs::directory_iterator it(report / "cells", unseen), end; !unseen && it != end; it.increment(unseen)) {
    count += it->path().extension() == ".json" ? 1 : 0;
  }
  return count;
}

TEST_F(Cli, AStudyIsTablesAndAPageAndGoesOnWhenKilled) {
  put("plan.json", std::string(kPlan));
  const Result study = run({"study", "plan.json", "-o", "report", "--jobs", "2"});
  EXPECT_EQ(study.code, 0) << study.error;
  EXPECT_THAT(study.error, ::testing::MatchesRegex("cell 1 of 2, about [0-9]+ s left\n"));
  EXPECT_THAT(study.out, AllOf(HasSubstr("2 cells: 2 run, 0 kept from before; 0 did not end well"),
                               HasSubstr("written: report/index.html")));
  const std::string csv = content("report/cells.csv");
  EXPECT_THAT(csv, AllOf(HasSubstr("rig,samples,stool,,sphere-mesh,bone-heat,"), HasSubstr(",done,,joints,")));
  EXPECT_THAT(content("report/index.html"),
              AllOf(HasSubstr("<title>Stools</title>"), HasSubstr("data:image/png;base64")));
  EXPECT_THAT(content("report/summary.md"), AllOf(HasSubstr("# Stools\n"), HasSubstr("| time (s) |")));
  const Result again = run({"study", "plan.json", "-o", "report", "--no-times"});
  EXPECT_THAT(again.out, HasSubstr("0 run, 2 kept from before"));
  EXPECT_EQ(content("report/cells.csv"), csv);
  const std::string summary = content("report/summary.md");
  EXPECT_THAT(summary, AllOf(HasSubstr("| sphere-mesh + bone-heat |"), ::testing::Not(HasSubstr("time (s)"))));

  Running killed({"study", "plan.json", "-o", "killed", "--jobs", "1", "--quiet"}, folder_);
  // Until a cell is kept besides what was read of the model.
  for (int i = 0; i < 6000 && keptCells(folder_ / "killed") < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  killed.signal(SIGKILL);
  EXPECT_EQ(killed.waitWithOpenInput().code, 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "killed/cells.csv"));
  const Result rest = run({"study", "plan.json", "-o", "killed", "--no-times"});
  EXPECT_EQ(rest.code, 0) << rest.error;
  EXPECT_THAT(rest.out, HasSubstr("1 run, 1 kept from before"));
  EXPECT_EQ(withoutSeconds(content("killed/cells.csv")), withoutSeconds(csv));
  EXPECT_EQ(content("killed/summary.md"), summary);
}

TEST_F(Cli, ARigIsMeasuredAndDrawnWithNothingToCompareItWith) {
  ASSERT_EQ(run({"sample", "robot", "-o", "robot.glb", "--quiet"}).code, 0);
  ASSERT_EQ(run({"rig", "robot.glb", "--template", "humanoid", "-o", "rigged.glb", "--quiet"}).code, 0);
  const Result text = run({"evaluate", "model", "rigged.glb"});
  EXPECT_EQ(text.code, 0) << text.error;
  EXPECT_THAT(text.out, AllOf(HasSubstr("joints "), HasSubstr("stretch ")));
  const Result json = run({"evaluate", "model", "rigged.glb", "--json"});
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"joints_inside\""), HasSubstr("\"pose\": \"elbows\"")));
  EXPECT_EQ(run({"preview", "rigged.glb", "--show", "stretch", "--size", "64x64", "-o", "stretch.png"}).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "stretch.png"));
  const Result dual = run({"evaluate", "model", "rigged.glb", "--deformer", "dual-quaternion"});
  EXPECT_EQ(dual.code, 0) << dual.error;
  EXPECT_THAT(dual.out, HasSubstr("by dual-quaternion"));
  const Result unknown = run({"evaluate", "model", "rigged.glb", "--deformer", "jelly"});
  expectOneLine(unknown, 1);
  EXPECT_THAT(unknown.error, AllOf(HasSubstr("'jelly'"), HasSubstr("delta-mush")));
  const auto sheet = [&](const char* name, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"preview", "rigged.glb", "--size", "32x32", "-o", name};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  };
  ASSERT_EQ(sheet("two.png", {"--show", "stretch", "--worst", "2"}).code, 0);
  ASSERT_EQ(sheet("all.png", {"--show", "stretch", "--worst", "400"}).code, 0);
  ASSERT_EQ(sheet("range.png", {"--show", "stretch"}).code, 0);
  EXPECT_LT(content("two.png").size(), content("all.png").size());
  EXPECT_EQ(content("all.png"), content("range.png"));
  expectOneLine(sheet("none.png", {"--worst", "2"}), 1);
  expectOneLine(run({"evaluate", "model", "robot.glb"}), 1);
  expectOneLine(run({"preview", "robot.glb", "--show", "stretch", "-o", "none.png"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
}

TEST_F(Cli, MeasuresAreComparedWithTheTruthByAStudysCells) {
  std::string rows;
  for (int method = 0; method < 3; ++method) {
    for (const std::string measure : {"stretch", "weight_l1"}) {
      rows += std::string(rows.empty() ? "" : ",") +
              R"({"kind": "rig", "group": "g", "model": "m", "rigger": "own", "options": "", "skinning": ")" +
              std::to_string(method) + R"(", "measure": ")" + measure + R"(", "value": )" + std::to_string(method) +
              "}";
    }
  }
  put("cells.json", R"({"title": "t", "cells": [)" + rows + "]}");
  const Result table = run({"evaluate", "measures", "cells.json"});
  EXPECT_EQ(table.code, 0) << table.error;
  EXPECT_THAT(table.out, HasSubstr("| `stretch` | 1.00 (1) |"));
  put("empty.json", R"({"cells": []})");
  put("other.json", "[1]");
  const Result other = run({"evaluate", "measures", "other.json"});
  expectOneLine(other, 1);
  EXPECT_THAT(other.error, HasSubstr("other.json"));
  expectOneLine(run({"evaluate", "measures", "empty.json", "-o", "table.md"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "table.md"));
}

TEST_F(Cli, AStudyIsInterruptedInOneLine) {
  put("plan.json", std::string(kPlan));
  Running running({"study", "plan.json", "-o", "report", "--jobs", "1"}, folder_);
  for (int i = 0; i < 6000 && !fs::exists(folder_ / "report/samples/stool.glb"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  running.signal(SIGINT);
  expectOneLine(running.waitWithOpenInput(), 130);
  EXPECT_FALSE(fs::exists(folder_ / "report/index.html"));
}

TEST_F(Cli, AStudysExampleIsAPlan) {
  const Result example = run({"study", "--example"});
  EXPECT_EQ(example.code, 0);
  EXPECT_THAT(example.out, HasSubstr("\"limber_study\": 1"));
  EXPECT_TRUE(files().empty());
}

TEST_F(Cli, AStudyThatCannotBeIsOneLineAndNoReport) {
  put("plan.json", std::string(kPlan));
  put("typo.json", R"({"limber_study": 1, "rig": {"modles": ["a.glb"]}})");
  put("missing.json", R"({"limber_study": 1, "rig": {"models": ["missing.glb"]}})");
  put("sample.json", R"({"limber_study": 1, "rig": {"models": ["sample:unicorn"]}})");
  const Result typo = run({"study", "typo.json", "-o", "report"});
  expectOneLine(typo, 1);
  EXPECT_THAT(typo.error, AllOf(HasSubstr("typo.json"), HasSubstr("rig"), HasSubstr("'modles'")));
  const Result missing = run({"study", "missing.json", "-o", "report"});
  expectOneLine(missing, 1);
  EXPECT_THAT(missing.error, HasSubstr("missing.glb"));
  const Result sample = run({"study", "sample.json", "-o", "report"});
  expectOneLine(sample, 1);
  EXPECT_THAT(sample.error, HasSubstr("'unicorn'"));
  expectOneLine(run({"study", "plan.json"}), 2);
  expectOneLine(run({"study", "-o", "report"}), 2);
  expectOneLine(run({"study", "plan.json", "-o", "report", "--jobs", "0"}), 2);
  expectOneLine(run({"study", "plan.json", "-o", "plan.json"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "report/index.html"));
}

// From what the program needs to begin to what it needs to end there is room for memory that does not suffice.
TEST_F(Cli, TooLittleMemoryHasACodeOfItsOwn) {
  if (kAddressSanitizer) GTEST_SKIP() << "which takes terabytes of addresses for itself";
  const auto codeWithin = [&](int megabytes) {
    const std::string command = "ulimit -d " + std::to_string(1024 * megabytes) +
                                "; exec '" LIMBER_PROGRAM "' sample stool -q -o '" + (folder_ / "stool.glb").string() +
                                "' 2>/dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  std::vector<int> codes;
  for (int megabytes = 4; megabytes < 40; megabytes += 4) codes.push_back(codeWithin(megabytes));
  EXPECT_THAT(codes, ::testing::Contains(3));
  EXPECT_EQ(codeWithin(4000), 0);
}

}  // namespace
}  // namespace limber
