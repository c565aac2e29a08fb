// Lines of a text, cells and words of a line.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

namespace limber {

// What is between the separators, in order; one more part than separators. They point into `text`.
inline std::vector<std::string_view> splitAt(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// What is between blanks, which are any of these characters; no part is empty. They point into `text`.
inline std::vector<std::string_view> wordsIn(std::string_view text, std::string_view blanks = " ") {
  std::vector<std::string_view> words;
  for (std::size_t begin = text.find_first_not_of(blanks); begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace limber
