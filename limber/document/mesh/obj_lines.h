// The lines of OBJ and MTL files, and their words.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "limber/core/file/file.h"
#include "limber/core/text/parse_number.h"

namespace limber {

// Takes the next word off the front of a line; empty at its end or at a comment.
inline std::string_view nextObjWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (line.starts_with('#')) line = {};
  const std::string_view word = line.substr(0, line.find_first_of(" \t#"));
  line.remove_prefix(word.size());
  return word;
}

// Of a line's first word: a vertex or what is made of vertices.
inline bool isObjElement(std::string_view kind) {
  return kind == "v" || kind == "vt" || kind == "vn" || kind == "f" || kind == "l" || kind == "p";
}

inline std::optional<double> objNumberOf(std::string_view word) {
  const char* at = word.data();
  return parseNumber(at, word.data() + word.size());
}

// What follows "v": "x y z", "x y z w" or "x y z r g b [a]".
struct ObjVertexWords {
  std::array<std::string_view, 7> words;
  std::size_t count = 0;

  explicit ObjVertexWords(std::string_view line) {
    for (std::string_view word = nextObjWord(line); !word.empty() && count < words.size(); word = nextObjWord(line)) {
      words[count++] = word;
    }
  }

  // What x, y and z are divided by; with 0 they are no position.
  double w() const { return count == 4 ? objNumberOf(words[3]).value_or(1) : 1; }
};

// The number at the front of a corner ("12/3/4", "-1"), which is taken off. 0, which OBJ never uses, where there is
// none or it does not end there ("1.5").
inline std::int64_t takeObjNumber(std::string_view& word) {
  const bool isNegative = word.starts_with('-');
  if (isNegative || word.starts_with('+')) word.remove_prefix(1);
  std::int64_t number = 0;
  for (; !word.empty() && word.front() >= '0' && word.front() <= '9'; word.remove_prefix(1)) {
    if (number <= (std::int64_t{1} << 40)) number = 10 * number + (word.front() - '0');
  }
  if (!word.empty() && word.front() != '/') return 0;
  return isNegative ? -number : number;
}

// Calls `visit(line)` for each line; the parts of an element that '\\' continues are one. Lines end where Assimp ends
// them.
template <typename Visit>
void forEachObjLine(ByteSpan bytes, const Visit& visit) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::string_view kEnds("\r\n\f\0", 4);
  const auto take = [&text, kEnds] {
    const std::size_t end = std::min(text.find_first_of(kEnds), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
    return line;
  };
  std::string joined;
  while (!text.empty()) {
    std::string_view line = take();
    std::string_view rest = line;
    if (line.ends_with('\\') && isObjElement(nextObjWord(rest))) {
      joined = line;
      while (joined.ends_with('\\')) {
        joined.back() = ' ';
        joined += take();
      }
      line = joined;
    }
    visit(line);
  }
}

}  // namespace limber
