#include "limber/study/input_digest.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <vector>

#include "limber/asset/uri.h"
#include "limber/core/names.h"
#include "limber/jobs/job_key.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// Formats whose files are whole by themselves.
bool standsAlone(const fs::path& file) {
  constexpr std::string_view kAlone[] = {".glb", ".stl", ".ply", ".off", ".bvh", ".bin", ".png", ".jpg", ".jpeg"};
  const std::string extension = lowerExtension(file);
  return std::find(std::begin(kAlone), std::end(kAlone), extension) != std::end(kAlone);
}

std::vector<std::string> fileNamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code problem;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    std::error_code unseen;
    if (it->is_regular_file(unseen)) names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The files beside it that it names, and those that these name.
std::set<std::string> namedBeside(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const std::vector<std::string> names = fileNamesIn(folder);
  std::set<std::string> found;
  std::vector<std::string> open = {file.filename().string()};
  while (!open.empty()) {
    const fs::path one = folder / open.back();
    open.pop_back();
    if (standsAlone(one)) continue;
    const Bytes bytes = readFile(one);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const std::string& name : names) {
      const bool isNamed =
          text.find(name) != std::string_view::npos || text.find(percentEncode(name)) != std::string_view::npos;
      if (isNamed && name != file.filename() && found.insert(name).second) open.push_back(name);
    }
  }
  return found;
}

}  // namespace

std::string inputDigest(const fs::path& file) {
  JobKey key;
  key.add(lowerExtension(file)).add(sha256OfFile(file));
  if (standsAlone(file)) return key.hex();
  for (const std::string& name : namedBeside(file)) key.add(name).add(sha256OfFile(file.parent_path() / name));
  return key.hex();
}

}  // namespace limber
