#include "limber/study/report/cell_table.h"

#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_text.h"
#include "limber/report/table.h"

namespace limber {

namespace {

// A line for each cell and measure; one without a measure where a cell has none.
Table cellTable(const StudyResult& study, bool hasUnits) {
  Table table{{words("kind"), words("group"), words("model"), words("motion"), words("rigger"), words("skinning"),
               words("deformer"), words("options"), words("retargeting"), words("solver"), words("outcome"),
               words("problem"), words("measure"), number("value")}};
  if (hasUnits) table.columns.push_back(words("unit"));
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const StudyCell& cell = study.cells[i];
    const CellResult& result = study.results[i];
    const auto add = [&](const MeasuredValue* one) {
      std::vector<Cell> cells = {cellKindName(cell.kind),
                                 cell.group,
                                 cell.model,
                                 cell.motion,
                                 cell.rigger,
                                 cell.skinning,
                                 cell.deformer,
                                 cell.options,
                                 cell.retargeting,
                                 cell.solver,
                                 jobOutcomeName(result.outcome),
                                 result.problem};
      cells.push_back(one ? Cell(one->measure->name) : Cell());
      cells.push_back(one ? Cell(one->value) : Cell());
      if (hasUnits) cells.push_back(one ? Cell(one->measure->unit) : Cell());
      table.add(std::move(cells));
    };
    if (result.measures.empty()) add(nullptr);
    for (const MeasuredValue& one : result.measures) add(&one);
  }
  return table;
}

}  // namespace

std::string cellsCsv(const StudyResult& study) {
  return toCsv(cellTable(study, true));
}

std::string cellsJson(const StudyResult& study) {
  return dumpReport({{"title", study.title}, {"cells", toJson(cellTable(study, false))}}, 1) + "\n";
}

}  // namespace limber
