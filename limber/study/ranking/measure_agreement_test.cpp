// Ranks that are known, and studies made of a few rows.
#include "limber/study/ranking/measure_agreement.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/random.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

TEST(RankCorrelation, OfTheSameOrderIsOneAndOfTheOppositeMinusOne) {
  const std::vector<double> a = {3, 1, 2, 10}, same = {0.3, 0.1, 0.2, 0.4}, opposite = {-3, -1, -2, -10};
  EXPECT_NEAR(rankCorrelation(a, same).value(), 1, 1e-12);
  EXPECT_NEAR(rankCorrelation(a, opposite).value(), -1, 1e-12);
}

// Without ties it is 1 - 6 sum d^2 / (n (n^2 - 1)).
TEST(RankCorrelation, IsSpearmansClosedForm) {
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    std::vector<double> a, b;
    for (int k = 0; k < 12; ++k) {
      a.push_back(random.uniform());
      b.push_back(random.uniform());
    }
    double squares = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const auto rankOf = [k](const std::vector<double>& values) {
        return static_cast<double>(
            std::count_if(values.begin(), values.end(), [&](double v) { return v < values[k]; }));
      };
      squares += (rankOf(a) - rankOf(b)) * (rankOf(a) - rankOf(b));
    }
    EXPECT_NEAR(rankCorrelation(a, b).value(), 1 - 6 * squares / (12 * (144 - 1)), 1e-12);
  }
}

TEST(RankCorrelation, TiesHaveMeanRanks) {
  // Ranks 0.5 0.5 2 and 0 1 2: covariance 1.5, variances 1.5 and 2.
  EXPECT_NEAR(rankCorrelation(std::vector<double>{1, 1, 5}, std::vector<double>{1, 2, 3}).value(), 1.5 / std::sqrt(3.0),
              1e-12);
  EXPECT_FALSE(rankCorrelation(std::vector<double>{1, 1, 1}, std::vector<double>{1, 2, 3}));
  EXPECT_FALSE(rankCorrelation({}, {}));
  EXPECT_THROW(rankCorrelation(std::vector<double>{1}, {}), Error);
}

Json rowOf(const std::string& model, const std::string& skinning, const std::string& measure, double value) {
  return {{"kind", "rig"},        {"group", "g"},  {"model", model},     {"rigger", "own"},
          {"skinning", skinning}, {"options", ""}, {"measure", measure}, {"value", value}};
}

// Of methods a, b, ... the values of two measures.
Json study(const std::string& model, const std::string& first, const std::vector<double>& values,
           const std::string& second, const std::vector<double>& others) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    rows.push_back(rowOf(model, std::string(1, static_cast<char>('a' + i)), first, values[i]));
    rows.push_back(rowOf(model, std::string(1, static_cast<char>('a' + i)), second, others[i]));
  }
  return {{"title", "t"}, {"cells", rows}};
}

TEST(MeasureAgreement, IsTheMeanOverModelsOfWhatIsBetter) {
  const Json cells[] = {study("m", "stretch", {1, 2, 3}, "weight_l1", {0.1, 0.2, 0.3}),
                        study("n", "stretch", {1, 2, 3}, "weight_l1", {0.1, 0.3, 0.2})};
  const std::vector<MeasureAgreement> agreements = measureAgreement(cells);
  ASSERT_EQ(agreements.size(), 1u);
  EXPECT_EQ(agreements[0].measure->name, "stretch");
  EXPECT_EQ(agreements[0].truth->name, "weight_l1");
  EXPECT_EQ(agreements[0].models, 2u);
  EXPECT_NEAR(agreements[0].correlation, 0.75, 1e-12);
  EXPECT_THAT(toMarkdown(agreementTable(agreements)), HasSubstr("| `stretch` | 0.75 (2) |"));
}

// More coverage is better, more distance is worse.
TEST(MeasureAgreement, KnowsWhichSideIsBetter) {
  const Json cells[] = {study("m", "coverage", {0.9, 0.8, 0.7}, "joint_to_joint", {1, 2, 3})};
  EXPECT_NEAR(measureAgreement(cells).at(0).correlation, 1, 1e-12);
}

// Only the first deformer of a rig is compared with the artist's; the others' figures do not replace it.
TEST(MeasureAgreement, FurtherDeformersDoNotMix) {
  Json cells = study("m", "stretch", {1, 2, 3}, "weight_l1", {0.1, 0.2, 0.3});
  for (Json& row : cells["cells"]) row["deformer"] = "linear-blend";
  for (int i = 0; i < 3; ++i) {
    Json row = rowOf("m", std::string(1, static_cast<char>('a' + i)), "stretch", 3 - i);
    row["deformer"] = "delta-mush";
    cells["cells"].push_back(row);
  }
  const Json all[] = {cells};
  EXPECT_NEAR(measureAgreement(all).at(0).correlation, 1, 1e-12);
}

TEST(MeasureAgreement, TwoMethodsOrOnesAlikeSayNothing) {
  const Json two[] = {study("m", "stretch", {1, 2}, "weight_l1", {1, 2})};
  EXPECT_TRUE(measureAgreement(two).empty());
  const Json alike[] = {study("m", "joints_inside", {1, 1, 1}, "weight_l1", {1, 2, 3})};
  EXPECT_TRUE(measureAgreement(alike).empty());
}

TEST(MeasureAgreement, OtherDocumentsAreErrors) {
  for (const Json& bad : {Json::array(), Json{{"cells", 3}}, Json{{"cells", Json::array({{{"kind", 5}}})}}}) {
    const Json cells[] = {bad};
    EXPECT_THROW(measureAgreement(cells), Error);
  }
  const Json none[] = {Json{{"cells", Json::array({3, nullptr})}}};
  EXPECT_TRUE(measureAgreement(none).empty());
}

}  // namespace
}  // namespace limber
