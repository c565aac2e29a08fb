#include "limber/core/text/list_lines.h"

#include "limber/core/text/split_text.h"

namespace limber {

std::vector<ListLine> listLines(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf", kBlank = " \t\r";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<ListLine> lines;
  std::size_t number = 0;
  for (const std::string_view line : splitAt(text, '\n')) {
    ++number;
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) continue;
    const std::string_view words = line.substr(begin, line.find_last_not_of(kBlank) + 1 - begin);
    if (words != "#" && !words.starts_with("# ")) lines.push_back({number, words});
  }
  return lines;
}

}  // namespace limber
