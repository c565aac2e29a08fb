// A picture of dark and light squares in a terminal: two rows of it in one line, since a letter is twice as high as
// wide.
#pragma once

#include <string>
#include <vector>

namespace limber::cli {

// Row by row; true is dark.
struct Squares {
  int width = 0;
  std::vector<bool> dark;  // width * height
};

// With a margin of so many light squares all around (a QR code wants 4, ISO/IEC 18004 section 9.1). Lines of UTF-8 that
// end in a newline each. `colours`: black on white by ANSI escapes, since a dark terminal would turn the picture round
// and not every phone reads that; without them dark squares are the ink.
std::string halfBlocks(const Squares& squares, int margin, bool colours);

}  // namespace limber::cli
