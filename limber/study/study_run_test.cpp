// A shell script replaces the program: it imitates what each command writes, and fails with every error on demand.
#include "limber/study/study_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "limber/core/error.h"
#include "limber/study/report/cell_table.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kNoMemoryCode = 9;

// By model: what "rig" does. Every run of it is counted in the folder of the script.
constexpr std::string_view kProgram = R"sh(#!/bin/sh
home=$(dirname "$0")
case "$1" in
  info) case "$2" in *bare*) echo '{"weights": null}';; *unreadable*) exit 1;; *) echo '{"weights": {}}';; esac;;
  rig)
    echo "$*" >> "$home/runs"
    case "$2" in
      *crash*) kill -SEGV $$;;
      *hang*) sleep 100;;
      *hungry*) exit 9;;
      *refused*) echo "limber: $2: there is no triangle" >&2; exit 1;;
      *garbage*) echo '{"seconds":' > report.json; exit 0;;
    esac
    case "$*" in *curve-skeleton*) j=12;; *) j=22;; esac
    echo "{\"seconds\": 0.5, \"counts\": {\"joints\": $j}}" > report.json
    echo "$2" > rigged.glb;;
  evaluate)
    case "$2" in
      rig) echo '{"without_fingers": {"joint_to_joint": 3.5}}';;
      weights) echo '{"l1": 0.25}';;
      model) case "$*$(cat rigged.glb)" in *stiff*) echo '{"coverage": 0.75}';; *delta-mush*) echo '{"motion": {"stretch": 0.125}}';; *) echo '{"coverage": 0.75, "motion": {"stretch": 0.5}}';; esac;;
    esac;;
  preview)
    case "$4$(cat rigged.glb)" in stretch*stiff*) exit 1;; esac
    for name; do :; done; echo "picture of $4" > "$name";;
  sample) for name; do if [ "$before" = -o ]; then echo made > "$name"; fi; before=$name; done;;
esac
)sh";

class StudyRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    put("program", std::string(kProgram));
    fs::permissions(folder() / "program", fs::perms::owner_all);
    plan_.rig.combinations = {{"template", "bone-heat", {}}, {"own", "bone-heat", {}}};
    plan_.limits.seconds = 20;
    options_.program = folder() / "program";
    options_.planFolder = folder();
    options_.output = folder() / "report";
    options_.jobs = 4;
    options_.outOfMemoryCode = kNoMemoryCode;
  }

  const fs::path& folder() const { return folder_.path(); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(folder() / name) << text; }
  void addModels(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      put(name, "model " + name);
      plan_.rig.models.push_back(name);
    }
  }
  StudyResult run() const {
    Progress progress;
    return runStudy(plan_, options_, progress);
  }
  // How often a model was rigged since the last question.
  std::size_t runs() const {
    std::ifstream file(folder() / "runs");
    const auto count = std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    fs::remove(folder() / "runs");
    return static_cast<std::size_t>(count);
  }
  const CellResult& resultOf(const StudyResult& study, const std::string& model) const {
    for (std::size_t i = 0; i < study.cells.size(); ++i) {
      if (study.cells[i].model == model) return study.results[i];
    }
    ADD_FAILURE() << model;
    return study.results.front();
  }

  testing::TemporaryFolder folder_;
  StudyPlan plan_;
  StudyOptions options_;
};

TEST_F(StudyRuns, MeasuresEachCell) {
  addModels({"bare.obj", "fox.glb"});
  const StudyResult study = run();
  ASSERT_EQ(study.cells.size(), 3u);  // a bare model has no skeleton to keep
  EXPECT_EQ(study.ran, 3u);
  const CellResult& bare = study.results[0];
  EXPECT_EQ(bare.valueOf(findMeasure("joints")), 22);
  EXPECT_FALSE(bare.valueOf(findMeasure("joint_to_joint")));
  EXPECT_EQ(study.results[1].valueOf(findMeasure("joint_to_joint")), 3.5);
  EXPECT_EQ(study.results[2].valueOf(findMeasure("weight_l1")), 0.25);
  for (const CellResult& result : study.results) {
    EXPECT_EQ(result.outcome, JobOutcome::kDone) << result.problem;
    EXPECT_EQ(result.valueOf(findMeasure("coverage")), 0.75);
    EXPECT_TRUE(result.valueOf(findMeasure("seconds")));
    ASSERT_EQ(result.pictures.size(), 2u);
    for (const CellPicture& picture : result.pictures) EXPECT_TRUE(fs::exists(options_.output / picture.file));
  }
  EXPECT_TRUE(fs::is_empty(options_.output / ".limber-study"));
}

TEST_F(StudyRuns, ReportsHowManyCellsAreDone) {
  addModels({"bare.obj", "fox.glb"});  // three cells
  std::vector<StudyProgress> reports;
  options_.jobs = 1;
  options_.tell = [&](const StudyProgress& at) { reports.push_back(at); };
  run();
  ASSERT_EQ(reports.size(), 4u);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].cells, 3u);
    EXPECT_EQ(reports[i].done, i);
    EXPECT_EQ(reports[i].secondsLeft > 0, i == 1 || i == 2) << i;
  }
  reports.clear();
  run();
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].done, 3u);
}

TEST_F(StudyRuns, ACellThatEndsBadlySaysSo) {
  plan_.rig.combinations = {{"template", "bone-heat", {}}};
  addModels({"crash.glb", "hungry.glb", "refused.glb", "garbage.glb", "unreadable.glb", "fine.glb"});
  const StudyResult study = run();
  EXPECT_EQ(resultOf(study, "crash").outcome, JobOutcome::kCrashed);
  EXPECT_EQ(resultOf(study, "crash").problem, "rig: signal 11");
  EXPECT_EQ(resultOf(study, "hungry").outcome, JobOutcome::kOutOfMemory);
  EXPECT_EQ(resultOf(study, "refused").outcome, JobOutcome::kFailed);
  EXPECT_EQ(resultOf(study, "refused").problem, "rig: exit code 1: refused.glb: there is no triangle");
  EXPECT_EQ(resultOf(study, "garbage").outcome, JobOutcome::kFailed);
  EXPECT_THAT(resultOf(study, "garbage").problem, HasSubstr("rig: "));
  EXPECT_EQ(resultOf(study, "fine").outcome, JobOutcome::kDone);
  EXPECT_EQ(resultOf(study, "unreadable").outcome, JobOutcome::kDone);  // compared with nothing
  EXPECT_EQ(runs(), 6u);
  EXPECT_EQ(cellsCsv(run()), cellsCsv(study));
  EXPECT_EQ(runs(), 0u);
  options_.retries = true;
  EXPECT_EQ(run().ran, 4u);
}

TEST_F(StudyRuns, MoreTimeRunsAgainWhatRanOutOfIt) {
  plan_.rig.combinations = {{"template", "bone-heat", {}}};
  plan_.limits.seconds = 0.3;
  addModels({"hang.glb"});
  const StudyResult study = run();
  EXPECT_EQ(study.results[0].outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(study.results[0].problem, "rig: more than 0.3 s");
  EXPECT_EQ(run().ran, 0u);
  plan_.limits.seconds = 0.2;
  EXPECT_EQ(run().ran, 0u);
  plan_.limits.seconds = 0.4;
  EXPECT_EQ(run().results[0].problem, "rig: more than 0.4 s");
}

TEST_F(StudyRuns, GoesOnWhereItStopped) {
  addModels({"a.glb", "b.glb", "c.glb", "bare.obj"});
  const std::string table = cellsCsv(run());
  EXPECT_EQ(runs(), 7u);
  std::vector<fs::path> kept;
  for (const auto& entry : fs::directory_iterator(options_.output / "cells")) kept.push_back(entry.path());
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i < kept.size(); i += 2) fs::remove(kept[i]);
  put("report/cells/half.json.limber-part", "{");
  fs::create_directories(options_.output / ".limber-study" / "left");
  // What takes the script no time differs in its seconds alone.
  const auto withoutSeconds = [](const std::string& csv) {
    std::string rest;
    for (std::size_t at = 0; at < csv.size();) {
      const std::size_t end = csv.find('\n', at) + 1;
      const std::string line = csv.substr(at, end - at);
      if (line.find(",seconds,") == std::string::npos) rest += line;
      at = end;
    }
    return rest;
  };
  const StudyResult again = run();
  EXPECT_EQ(withoutSeconds(cellsCsv(again)), withoutSeconds(table));
  EXPECT_EQ(runs(), again.ran);
  EXPECT_GT(again.ran, 0u);
  EXPECT_LT(again.ran, 7u);
  EXPECT_TRUE(fs::is_empty(options_.output / ".limber-study"));
  EXPECT_EQ(run().ran, 0u);
}

TEST_F(StudyRuns, AnAddedMethodCostsItsOwnCells) {
  addModels({"a.glb", "b.glb"});
  plan_.rig.combinations.pop_back();
  EXPECT_EQ(run().ran, 2u);
  plan_.rig.combinations.push_back({"curve-skeleton", "bone-heat", {}});
  EXPECT_EQ(run().ran, 2u);
  put("b.glb", "changed");
  EXPECT_EQ(run().ran, 2u);
  plan_.rig.combinations.pop_back();
  EXPECT_EQ(run().ran, 0u);
  put("program", std::string(kProgram) + "# another version\n");
  EXPECT_EQ(run().ran, 2u);
}

TEST_F(StudyRuns, DamagedResultsRunAgain) {
  addModels({"a.glb"});
  EXPECT_EQ(run().ran, 2u);
  for (const auto& entry : fs::directory_iterator(options_.output / "cells")) {
    if (entry.file_size() > 10) std::ofstream(entry.path()) << R"({"limber_cell": 1, "pictures": ["../../x"]})";
  }
  EXPECT_EQ(run().ran, 2u);
  for (const auto& entry : fs::directory_iterator(options_.output / "pictures")) fs::remove(entry.path());
  EXPECT_EQ(run().ran, 2u);
  EXPECT_EQ(run().ran, 0u);
}

TEST_F(StudyRuns, ADeformerMakesItsOwnCells) {
  addModels({"fox.glb"});
  plan_.rig.combinations = {{"template", "bone-heat", {}}};
  plan_.rig.combinations[0].deformer = "linear-blend";
  EXPECT_EQ(run().ran, 1u);
  plan_.rig.combinations.push_back(plan_.rig.combinations[0]);
  plan_.rig.combinations[1].deformer = "delta-mush";
  const StudyResult study = run();
  EXPECT_EQ(study.ran, 1u);
  EXPECT_EQ(study.results[0].valueOf(findMeasure("stretch")), 0.5);
  EXPECT_EQ(study.results[1].valueOf(findMeasure("stretch")), 0.125);
  EXPECT_EQ(study.results[0].pictures.size(), 3u);
  ASSERT_EQ(study.results[1].pictures.size(), 1u);
  EXPECT_EQ(study.results[1].pictures[0].name, "stretch");
  EXPECT_THAT(cellsCsv(study), HasSubstr("fox,,template,bone-heat,delta-mush,,,,done,,stretch,0.125,share"));
}

// A body without a part that bends is no failure of its rig.
TEST_F(StudyRuns, WhatCannotBeBentHasNoPictureOfIt) {
  addModels({"stiff.glb"});
  plan_.rig.combinations = {{"template", "bone-heat", {}}};
  plan_.rig.combinations[0].deformer = "delta-mush";
  const StudyResult study = run();
  EXPECT_EQ(study.results[0].outcome, JobOutcome::kDone) << study.results[0].problem;
  EXPECT_EQ(study.results[0].pictures.size(), 2u);
  EXPECT_EQ(run().ran, 0u);
}

TEST_F(StudyRuns, AlikeCellsRunOnce) {
  addModels({"a.glb", "b.glb"});
  put("b.glb", "model a.glb");
  plan_.rig.combinations = {{"template", "bone-heat", {}}};
  const StudyResult study = run();
  EXPECT_EQ(runs(), 1u);
  EXPECT_EQ(study.results[0].measures.size(), study.results[1].measures.size());
}

TEST_F(StudyRuns, MakesItsSamples) {
  plan_.rig.models = {"sample:fox"};
  const StudyResult study = run();
  EXPECT_EQ(study.cells.size(), 2u);
  EXPECT_EQ(study.cells[0].model, "fox");
  EXPECT_TRUE(fs::exists(options_.output / "samples" / "fox.glb"));
}

TEST_F(StudyRuns, WhatIsMissingStopsItBeforeAnythingRuns) {
  addModels({"a.glb"});
  plan_.rig.models.push_back("missing.glb");
  EXPECT_THROW(run(), Error);
  EXPECT_EQ(runs(), 0u);
}

TEST_F(StudyRuns, AFolderWithOtherFilesIsLeftAlone) {
  addModels({"a.glb"});
  options_.output = folder();
  EXPECT_THROW(run(), Error);
  EXPECT_FALSE(fs::exists(folder() / "cells"));
  options_.output = folder() / "a.glb";
  EXPECT_THROW(run(), Error);
  fs::create_directories(folder() / "empty");
  options_.output = folder() / "empty";
  EXPECT_NO_THROW(run());
}

TEST(CellTable, QuotesAsCsvDoes) {
  StudyResult study;
  StudyCell cell;
  cell.model = "a,\"b\"\nc";
  cell.rigger = "template";
  study.cells = {cell, cell};
  study.results.resize(2);
  study.results[0].outcome = JobOutcome::kFailed;
  study.results[0].problem = "x";
  study.results[1].measures = {{&findMeasure("joints"), 3}};
  EXPECT_EQ(cellsCsv(study),
            "kind,group,model,motion,rigger,skinning,deformer,options,retargeting,solver,outcome,problem,measure,value,"
            "unit\r\n"
            "rig,,\"a,\"\"b\"\"\nc\",,template,,,,,,failed,x,,,\r\n"
            "rig,,\"a,\"\"b\"\"\nc\",,template,,,,,,done,,joints,3,\r\n");
  EXPECT_THAT(cellsJson(study), HasSubstr(R"("model": "a,\"b\"\nc")"));
}

}  // namespace
}  // namespace limber
