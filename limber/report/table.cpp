#include "limber/report/table.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/report/escaped_text.h"

namespace limber {

namespace {

const NumberFormat& formatOf(const Column& column) {
  static constexpr NumberFormat kAllDigits = {};
  return column.numbers ? *column.numbers : kAllDigits;
}

std::string textOf(const Column& column, const Cell& cell, std::string_view nothing) {
  if (cell.text) return *cell.text;
  return cell.number ? formatted(*cell.number, formatOf(column)) : std::string(nothing);
}

void addMarkdown(std::string_view text, std::string& line) {
  line += text.empty() ? std::string(" |") : fmt::format(" {} |", text);
}

std::string htmlCell(const Column& column, const Cell& cell) {
  std::string text = htmlText(textOf(column, cell, "-"));
  if (!cell.target.empty()) text = fmt::format("<a href=\"{}\">{}</a>", cell.target, text);
  if (!column.numbers) return fmt::format("<td class=\"text{}\">{}</td>", column.wraps ? " wrap" : "", text);
  std::string value;  // as JavaScript reads it
  if (cell.number && std::isfinite(*cell.number)) value = formatted(*cell.number, {});
  if (cell.number && std::isinf(*cell.number)) value = *cell.number < 0 ? "-Infinity" : "Infinity";
  return fmt::format("<td data-value=\"{}\"{}>{}</td>", value, cell.isBad ? " class=\"bad\"" : "", text);
}

std::string quoted(const std::string& field) {
  const bool isFormula = !field.empty() && std::string_view("=+-@\t\r").find(field.front()) != std::string_view::npos;
  const std::string text = isFormula ? "'" + field : field;
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string quotedText = "\"";
  for (const char c : text) quotedText += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quotedText + "\"";
}

// Only words are quoted: a number may well begin with a minus.
std::string separated(const Table& table, std::string_view separator, std::string_view lineEnd,
                      std::string (*quote)(const std::string&)) {
  std::string text;
  const auto addLine = [&](const auto& fieldOf) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text += fmt::format("{}{}", c == 0 ? "" : separator, fieldOf(c));
    }
    text += lineEnd;
  };
  addLine([&](std::size_t c) { return table.columns[c].name; });
  for (const TableRow& row : table.rows) {
    addLine([&](std::size_t c) {
      const Cell& cell = row.cells[c];
      return cell.text ? quote(*cell.text) : textOf(table.columns[c], cell, {});
    });
  }
  return text;
}

}  // namespace

std::string formatted(double number, const NumberFormat& format) {
  switch (format.kind) {
    case NumberFormat::Digits::kDecimals:
      return fmt::format("{:.{}f}{}", number, format.digits, format.unit);
    case NumberFormat::Digits::kSignificant:
      return fmt::format("{:.{}g}{}", number, format.digits, format.unit);
    case NumberFormat::Digits::kAll:
      break;
  }
  return fmt::format("{}{}", number, format.unit);
}

Column words(std::string name) {
  return {std::move(name)};
}

Column number(std::string name, int digits, std::string_view unit) {
  return {std::move(name), decimals(digits, unit)};
}

Column number(std::string name) {
  return {std::move(name), NumberFormat{}};
}

Column significant(std::string name, int digits) {
  return {std::move(name), NumberFormat{NumberFormat::Digits::kSignificant, digits}};
}

Cell foreign(std::string_view words) {
  Cell cell(words);
  cell.isForeign = true;
  return cell;
}

void Table::add(std::vector<Cell> cells, std::string words) {
  if (cells.size() != columns.size()) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("{} cells in a table of {} columns", cells.size(), columns.size()));
  }
  rows.push_back({std::move(cells), std::move(words)});
}

std::string toMarkdown(const Table& table) {
  std::string text = table.caption.empty() ? "|" : table.caption + "\n\n|", rule = "|";
  for (const Column& column : table.columns) {
    addMarkdown(column.name, text);
    addMarkdown(column.numbers ? "---:" : "---", rule);
  }
  text += "\n" + rule + "\n";
  for (const TableRow& row : table.rows) {
    text += "|";
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      const std::string words = textOf(table.columns[c], row.cells[c], "-");
      addMarkdown(row.cells[c].isForeign ? markdownText(words) : words, text);
    }
    text += "\n";
  }
  return table.note.empty() ? text : text + "\n" + table.note + "\n";
}

std::string toMarkdown(std::span<const Table> tables) {
  std::string text;
  for (const Table& table : tables) {
    if (!text.empty()) text += "\n";
    text += toMarkdown(table);
  }
  return text;
}

std::string toHtml(const Table& table) {
  std::string html = fmt::format(
      "<div class=\"scroll\" role=\"group\" tabindex=\"0\" "
      "aria-label=\"{0}\"><table><caption>{0}</caption><thead><tr>",
      htmlText(table.caption));
  for (const Column& column : table.columns) {
    html += fmt::format("<th scope=\"col\" aria-sort=\"none\"{}><button type=\"button\">{}</button></th>",
                        column.numbers ? "" : " class=\"text\"", htmlText(column.name));
  }
  html += "</tr></thead><tbody>\n";
  for (const TableRow& row : table.rows) {
    html += fmt::format("<tr data-words=\"{}\">", htmlText(lowerCase(row.words)));
    for (std::size_t c = 0; c < row.cells.size(); ++c) html += htmlCell(table.columns[c], row.cells[c]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string toTsv(const Table& table) {
  return separated(table, "\t", "\n", [](const std::string& field) { return field; });
}

std::string toCsv(const Table& table) {
  return separated(table, ",", "\r\n", quoted);
}

Json toJson(const Table& table) {
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    Json& object = rows.emplace_back(Json::object());
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      const Cell& cell = row.cells[c];
      object[table.columns[c].name] = cell.number ? Json(*cell.number) : cell.text ? Json(*cell.text) : Json(nullptr);
    }
  }
  return rows;
}

}  // namespace limber
