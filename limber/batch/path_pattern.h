// Patterns of paths: models/**/*.obj.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

// Has the text a * or a ?
bool isPathPattern(std::string_view text);

// Does the path match? Parts are parted by '/'. * and ? stand for any characters within a part, ** for any number of
// whole parts, also none.
bool matchesPathPattern(std::string_view path, std::string_view pattern);

// The files that match, by their paths in order. `pattern` is seen from `folder`, and so are the paths that come back.
// Links to folders are not entered. Throws Error kFile where a folder cannot be read.
std::vector<std::string> filesMatching(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace limber
