#include "limber/study/input_digest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/document/uri.h"
#include "limber/jobs/job_key.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxFolders = 8;  // on a path; links may make folders that have no end

// Formats whose files are whole by themselves.
bool isSelfContained(const fs::path& file) {
  constexpr std::string_view kAlone[] = {".glb", ".stl", ".ply", ".off", ".bvh",
                                         ".npz", ".bin", ".png", ".jpg", ".jpeg"};
  const std::string extension = lowerExtension(file);
  return std::find(std::begin(kAlone), std::end(kAlone), extension) != std::end(kAlone);
}

bool isSlash(char c) {
  return c == '/' || c == '\\';
}

}  // namespace

void InputDigests::Names::add(const std::string& name) {
  for (const std::string& written : {name, percentEncode(name)}) {
    names.emplace(written, name);
    lengths.insert(written.size());
  }
}

const InputDigests::FolderNames& InputDigests::namesIn(const fs::path& folder) {
  const auto [entry, isNew] = folders_.try_emplace(folder.string());
  FolderNames& names = entry->second;
  if (!isNew) return names;
  std::error_code problem;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    std::error_code unseen;
    const std::string name = it->path().filename().string();
    if (it->is_directory(unseen)) {
      names.folders.add(name);
    } else if (it->is_regular_file(unseen) && it->path().has_extension()) {
      names.files.add(name);
      for (const std::string& written : {name, percentEncode(name)}) {
        names.extensions.insert(fs::path(written).extension().string());
      }
    }
  }
  return names;
}

// Names are looked for where an extension of one ends: linear in the text for folders of any size.
void InputDigests::findFiles(std::string_view text, const FolderNames& names, Paths& found) const {
  for (const std::string& extension : names.extensions) {
    for (std::size_t at = text.find(extension); at != std::string_view::npos; at = text.find(extension, at + 1)) {
      const std::size_t end = at + extension.size();
      for (const std::size_t length : names.files.lengths) {
        if (length > end) break;
        const auto named = names.files.names.find(text.substr(end - length, length));
        if (named != names.files.names.end()) found.insert(named->second);
      }
    }
  }
}

// Paths are looked for where the name of a folder ends: likewise linear.
void InputDigests::findBelow(std::string_view text, const fs::path& folder, Paths& found) {
  const Names& folders = namesIn(folder).folders;
  if (folders.names.empty()) return;
  std::array<bool, 256> endsName{};  // most slashes of a text stand behind none of these
  for (const auto& [written, name] : folders.names) endsName[static_cast<unsigned char>(written.back())] = true;
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (!isSlash(text[at]) || !endsName[static_cast<unsigned char>(text[at - 1])]) continue;
    for (const std::size_t length : folders.lengths) {
      if (length > at) break;
      const auto named = folders.names.find(text.substr(at - length, length));
      if (named == folders.names.end()) continue;
      findFrom(text.substr(at + 1), folder / named->second, named->second + '/', kMaxFolders - 1, found);
    }
  }
}

// The files whose paths the text begins with, seen from a folder that `path` leads to and at most so much deeper.
void InputDigests::findFrom(std::string_view text, const fs::path& folder, const std::string& path, int deeper,
                            Paths& found) {
  while (!text.empty() && isSlash(text.front())) text.remove_prefix(1);  // as JSON has them: "\/", and "\\\\"
  const FolderNames& names = namesIn(folder);
  for (const std::size_t length : names.files.lengths) {
    if (length > text.size()) break;
    const auto named = names.files.names.find(text.substr(0, length));
    if (named != names.files.names.end()) found.insert(path + named->second);
  }
  if (deeper == 0) return;
  for (const std::size_t length : names.folders.lengths) {
    if (length >= text.size()) break;
    if (!isSlash(text[length])) continue;
    const auto named = names.folders.names.find(text.substr(0, length));
    if (named == names.folders.names.end()) continue;
    findFrom(text.substr(length + 1), folder / named->second, path + named->second + '/', deeper - 1, found);
  }
}

// Whatever names them, paths are seen from the model's folder, as limber's readers look them up.
InputDigests::Paths InputDigests::namedBeside(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  Paths found;
  std::vector<std::string> open = {file.filename().string()};
  while (!open.empty()) {
    const fs::path one = folder / open.back();
    open.pop_back();
    if (isSelfContained(one)) continue;
    check(one);
    const Bytes bytes = readFile(one);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Paths named;
    findFiles(text, namesIn(folder), named);
    findBelow(text, folder, named);
    for (const std::string& path : named) {
      if (path != file.filename() && found.insert(path).second) open.push_back(path);
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
  if (!isSelfContained(file)) {
    for (const std::string& name : namedBeside(file)) key.add(name).add(digestOf(file.parent_path() / name));
  }
  digest.all = key.hex();
  return digest;
}

}  // namespace limber
