#include "limber/evaluate/skin/weight_table.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kReferences =
    "# a comment\n"
    "file\tgroup\tmade\tl1\tl1_nearest\tdeform\tdeform_nearest\n"
    "robot\tpieces\tartist\t0.5\t0.7\t1.5\t2\n"
    "fox\tother\theat\t0.1\t0.6\t0.25\t0.5\n";

WeightTableRow row(const char* file, double l1, double deform) {
  WeightTableRow result;
  result.file = file;
  result.comparison.l1 = l1;
  result.comparison.deformMean = deform;
  return result;
}

TEST(WeightReferences, AreReadLineByLine) {
  const std::vector<WeightReference> references = parseWeightReferences(kReferences);
  ASSERT_EQ(references.size(), 2u);
  EXPECT_EQ(references[0].file, "robot");
  EXPECT_TRUE(references[0].manyPieces);
  EXPECT_FALSE(references[0].madeByHeat);
  EXPECT_EQ(references[0].deform, 1.5);
  EXPECT_FALSE(references[1].manyPieces);
  EXPECT_TRUE(references[1].madeByHeat);
  EXPECT_EQ(references[1].l1Nearest, 0.6);
}

TEST(WeightReferences, BrokenLineIsNamed) {
  for (const char* bad : {"fox\tother\theat\t0.1\t0.6\t0.25\n", "fox\tother\theat\t0.1\t0.6x\t0.25\t0.5\n",
                          "fox\tother\theat\tnan\t0.6\t0.25\t0.5\n"}) {
    try {
      parseWeightReferences(std::string(kReferences) + bad);
      FAIL() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "line 5");
    }
  }
}

TEST(WeightMethodTable, HasALineForEachFolderAndMethod) {
  std::vector<MethodRows> methods = {{"heat", {row("a", 0.2, 1), row("b", 0.4, 2)}},
                                     {"voxel", {row("a", 0.6, 3), row("b", 1, 5)}}};
  for (MethodRows& method : methods) {
    method.rows[0].folder = "tune";
    method.rows[1].folder = "check";
  }
  const std::string table = toMarkdown(weightMethodTable(methods));
  EXPECT_THAT(table, HasSubstr("| tune (1) | heat | 0.200 |"));
  EXPECT_THAT(table, HasSubstr("| check (1) | voxel | 1.000 | 1.00 | 1.00 | 5.000 | 5.000 |"));
}

TEST(WeightTable, MeansCompareTheSameFilesOnly) {
  const std::vector<WeightTableRow> rows = {row("fox", 0.2, 0.3), row("robot", 0.4, 0.5), row("stranger", 1, 8)};
  const std::string table = toMarkdown(weightTables(rows, parseWeightReferences(kReferences)));
  EXPECT_THAT(table, HasSubstr("| all that Blender was measured on | 2 | 0.300 | 0.300 | 0.400 | 0.875 |"));
  EXPECT_THAT(table, HasSubstr("| of many pieces | 1 | 0.400 | 0.500 | 0.500 | 1.500 |"));
  EXPECT_THAT(table, HasSubstr("| without figures of Blender | 1 | 1.000 | - | 8.000 | - |"));
  std::vector<WeightTableRow> more = rows;
  for (const char* folder : {"tune", "check"}) {
    more.push_back(row("beast", 0.5, 2));
    more.back().folder = folder;
  }
  const std::string byFolder = toMarkdown(weightTables(more, parseWeightReferences(kReferences)));
  EXPECT_THAT(byFolder, HasSubstr("| without figures of Blender, tune | 1 | 0.500 | - | 2.000 |"));
  EXPECT_THAT(byFolder, HasSubstr("| without figures of Blender, check | 1 | 0.500 | - | 2.000 |"));
  EXPECT_THAT(table, HasSubstr("| fox * |"));
  EXPECT_THAT(table, HasSubstr("| robot |"));
}

TEST(WeightTable, EveryLineHasTheColumnsOfItsHead) {
  const std::vector<WeightTableRow> rows = {row("fox", 0.2, 0.3), row("stranger", 1, 8)};
  const std::string table = toMarkdown(weightTables(rows, parseWeightReferences(kReferences)));
  std::vector<std::ptrdiff_t> bars;
  for (std::size_t begin = 0; begin < table.size();) {
    const std::size_t end = table.find('\n', begin);
    bars.push_back(std::count(table.begin() + begin, table.begin() + end, '|'));
    begin = end + 1;
  }
  const auto gap = std::find(bars.begin(), bars.end(), 0);
  ASSERT_NE(gap, bars.end());
  for (auto it = bars.begin(); it != gap; ++it) EXPECT_EQ(*it, 11);
  for (auto it = gap + 1; it != bars.end(); ++it) EXPECT_EQ(*it, 15);
}

TEST(WeightTable, WithoutReferencesThereAreNoFiguresOfOthers) {
  const std::vector<WeightTableRow> rows = {row("fox", 0.2, 0.3)};
  EXPECT_THAT(toMarkdown(weightTables(rows, {})), Not(HasSubstr("all that Blender")));
}

TEST(CompareFolder, MissingFolderIsAnError) {
  Progress progress;
  Warnings skipped;
  EXPECT_THROW(compareFolder(
                   "/no/such/folder", [](Asset&) {}, progress, skipped),
               Error);
}

}  // namespace
}  // namespace limber
