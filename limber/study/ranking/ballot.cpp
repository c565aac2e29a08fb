#include "limber/study/ranking/ballot.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 6> kColumns = {"voter", "kind", "subject", "first", "second", "choice"};

[[noreturn]] void failAt(std::size_t line, const std::string& message) {
  throw Error(ErrorCode::kBadData, message, fmt::format("line {}", line),
              "use the votes.csv that a study's page saves");
}

struct CsvRecord {
  std::size_t line = 0;  // that it begins in, from 1
  std::vector<std::string> fields;
};

class CsvReader {
 public:
  explicit CsvReader(std::string_view text) : text_(text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  }

  // The next record that is no empty line.
  std::optional<CsvRecord> next() {
    while (at_ < text_.size()) {
      CsvRecord record{line_, {}};
      do {
        record.fields.push_back(peek() == '"' ? quotedField() : plainField());
      } while (skip(','));
      endLine();
      if (record.fields.size() > 1 || !record.fields.front().empty()) return record;
    }
    return std::nullopt;
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  bool skip(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string plainField() {
    const std::size_t end = std::min(text_.find_first_of(",\r\n\"", at_), text_.size());
    if (end < text_.size() && text_[end] == '"') failAt(line_, "a quotation mark stands within a field without any");
    const std::size_t begin = std::exchange(at_, end);
    return std::string(text_.substr(begin, end - begin));
  }

  std::string quotedField() {
    const std::size_t begin = line_;
    std::string field;
    ++at_;
    while (at_ < text_.size()) {
      if (skip('"')) {
        if (!skip('"')) return field;
        field += '"';
        continue;
      }
      if (text_[at_] == '\n') ++line_;
      field += text_[at_++];
    }
    failAt(begin, "a field's quotation mark is not closed");
  }

  void endLine() {
    if (at_ >= text_.size()) return;
    skip('\r');
    if (!skip('\n') && at_ < text_.size()) failAt(line_, "a field goes on after its quotation mark");
    ++line_;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

using ColumnIndices = std::array<std::size_t, kColumns.size()>;

ColumnIndices findColumns(const CsvRecord& head) {
  ColumnIndices columnIndices = {};
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const auto found = std::find(head.fields.begin(), head.fields.end(), kColumns[c]);
    if (found == head.fields.end()) failAt(head.line, fmt::format("no column is called \"{}\"", kColumns[c]));
    columnIndices[c] = static_cast<std::size_t>(found - head.fields.begin());
  }
  return columnIndices;
}

CellKind kindNamed(const std::string& name, std::size_t line) {
  for (const CellKind kind : {CellKind::kRig, CellKind::kRetarget}) {
    if (name == cellKindName(kind)) return kind;
  }
  failAt(line, fmt::format("\"{}\" is no kind (rig, retarget)", name));
}

Choice choiceNamed(const std::string& name, std::size_t line) {
  if (name == "first") return Choice::kFirst;
  if (name == "second") return Choice::kSecond;
  if (name == "alike") return Choice::kAlike;
  failAt(line, fmt::format("\"{}\" is no choice (first, second, alike)", name));
}

Vote voteOf(const CsvRecord& record, const ColumnIndices& columnIndices, std::size_t columns) {
  if (record.fields.size() != columns)
    failAt(record.line, fmt::format("has {} fields in place of {}", record.fields.size(), columns));
  const auto field = [&](std::size_t column) -> const std::string& { return record.fields[columnIndices[column]]; };
  Vote vote{field(0), kindNamed(field(1), record.line),  field(2), field(3),
            field(4), choiceNamed(field(5), record.line)};
  if (vote.first.empty() || vote.second.empty()) failAt(record.line, "a method has no name");
  if (vote.first == vote.second) failAt(record.line, "a method is compared with itself");
  return vote;
}

// Kind, subject and method of a result.
using ResultKey = std::tuple<CellKind, std::string, std::string>;

}  // namespace

std::vector<Vote> parseVotes(std::string_view text) {
  CsvReader reader(text);
  const std::optional<CsvRecord> head = reader.next();
  if (!head) failAt(1, "is empty");
  const ColumnIndices columnIndices = findColumns(*head);
  std::vector<Vote> votes;
  while (const std::optional<CsvRecord> record = reader.next()) {
    votes.push_back(voteOf(*record, columnIndices, head->fields.size()));
  }
  return votes;
}

std::vector<Vote> lastVotes(std::span<const Vote> votes) {
  std::vector<Vote> kept;
  std::map<std::tuple<std::string, CellKind, std::string, std::string, std::string>, std::size_t> indices;
  for (const Vote& vote : votes) {
    const auto [low, high] = std::minmax(vote.first, vote.second);
    const auto [found, isNew] = indices.try_emplace({vote.voter, vote.kind, vote.subject, low, high}, kept.size());
    if (isNew) {
      kept.push_back(vote);
    } else {
      kept[found->second] = vote;
    }
  }
  return kept;
}

std::vector<Vote> votesOn(std::span<const StudyCell> cells, std::span<const Vote> votes) {
  std::set<ResultKey> results;
  for (const StudyCell& cell : cells) results.insert({cell.kind, cell.subject(), cell.method()});
  std::vector<Vote> kept;
  for (const Vote& vote : votes) {
    if (results.contains({vote.kind, vote.subject, vote.first}) &&
        results.contains({vote.kind, vote.subject, vote.second})) {
      kept.push_back(vote);
    }
  }
  return kept;
}

}  // namespace limber
