// Measures in rows and columns, and the forms in which they are written. What measures fills a Table; how Markdown, HTML
// and separated values look is known here alone.
#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/document/asset.h"

namespace limber {

// How the numbers of a column are written.
struct NumberFormat {
  enum class Digits { kDecimals, kSignificant, kAll };

  Digits kind = Digits::kAll;  // kAll: as many as tell the number from all others
  int digits = 0;              // of kDecimals behind the point
  std::string_view unit = {};  // after each number, with the space before it: " %"
};
constexpr NumberFormat decimals(int digits, std::string_view unit = {}) {
  return {NumberFormat::Digits::kDecimals, digits, unit};
}
std::string formatted(double number, const NumberFormat& format);

struct Column {
  std::string name;
  std::optional<NumberFormat> numbers = {};  // none: a column of words, which are aligned to the left
  bool wraps = false;                        // in HTML: words that are long enough for several lines
};
Column words(std::string name);
// With so many digits behind the point; with all that it has.
Column number(std::string name, int decimals, std::string_view unit = {});
Column number(std::string name);
Column significant(std::string name, int digits);

// Words, or a number in its column's format, or nothing: "-" for people, empty among separated values, null in JSON.
struct Cell {
  Cell() = default;
  Cell(std::string words) : text(std::move(words)) {}
  Cell(std::string_view words) : text(words) {}
  Cell(const char* words) : text(words) {}
  template <typename Number>
  requires(std::integral<Number> || std::floating_point<Number>) Cell(Number value)
      : number(static_cast<double>(value)) {}
  Cell(const std::optional<double>& value) : number(value) {}

  std::optional<std::string> text;  // shown instead of the number where there are both
  std::optional<double> number;
  bool isForeign = false;   // the words come out of a file or a plan, so Markdown escapes them; HTML escapes all words
  bool isBad = false;       // in HTML: in the color of what failed
  std::string target = {};  // in HTML: what the words link to, "#cell-3"
};

// Words out of a file or a plan.
Cell foreign(std::string_view words);

struct TableRow {
  std::vector<Cell> cells;  // one for each column
  std::string words;        // in HTML: by which a reader filters rows
};

struct Table {
  std::vector<Column> columns = {};
  std::string caption = {};  // above it
  std::string note = {};     // below it
  std::vector<TableRow> rows = {};

  // Throws Error kBadArgument where there are not as many cells as columns.
  void add(std::vector<Cell> cells, std::string words = {});
  // A row of one cell, then those that `cellOf` makes of the elements.
  template <typename Elements, typename CellOf>
  void addAcross(Cell first, const Elements& elements, const CellOf& cellOf) {
    std::vector<Cell> cells = {std::move(first)};
    for (const auto& element : elements) cells.push_back(cellOf(element));
    add(std::move(cells));
  }
};

std::string toMarkdown(const Table& table);
// One below the other.
std::string toMarkdown(std::span<const Table> tables);
// A section of a page that scrolls on its own; columns are sorted by their heads (page_assets.h).
std::string toHtml(const Table& table);
// Tab separated lines below a line of names.
std::string toTsv(const Table& table);
// Likewise by RFC 4180. Words that a spreadsheet would take for a formula get an apostrophe in front.
std::string toCsv(const Table& table);
// An array with an object for each row, with all digits.
Json toJson(const Table& table);

}  // namespace limber
