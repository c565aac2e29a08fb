// Lists that users write, such as of paths.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace limber {

struct ListLine {
  std::size_t number = 0;  // in the file, from 1
  std::string_view text;   // without spaces around it
};

// The lines that say something, in order: not those that are blank, and no comments ("#" by itself or before a space).
// A byte order mark at the start is skipped. They point into `text`.
std::vector<ListLine> listLines(std::string_view text);

}  // namespace limber
