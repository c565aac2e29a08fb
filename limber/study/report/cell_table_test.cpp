#include "limber/study/report/cell_table.h"

#include <gmock/gmock.h>

namespace limber {
namespace {

TEST(CellTable, NamesAreNoFormulasToASpreadsheet) {
  StudyResult study;
  StudyCell cell;
  cell.model = "=HYPERLINK(\"http://evil.example\").glb";
  cell.motion = "@sum.bvh";
  cell.group = "plain";
  study.cells = {cell};
  study.results.resize(1);
  const std::string table = cellsCsv(study);
  EXPECT_THAT(table, ::testing::HasSubstr(",plain,\"'=HYPERLINK(\"\"http://evil.example\"\").glb\",'@sum.bvh,"));
}

}  // namespace
}  // namespace limber
