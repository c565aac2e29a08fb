// The lines of OBJ and MTL files, and their words.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "limber/core/file.h"

namespace limber {

// A vertex' number as two of a colour's digits, which both are exact in single precision.
inline constexpr std::size_t kObjNumberBase = 65536;

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

// Calls `visit(line)` for each line; the parts of an element that '\\' continues are one.
template <typename Visit>
void forEachObjLine(ByteSpan bytes, const Visit& visit) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto take = [&text] {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
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
