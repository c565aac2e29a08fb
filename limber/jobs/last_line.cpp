#include "limber/jobs/last_line.h"

#include <algorithm>

namespace limber {

std::string lastLine(std::string_view text, std::size_t most) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return {};
  text = text.substr(0, end + 1);
  text.remove_prefix(text.find_last_of("\r\n") + 1);  // npos + 1 is 0
  text.remove_prefix(text.find_first_not_of(" \t"));
  std::string line(text.substr(0, most));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  return line;
}

}  // namespace limber
