#include "half_blocks.h"

namespace limber::cli {

std::string halfBlocks(const Squares& squares, int margin, bool colours) {
  static constexpr const char* kLetters[2][2] = {{" ", "\u2584"}, {"\u2580", "\u2588"}};  // [above][below]
  const int height = squares.width > 0 ? static_cast<int>(squares.dark.size()) / squares.width : 0;
  const auto isDark = [&](int row, int column) {
    if (row < 0 || row >= height || column < 0 || column >= squares.width) return false;
    return static_cast<bool>(squares.dark[static_cast<std::size_t>(row * squares.width + column)]);
  };
  std::string text;
  for (int row = -margin; row < height + margin; row += 2) {
    if (colours) text += "\x1b[30;107m";
    for (int column = -margin; column < squares.width + margin; ++column) {
      text += kLetters[isDark(row, column)][isDark(row + 1, column)];
    }
    text += colours ? "\x1b[0m\n" : "\n";
  }
  return text;
}

}  // namespace limber::cli
