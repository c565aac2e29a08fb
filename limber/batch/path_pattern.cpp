#include "limber/batch/path_pattern.h"

#include "limber/core/file/folder.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr char kSeparator = '/';
constexpr std::string_view kFolders = "**";

struct SplitPath {
  std::string_view first, rest;
  bool isLast = false;
};

SplitPath split(std::string_view path) {
  const std::size_t end = path.find(kSeparator);
  if (end == std::string_view::npos) return {path, {}, true};
  return {path.substr(0, end), path.substr(end + 1), false};
}

// Within one part. On a mismatch behind a *, that one takes a character more: linear for each *.
bool matchesPart(std::string_view text, std::string_view pattern) {
  std::size_t t = 0, p = 0, star = std::string_view::npos, taken = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++taken;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace

bool isPathPattern(std::string_view text) {
  return text.find_first_of("*?") != std::string_view::npos;
}

bool matchesPathPattern(std::string_view path, std::string_view pattern) {
  const SplitPath wanted = split(pattern), given = split(path);
  if (wanted.first == kFolders) {
    if (wanted.isLast) return true;
    return matchesPathPattern(path, wanted.rest) || (!given.isLast && matchesPathPattern(given.rest, pattern));
  }
  if (wanted.isLast != given.isLast || !matchesPart(given.first, wanted.first)) return false;
  return wanted.isLast || matchesPathPattern(given.rest, wanted.rest);
}

std::vector<std::string> filesMatching(const fs::path& folder, const std::string& pattern) {
  fs::path start;  // the parts before the first with a * or a ?
  for (const fs::path& part : fs::path(pattern)) {
    if (isPathPattern(part.string())) break;
    start /= part;
  }
  const std::string wanted = fs::path(pattern).lexically_relative(start.empty() ? "." : start).generic_string();
  const fs::path location = folder / start;
  std::vector<std::string> found;
  for (const fs::path& file : filesBelow(location)) {
    const fs::path below = file.lexically_relative(location);
    if (matchesPathPattern(below.generic_string(), wanted)) found.push_back((start / below).generic_string());
  }
  return found;
}

}  // namespace limber
