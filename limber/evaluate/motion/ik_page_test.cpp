#include "limber/evaluate/motion/ik_page.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

IkScore score(const char* method, const char* set, Index solved, double micros, bool limited = false) {
  IkScore result;
  result.method = method;
  result.set = set;
  result.problems = 8;
  result.solved = solved;
  result.medianMicros = micros;
  result.limited = limited;
  return result;
}

std::vector<IkScore> someScores() {
  return {score("fabrik", "chain-3 reachable", 8, 1), score("fabrik", "chain-10 reachable", 6, 10),
          score("dls", "chain-10 reachable", 2, 100), score("dls", "chain-10 reachable limits", 7, 55, true),
          score("fabrik", "chain-10 millionth", 8, 2.5)};
}

std::size_t count(const std::string& text, std::string_view word) {
  std::size_t result = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++result;
  return result;
}

TEST(IkPage, ThePlotOfWhatIsSolvedHasAFieldForEachScore) {
  const std::string svg = ikSolvedPlot(someScores());
  EXPECT_EQ(count(svg, "<rect"), 1u + 5u) << "background and fields";
  for (const char* words : {">75.0<", ">25.0<", ">87.5<", "chain-10 reachable limits", ">fabrik<"}) {
    EXPECT_THAT(svg, HasSubstr(words));
  }
  EXPECT_EQ(count(svg, "<text"), count(svg, "</text>"));
}

TEST(IkPage, SlowerIsHigherInThePlotOfTimes) {
  const auto heightOf = [](double micros) {
    const std::vector<IkScore> one = {score("dls", "chain-10 reachable", 8, micros)};
    const std::string svg = ikTimePlot(one);
    const std::size_t at = svg.find("cy=\"");
    return std::stod(svg.substr(at + 4));
  };
  EXPECT_GT(heightOf(1), heightOf(30));
  EXPECT_GT(heightOf(30), heightOf(1000));
  EXPECT_NEAR(heightOf(1) - heightOf(10), heightOf(100) - heightOf(1000), 0.2);
}

TEST(IkPage, ThePageNamesTheBestAndSetsAimsBesideFigures) {
  const std::string page = ikPage(someScores(), "images");
  EXPECT_THAT(page, HasSubstr("**Best with limits: dls.**"));
  EXPECT_THAT(page, HasSubstr("(images/ik_solved.svg)"));
  EXPECT_THAT(page, HasSubstr("| 10 joints to a millionth | fabrik | 3 µs | 2.50 µs, 100.0 % solved | 3.5 µs |"));
  EXPECT_THAT(page, Not(HasSubstr("two-bone"))) << "which was not run";
  EXPECT_THAT(ikPage(someScores(), ""), HasSubstr("(ik_solved.svg)"));
}

}  // namespace
}  // namespace limber
