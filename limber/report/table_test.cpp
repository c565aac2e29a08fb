#include "limber/report/table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

Table smallTable() {
  Table table{{words("file"), number("error", 2, " %"), significant("p", 3)}, "Errors:"};
  table.add({foreign("a|b"), 1.5, 0.012345}, "Words");
  table.add({"`c`", {}, 2});
  return table;
}

TEST(Table, MarkdownEscapesForeignWordsAndAlignsNumbers) {
  EXPECT_EQ(toMarkdown(smallTable()),
            "Errors:\n\n| file | error | p |\n| --- | ---: | ---: |\n| a\\|b | 1.50 % | 0.0123 |\n| `c` | - | 2 |\n");
  const Table noted{{words("")}, {}, "Below."};
  EXPECT_EQ(toMarkdown(std::vector{noted, noted}), "| |\n| --- |\n\nBelow.\n\n| |\n| --- |\n\nBelow.\n");
}

TEST(Table, HtmlHasTheWholeNumberToSortBy) {
  const std::string html = toHtml(smallTable());
  EXPECT_THAT(html, HasSubstr("<caption>Errors:</caption>"));
  EXPECT_THAT(html, HasSubstr("<tr data-words=\"words\"><td class=\"text\">a|b</td><td data-value=\"1.5\">1.50 %</td>"
                              "<td data-value=\"0.012345\">0.0123</td></tr>"));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"\">-</td>"));
  Table bad{{words("<model>"), number("error", 1)}};
  Cell model("<x>"), failed(std::numeric_limits<double>::infinity());
  model.target = "#cell-3";
  failed.text = "failed";
  failed.isBad = true;
  bad.add({model, failed});
  EXPECT_THAT(toHtml(bad), HasSubstr("<td class=\"text\"><a href=\"#cell-3\">&lt;x&gt;</a></td>"
                                     "<td data-value=\"Infinity\" class=\"bad\">failed</td>"));
}

TEST(Table, SeparatedValuesHaveNothingWhereThereIsNothing) {
  EXPECT_EQ(toTsv(smallTable()), "file\terror\tp\na|b\t1.50 %\t0.0123\n`c`\t\t2\n");
  Table table{{words("name"), number("value")}};
  table.add({"=a \"b\"", -0.1});
  EXPECT_EQ(toCsv(table), "name,value\r\n\"'=a \"\"b\"\"\",-0.1\r\n");
}

TEST(Table, JsonHasAnObjectForEachRow) {
  EXPECT_EQ(toJson(smallTable()), Json::parse(R"([{"file": "a|b", "error": 1.5, "p": 0.012345},
                                                  {"file": "`c`", "error": null, "p": 2.0}])"));
}

TEST(Table, RowsHaveAsManyCellsAsThereAreColumns) {
  Table table{{words("a"), words("b")}};
  EXPECT_THROW(table.add({"x"}), Error);
  const int numbers[] = {4};
  table.addAcross("x", numbers, [](int number) { return 2 * number; });
  EXPECT_EQ(toTsv(table), "a\tb\nx\t8\n");
}

}  // namespace
}  // namespace limber
