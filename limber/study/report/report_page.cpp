#include "limber/study/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/core/file/file.h"
#include "limber/core/text/names.h"
#include "limber/document/uri.h"
#include "limber/report/escaped_text.h"
#include "limber/report/page_assets.h"
#include "limber/report/table.h"
#include "limber/study/ranking/study_rankings.h"
#include "limber/study/report/ballot_page.h"
#include "limber/study/report/time_plot.h"

namespace limber {

namespace {

constexpr std::size_t kMaxEmbedded = 13000000;  // bytes of pictures as text, of a page below 15 MB

// Infinite where the method failed that often.
Cell numberCell(double value) {
  Cell cell(value);
  cell.text = numberText(value);
  cell.isBad = !std::isfinite(value);
  return cell;
}

Cell failureCell(std::size_t count) {
  Cell cell(count);
  cell.isBad = count > 0;
  return cell;
}

Cell cellLink(const StudyResult& study, std::size_t cell) {
  Cell link(study.cells[cell].subject());
  link.target = fmt::format("#cell-{}", cell);
  return link;
}

// By which a reader finds a cell.
std::string filterWords(const StudyCell& cell) {
  return cell.subject() + " " + cell.group + " " + cell.method();
}

// In percent.
Cell strengthCell(const VoteRanking& byEye, const std::string& method) {
  const auto score = std::find_if(byEye.scores.begin(), byEye.scores.end(),
                                  [&](const VoteScore& one) { return one.method == method; });
  return score == byEye.scores.end() ? Cell() : numberCell(100 * score->strength);
}

// The medians of all measures that rank, or of those that do not, side by side: a line for each method, over all and in
// each folder. byEye: the ranking by votes beside them, or null.
std::string overview(const KindRankings& report, bool ranks, std::string_view title, const VoteRanking* byEye) {
  Table table{{words("method"), words("folder")}, fmt::format("{}: {}", kindTitle(report.kind), title)};
  for (const Ranking& ranking : report.groups.front().rankings) {
    if (ranking.measure->ranks == ranks) table.columns.push_back(significant(measureTitle(*ranking.measure), 4));
  }
  if (table.columns.size() == 2 && !byEye) return {};
  if (byEye) table.columns.push_back(significant("by eye (%)", 4));
  for (const GroupRankings& group : report.groups) {
    for (const std::string& method : report.methods) {
      const auto isThere = [&](const Ranking& all) { return all.measure->ranks == ranks && all.scoreOf(method); };
      const std::vector<Ranking>& all = report.groups.front().rankings;
      if (!byEye && std::none_of(all.begin(), all.end(), isThere)) continue;
      std::vector<Cell> cells = {method, group.name.empty() ? "all" : group.name};
      for (const Ranking& ranking : group.rankings) {
        if (ranking.measure->ranks != ranks) continue;
        const MethodScore* score = ranking.scoreOf(method);
        cells.push_back(score ? numberCell(score->value.median) : Cell());
      }
      if (byEye) cells.push_back(group.name.empty() ? strengthCell(*byEye, method) : Cell());
      table.add(std::move(cells), method + " " + group.name);
    }
  }
  return toHtml(table);
}

std::string rankingTable(const Ranking& ranking) {
  Table table{{number("rank", 0), words("method"), number("models", 0), number("failed", 0), significant("median", 4),
               significant("95 % from", 4), significant("95 % to", 4), significant("time (s)", 4)},
              fmt::format("Ranking by {}", ranking.measure->label)};
  for (std::size_t i = 0; i < ranking.scores.size(); ++i) {
    const MethodScore& score = ranking.scores[i];
    table.add({i + 1, score.method, score.subjects, failureCell(score.failures), numberCell(score.value.median),
               numberCell(score.value.low), numberCell(score.value.high),
               score.seconds > 0 ? numberCell(score.seconds) : Cell()},
              score.method);
  }
  return toHtml(table);
}

std::string pairsHtml(std::span<const MethodPair> pairs, std::string caption) {
  if (pairs.empty()) return {};
  Table table = pairTable(pairs, "the same");
  table.caption = std::move(caption);
  return toHtml(table);
}

std::string votesHtml(const VoteRanking& byEye) {
  std::string html = fmt::format(
      "<details class=\"measure\" open><summary>By eye ({} of {}; more is better)</summary>\n"
      "<p>Strength: the chance that a method is chosen beside one of middling strength (Bradley-Terry). The interval "
      "is "
      "of the votes.</p>\n",
      counted(byEye.votes, "vote"), counted(byEye.voters, "voter"));
  Table table{{number("rank", 0), words("method"), number("votes", 0), significant("chosen (%)", 4),
               significant("strength (%)", 4), significant("95 % from", 4), significant("95 % to", 4)},
              "Ranking by eye"};
  for (std::size_t i = 0; i < byEye.scores.size(); ++i) {
    const VoteScore& score = byEye.scores[i];
    table.add(
        {i + 1, score.method, score.votes, 100 * score.chosen, 100 * score.strength, 100 * score.low, 100 * score.high},
        score.method);
  }
  return html + toHtml(table) + pairsHtml(byEye.pairs, "Are they different by eye? Sign test, p after Holm") +
         "</details>\n";
}

std::string worstTable(const StudyResult& study, const Ranking& ranking) {
  Table table{{words("model"), words("method"), significant(std::string(ranking.measure->label), 4)}, "Worst cells"};
  for (const std::size_t cell : ranking.worstCells) {
    table.add({cellLink(study, cell), study.cells[cell].method(),
               numberCell(study.results[cell].valueOf(*ranking.measure).value_or(0))},
              filterWords(study.cells[cell]));
  }
  return toHtml(table);
}

std::string kindSection(const StudyResult& study, const KindRankings& report, const VoteRanking* byEye) {
  std::string html = fmt::format("<section><h2>{}: rankings</h2>\n", kindTitle(report.kind)) +
                     overview(report, true, "medians of all methods", byEye);
  html += "<p>A method that failed on a model counts as worse there than any that did not.</p>\n";
  if (byEye) html += votesHtml(*byEye);
  bool isFirst = true;
  for (const Ranking& ranking : report.groups.front().rankings) {
    if (!ranking.measure->ranks) continue;
    html += fmt::format("<details class=\"measure\"{}><summary>{}</summary>\n", isFirst ? " open" : "",
                        htmlText(measureTitle(*ranking.measure)));
    html += rankingTable(ranking) + timePlot(ranking) +
            pairsHtml(ranking.pairs, "Are they different? Wilcoxon's signed rank test, p after Holm") +
            worstTable(study, ranking) + "</details>\n";
    isFirst = false;
  }
  return html + overview(report, false, "medians of measures that rank nothing", nullptr) + "</section>\n";
}

std::string failureSection(const StudyResult& study) {
  Table table{{words("model"), words("method"), words("outcome"), {.name = "why", .wraps = true}}, "Cells that failed"};
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const CellResult& result = study.results[i];
    if (result.outcome == JobOutcome::kDone) continue;
    table.add({cellLink(study, i), study.cells[i].method(), jobOutcomeName(result.outcome), result.problem},
              filterWords(study.cells[i]));
  }
  return table.rows.empty() ? "" : "<section><h2>What did not end well</h2>\n" + toHtml(table) + "</section>\n";
}

// Where a picture is, as an attribute has it: its bytes, or its name beside the page.
using PictureSource = std::function<std::string(const CellPicture&)>;

PictureSource pictureSource(const StudyResult& study, const std::filesystem::path& folder) {
  std::size_t total = 0;
  for (const CellResult& result : study.results) {
    for (const CellPicture& picture : result.pictures) {
      std::error_code unseen;
      const std::uintmax_t size = std::filesystem::file_size(folder / picture.file, unseen);
      if (!unseen) total += static_cast<std::size_t>((size + 2) / 3 * 4);
    }
  }
  if (total > kMaxEmbedded)
    return [](const CellPicture& picture) { return htmlText(percentEncode(picture.file.generic_string())); };
  return [folder](const CellPicture& picture) {
    return "data:image/png;base64," + encodeBase64(readFile(folder / picture.file));
  };
}

std::string pictureHtml(const CellPicture& picture, const std::string& alt, const PictureSource& source) {
  const bool moves = picture.name == "motion", isSheet = picture.name == "stretch";
  const std::string image = fmt::format(
      "<img loading=\"lazy\"{4} data-picture=\"{0}\" alt=\"{0}: {1}\" src=\"{2}\" width=\"{3}\" height=\"{3}\">",
      htmlText(picture.name), htmlText(alt), source(picture), isSheet ? 224 : 160, isSheet ? " class=\"sheet\"" : "");
  // Whoever does not want things to move does not open it.
  return moves ? "<details><summary>Motion</summary>" + image + "</details>" : image;
}

std::string cellFigure(const StudyResult& study, std::size_t index, const PictureSource& source) {
  const StudyCell& cell = study.cells[index];
  const CellResult& result = study.results[index];
  std::string html = fmt::format(
      "<figure id=\"cell-{0}\" data-words=\"{1}\" data-kind=\"{2}\" data-subject=\"{3}\" data-method=\"{4}\">"
      "<figcaption>{4}</figcaption>\n",
      index, htmlText(lowerCase(filterWords(cell))), cellKindName(cell.kind), htmlText(cell.subject()),
      htmlText(cell.method()));
  for (const CellPicture& picture : result.pictures) {
    html += pictureHtml(picture, cell.subject() + " by " + cell.method(), source);
  }
  if (!result.problem.empty()) {
    html += fmt::format("<p class=\"bad\">{}: {}</p>", jobOutcomeName(result.outcome), htmlText(result.problem));
  }
  std::string values;
  for (const MeasuredValue& one : result.measures) {
    values +=
        fmt::format("{}{}: {}", values.empty() ? "" : "<br>", htmlText(one.measure->label), numberText(one.value));
    if (!one.measure->unit.empty()) values += fmt::format(" ({})", htmlText(one.measure->unit));
  }
  html += "<details><summary>Figures and commands</summary><p>" + values + "</p><pre>";
  for (const CellStep& step : cell.steps) html += htmlText(commandText(step)) + "\n";
  return html + "</pre><button type=\"button\" class=\"copy\">Copy commands</button></details></figure>\n";
}

std::string pictureSection(const StudyResult& study, const PictureSource& source) {
  std::string html = "<section><h2>Side by side</h2>\n";
  std::string subject;
  bool isOpen = false;
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const std::string next = fmt::format("{}: {}", kindTitle(study.cells[i].kind), study.cells[i].subject());
    if (!isOpen || next != subject) {
      html += fmt::format("{}<div class=\"subject\"><h3>{}</h3><div class=\"cells\">\n", isOpen ? "</div></div>\n" : "",
                          htmlText(next));
      subject = next;
      isOpen = true;
    }
    html += cellFigure(study, i, source);
  }
  return html + (isOpen ? "</div></div>\n" : "") + "</section>\n";
}

std::string header(const StudyResult& study) {
  const auto failed = std::count_if(study.results.begin(), study.results.end(),
                                    [](const CellResult& r) { return r.outcome != JobOutcome::kDone; });
  return fmt::format(
      "<header><h1>{}</h1>\n<p>{}, of which {} did not end well. All figures: <a href=\"cells.csv\">cells.csv</a>, "
      "<a href=\"cells.json\">cells.json</a>; to quote: <a href=\"summary.md\">summary.md</a>. "
      "<a href=\"#ballot\" hidden>Judge by eye</a></p>\n"
      "<label for=\"filter\">Show only what has these words</label>"
      "<input type=\"search\" id=\"filter\" placeholder=\"model, method or folder\"> "
      "<span id=\"shown\" role=\"status\"></span></header>\n",
      htmlText(study.title), counted(study.cells.size(), "cell"), failed);
}

}  // namespace

std::string reportPage(const StudyResult& study, const std::filesystem::path& folder,
                       std::span<const VoteRanking> byEye) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: file: 'self'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">"
      "<title>{}</title><style>{}{}</style></head><body>\n{}<main>\n",
      htmlText(study.title), kPageStyle, kBallotStyle, header(study));
  for (const KindRankings& report : studyRankings(study)) {
    const auto votes =
        std::find_if(byEye.begin(), byEye.end(), [&](const VoteRanking& one) { return one.kind == report.kind; });
    html += kindSection(study, report, votes == byEye.end() ? nullptr : &*votes);
  }
  html += failureSection(study) + ballotSection(study) + pictureSection(study, pictureSource(study, folder));
  return html + fmt::format("</main><script>{}{}</script></body></html>\n", kPageScript, kBallotScript);
}

}  // namespace limber
