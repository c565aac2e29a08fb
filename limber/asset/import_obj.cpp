#include "limber/asset/import_obj.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

namespace limber {

namespace {

bool isSpace(char c) {
  return c == ' ' || c == '\t';
}

// Takes the next word off the front of a line.
std::string_view nextWord(std::string_view& line) {
  while (!line.empty() && isSpace(line.front())) line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && !isSpace(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

// The number at the start of "12/3/4" or "-1"; 0, which OBJ never uses, where there is none.
std::int64_t leadingNumber(std::string_view word) {
  const bool negative = !word.empty() && word.front() == '-';
  std::int64_t number = 0;
  for (const char c : word.substr(negative ? 1 : 0)) {
    if (c < '0' || c > '9' || number > (std::int64_t{1} << 40)) break;
    number = 10 * number + (c - '0');
  }
  return negative ? -number : number;
}

}  // namespace

std::size_t countLooseObjVertices(ByteSpan bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<bool> named;  // a vertex each
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const std::string_view kind = nextWord(line);
    if (kind == "v") ++count;
    if (kind != "f" && kind != "l" && kind != "p") continue;
    while (!line.empty()) {
      const std::int64_t number = leadingNumber(nextWord(line));
      const std::int64_t vertex = number < 0 ? static_cast<std::int64_t>(count) + number : number - 1;
      // A file of n bytes has fewer than n vertices: anything above is no vertex of it.
      if (number == 0 || vertex < 0 || vertex >= static_cast<std::int64_t>(bytes.size())) continue;
      if (static_cast<std::size_t>(vertex) >= named.size()) named.resize(static_cast<std::size_t>(vertex) + 1, false);
      named[static_cast<std::size_t>(vertex)] = true;
    }
  }
  const auto used = static_cast<std::size_t>(std::count(named.begin(), named.end(), true));
  return used == 0 || used > count ? 0 : count - used;
}

}  // namespace limber
