#include "limber/core/text/names.h"

#include <algorithm>

namespace limber {

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

std::string lowerExtension(const std::filesystem::path& path) {
  return lowerCase(path.extension().string());
}

}  // namespace limber
