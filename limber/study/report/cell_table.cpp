#include "limber/study/report/cell_table.h"

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

using Field = std::pair<const char*, std::string>;

std::vector<Field> fieldsOf(const StudyCell& cell, const CellResult& result) {
  return {{"kind", std::string(cellKindName(cell.kind))},
          {"group", cell.group},
          {"model", cell.model},
          {"motion", cell.motion},
          {"rigger", cell.rigger},
          {"skinning", cell.skinning},
          {"deformer", cell.deformer},
          {"options", cell.options},
          {"retargeting", cell.retargeting},
          {"solver", cell.solver},
          {"outcome", std::string(jobOutcomeName(result.outcome))},
          {"problem", result.problem}};
}

// Calls `row` for each cell and measure, with null where a cell has none.
void forEachRow(const StudyResult& study,
                const std::function<void(const std::vector<Field>&, const MeasuredValue*)>& row) {
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const std::vector<Field> fields = fieldsOf(study.cells[i], study.results[i]);
    if (study.results[i].measures.empty()) row(fields, nullptr);
    for (const MeasuredValue& value : study.results[i].measures) row(fields, &value);
  }
}

// A spreadsheet takes what begins like a formula for one, unless it is prefixed with an apostrophe.
std::string quoted(const std::string& field) {
  const bool isFormula = !field.empty() && std::string_view("=+-@\t\r").find(field.front()) != std::string_view::npos;
  const std::string text = isFormula ? "'" + field : field;
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string quotedText = "\"";
  for (const char c : text) quotedText += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quotedText + "\"";
}

}  // namespace

std::string cellsCsv(const StudyResult& study) {
  std::string names;
  for (const Field& field : fieldsOf({}, {})) names += std::string(field.first) + ",";
  std::string table = names + "measure,value,unit\r\n";
  forEachRow(study, [&](const std::vector<Field>& fields, const MeasuredValue* value) {
    for (const Field& field : fields) table += quoted(field.second) + ",";
    if (value) {
      table +=
          fmt::format("{},{},{}\r\n", value->measure->name, value->value, quoted(std::string(value->measure->unit)));
    } else {
      table += ",,\r\n";
    }
  });
  return table;
}

std::string cellsJson(const StudyResult& study) {
  Json rows = Json::array();
  forEachRow(study, [&](const std::vector<Field>& fields, const MeasuredValue* value) {
    Json row = Json::object();
    for (const Field& field : fields) row[field.first] = field.second;
    row["measure"] = value ? Json(value->measure->name) : Json(nullptr);
    row["value"] = value ? Json(value->value) : Json(nullptr);
    rows.push_back(std::move(row));
  });
  return dumpReport({{"title", study.title}, {"cells", std::move(rows)}}, 1) + "\n";
}

}  // namespace limber
