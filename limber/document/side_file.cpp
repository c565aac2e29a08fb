#include "limber/document/side_file.h"

#include <algorithm>
#include <string>

namespace limber {

namespace {

// "C:\models\.\skin.png" -> "C:/models/./skin.png".
std::string withSlashes(std::string_view path) {
  std::string result(path);
  std::replace(result.begin(), result.end(), '\\', '/');
  while (result.rfind("./", 0) == 0) result.erase(0, 2);
  return result;
}

bool isAbsolute(const std::string& path) {
  return path.rfind('/', 0) == 0 || path.find(':') != std::string::npos;
}

std::optional<Bytes> open(const Resolver& resolver, const std::string& path) {
  if (!resolver || path.empty() || isAbsolute(path)) return std::nullopt;
  try {
    return resolver(path);
  } catch (const Error&) {  // leads out of the model's folder, or cannot be read: as good as not there
    return std::nullopt;
  }
}

}  // namespace

std::optional<Bytes> sideFileThere(const Resolver& resolver, std::string_view path) {
  return open(resolver, withSlashes(path));
}

std::optional<Bytes> sideFile(const Resolver& resolver, std::string_view path) {
  const std::string name = withSlashes(path);
  if (std::optional<Bytes> bytes = open(resolver, name)) return bytes;
  const std::size_t slash = name.find_last_of('/');
  return slash == std::string::npos ? std::nullopt : open(resolver, name.substr(slash + 1));
}

}  // namespace limber
