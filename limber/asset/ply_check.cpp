#include "limber/asset/ply_check.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>

#include "limber/core/error.h"

namespace limber {

namespace {

struct PlyHeader {
  PlyCounts counts;
  bool text = false;
  std::uint64_t elements = 0;
  std::uint64_t bytes = 0;  // at least, of what follows a binary header
  std::size_t length = 0;   // of the header itself
};

std::uint64_t sizeOfType(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "double" || type == "float64") return 8;
  return 4;
}

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::kBadData, "cannot be read as PLY: " + why);
}

PlyHeader parseHeader(std::string_view file) {
  constexpr std::string_view kEnd = "end_header";
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  PlyHeader header;
  header.length = file.substr(0, kLongest).find(kEnd);
  if (header.length == std::string_view::npos || header.length + kEnd.size() >= file.size()) {
    refuse("its header has no end");
  }
  std::uint64_t count = 0;  // of the element that properties are read for
  std::istringstream lines{std::string(file.substr(0, header.length))};
  header.length += kEnd.size();
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, name;
    words >> word >> name;
    if (word == "format") header.text = name == "ascii";
    if (word == "property") header.bytes += count * sizeOfType(name == "list" && words >> word ? word : name);
    if (word != "element") continue;
    if (!(words >> count) || count > file.size()) {  // an element takes a byte at least
      refuse("it announces more elements than it can hold");
    }
    header.elements += count;
    if (name == "vertex") header.counts.vertices = count;
    if (name == "face") header.counts.faces = count;
  }
  return header;
}

// Lines that say something.
std::uint64_t countLines(std::string_view text) {
  std::uint64_t count = 0;
  bool blank = true;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      blank = true;
    } else if (blank && c != ' ' && c != '\t') {
      blank = false;
      ++count;
    }
  }
  return count;
}

}  // namespace

PlyCounts checkPly(ByteSpan bytes) {
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = parseHeader(file);
  const std::string_view body = file.substr(header.length);
  if (header.text ? countLines(body) < header.elements : body.size() < header.bytes) {
    refuse("it is cut off: it holds less than its header announces");
  }
  return header.counts;
}

}  // namespace limber
