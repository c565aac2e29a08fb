#include "limber/study/input_digest.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "limber/asset/uri.h"
#include "limber/core/error.h"
#include "limber/core/names.h"
#include "limber/jobs/job_key.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// Formats whose files are whole by themselves.
bool standsAlone(const fs::path& file) {
  constexpr std::string_view kAlone[] = {".glb", ".stl", ".ply", ".off", ".bvh",
                                         ".npz", ".bin", ".png", ".jpg", ".jpeg"};
  const std::string extension = lowerExtension(file);
  return std::find(std::begin(kAlone), std::end(kAlone), extension) != std::end(kAlone);
}

}  // namespace

const InputDigests::FolderNames& InputDigests::namesIn(const fs::path& folder) {
  const auto [place, isNew] = folders_.try_emplace(folder.string());
  FolderNames& names = place->second;
  if (!isNew) return names;
  std::error_code problem;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    std::error_code unseen;
    if (!it->is_regular_file(unseen)) continue;
    const std::string name = it->path().filename().string();
    if (!it->path().has_extension()) continue;
    for (const std::string& written : {name, percentEncode(name)}) {
      names.files.emplace(written, name);
      names.lengths.insert(written.size());
      names.extensions.insert(fs::path(written).extension().string());
    }
  }
  return names;
}

// Names are looked for where an extension of one ends: linear in the text for folders of any size.
std::set<std::string> InputDigests::namedBeside(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const FolderNames& names = namesIn(folder);
  std::set<std::string> found;
  std::vector<std::string> open = {file.filename().string()};
  while (!open.empty()) {
    const fs::path one = folder / open.back();
    open.pop_back();
    if (standsAlone(one)) continue;
    check(one);
    const Bytes bytes = readFile(one);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const std::string& extension : names.extensions) {
      for (std::size_t at = text.find(extension); at != std::string_view::npos; at = text.find(extension, at + 1)) {
        const std::size_t end = at + extension.size();
        for (const std::size_t length : names.lengths) {
          if (length > end) break;
          const auto named = names.files.find(text.substr(end - length, length));
          if (named == names.files.end() || named->second == file.filename()) continue;
          if (found.insert(named->second).second) open.push_back(named->second);
        }
      }
    }
  }
  return found;
}

void InputDigests::check(const fs::path& file) const {
  std::error_code problem;
  const fs::file_status status = fs::status(file, problem);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(ErrorCode::kFile, "is no plain file", file.string(), "copy what it gives into one");
  }
  const std::uintmax_t size = fs::file_size(file, problem);
  if (!problem && size > most_) {
    throw Error(ErrorCode::kFile,
                fmt::format("is larger than the {:.0f} MB allowed", std::ceil(std::ldexp(most_, -20))), file.string());
  }
}

std::string InputDigests::digestOf(const fs::path& file) const {
  check(file);
  return sha256OfFile(file);
}

InputDigest InputDigests::of(const fs::path& file) {
  InputDigest digest;
  digest.bytes = digestOf(file);
  JobKey key;
  key.add(lowerExtension(file)).add(digest.bytes);
  if (!standsAlone(file)) {
    for (const std::string& name : namedBeside(file)) key.add(name).add(digestOf(file.parent_path() / name));
  }
  digest.all = key.hex();
  return digest;
}

}  // namespace limber
