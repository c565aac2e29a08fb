#include "limber/study/report/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kHostile = "<script>alert('x')</script>\"&\xff";

StudyResult studyOf(const std::string& model, std::size_t pictures = 1) {
  StudyResult study;
  study.title = "Title <b>";
  for (const char* rigger : {"template", "sphere-mesh"}) {
    StudyCell cell;
    cell.model = model;
    cell.group = "people";
    cell.rigger = rigger;
    cell.skinning = "bone-heat";
    cell.steps = {{"rig", {"rig", model + ".glb"}, MeasureSource::kRigReport, {}, {}, true},
                  {"evaluate rig", {"evaluate"}, MeasureSource::kSkeletonTruth}};
    CellResult result;
    result.measures = {{&findMeasure("seconds"), 1.5}, {&findMeasure("joint_to_joint"), rigger[0] == 't' ? 2.5 : 3.25}};
    for (std::size_t i = 0; i < pictures; ++i) result.pictures.push_back({"bones", "bones.png"});
    study.cells.push_back(cell);
    study.results.push_back(result);
  }
  return study;
}

class ReportPage : public ::testing::Test {
 protected:
  void putPicture(std::size_t size) const {
    std::ofstream(folder_.path() / "bones.png", std::ios::binary) << std::string(size, 'p');
  }
  std::string pageOf(const StudyResult& study) const { return reportPage(study, folder_.path()); }

  testing::TemporaryFolder folder_;
};

TEST_F(ReportPage, RanksMethodsAndShowsCells) {
  putPicture(3);
  EXPECT_THAT(pageOf(studyOf("fox")),
              AllOf(HasSubstr("<title>Title &lt;b&gt;</title>"), HasSubstr("Ranking by joints to artist&#39;s joints"),
                    HasSubstr("template + bone-heat"), HasSubstr("2.5"), HasSubstr("limber rig fox.glb"),
                    HasSubstr("src=\"data:image/png;base64,cHBw\""), HasSubstr("loading=\"lazy\""),
                    HasSubstr("2 cells, of which 0 did not end well"), Not(HasSubstr("What did not end well"))));
}

TEST_F(ReportPage, ShowsWhatRanksNothingInATableOfItsOwn) {
  putPicture(3);
  StudyResult study = studyOf("fox");
  EXPECT_THAT(pageOf(study), Not(HasSubstr("rank nothing")));
  for (StudyCell& cell : study.cells) cell.steps.push_back({"evaluate model", {}, MeasureSource::kModel});
  study.results[0].measures.push_back({&findMeasure("volume_loss"), 0.125});
  EXPECT_THAT(pageOf(study),
              AllOf(HasSubstr("medians of measures that rank nothing"), Not(HasSubstr("Ranking by volume"))));
}

TEST_F(ReportPage, EscapesWhateverComesOutOfFiles) {
  putPicture(3);
  StudyResult study = studyOf(std::string(kHostile));
  study.results[1].outcome = JobOutcome::kFailed;
  study.results[1].problem = kHostile;
  study.title = kHostile;
  const std::string page = pageOf(study);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert"));
  EXPECT_THAT(page, Not(HasSubstr("\xff")));
  EXPECT_THAT(page, HasSubstr("What did not end well"));
}

TEST_F(ReportPage, HasABallotThatTellsNoMethod) {
  putPicture(3);
  const std::string page = pageOf(studyOf("fox"));
  const std::size_t begin = page.find("<section id=\"ballot\""), end = page.find("</section>", begin);
  ASSERT_NE(end, std::string::npos);
  EXPECT_THAT(page.substr(begin, end - begin), Not(HasSubstr("template")));
  EXPECT_THAT(page, AllOf(HasSubstr("data-kind=\"rig\" data-subject=\"fox\" data-method=\"template + bone-heat\""),
                          HasSubstr("data-picture=\"bones\""), Not(HasSubstr("Ranking by eye"))));
  EXPECT_EQ(pageOf(studyOf("fox")), page);
  // Other pictures have other votes.
  const auto keyOf = [](const std::string& text) { return text.substr(text.find("data-study="), 80); };
  EXPECT_NE(keyOf(pageOf(studyOf("hen"))), keyOf(page));
}

TEST_F(ReportPage, ShowsRankingsByEyeBesideTheMeasuredOnes) {
  putPicture(3);
  const Vote votes[] = {{"anna", CellKind::kRig, "fox", "template + bone-heat", "<b> + bone-heat", Choice::kFirst}};
  const std::vector<VoteRanking> byEye = rankByVotes(votes);
  const std::string page = reportPage(studyOf("fox"), folder_.path(), byEye);
  EXPECT_THAT(page, AllOf(HasSubstr("By eye (1 vote of 1 voter"), HasSubstr("Ranking by eye"), HasSubstr("by eye (%)"),
                          HasSubstr("Sign test"), HasSubstr("&lt;b&gt; + bone-heat"), Not(HasSubstr("<b> +"))));
}

// No server and no network: nothing but the tables and pictures beside the page is referred to.
TEST_F(ReportPage, ReachesForNothingElsewhere) {
  putPicture(3);
  const std::string page = pageOf(studyOf("fox"));
  for (const char* outside : {"http:", "https:", "src=\"//", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

TEST_F(ReportPage, StaysBelowFifteenMegabytes) {
  putPicture(1000000);
  const std::string embedded = pageOf(studyOf("fox", 4));
  EXPECT_THAT(embedded, HasSubstr("data:image/png"));
  EXPECT_LT(embedded.size(), 15000000u);
  const std::string beside = pageOf(studyOf("fox", 5));
  EXPECT_THAT(beside, Not(HasSubstr("data:image/png")));
  EXPECT_THAT(beside, HasSubstr("src=\"bones.png\""));
}

TEST_F(ReportPage, AStudyWithoutCellsIsAPageToo) {
  EXPECT_THAT(pageOf({}), HasSubstr("0 cells"));
}

}  // namespace
}  // namespace limber
