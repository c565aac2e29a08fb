#include "limber/crowd/retarget_characters.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "limber/actions/rig/stand_upright.h"
#include "limber/core/file/folder.h"
#include "limber/core/file/storage_error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/list_lines.h"
#include "limber/core/text/names.h"
#include "limber/document/read.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// What is told by one key, and where it was met first, whichever thread met it first.
struct Report {
  std::size_t count = 0, first = 0;  // the number of a character
  Warning warning;
};

class Tally {
 public:
  void add(std::size_t character, const std::string& key, std::size_t count, const Warning& warning) {
    Report& report = reported_.try_emplace(key, Report{0, character, warning}).first->second;
    report.count += count;
    if (character >= report.first) return;
    report.first = character;
    report.warning = warning;
  }

  // By the characters that met them first.
  std::vector<std::pair<std::string, Report>> inOrder() const {
    std::vector<std::pair<std::string, Report>> all(reported_.begin(), reported_.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.second.first < b.second.first; });
    return all;
  }

 private:
  std::map<std::string, Report> reported_;
};

// The message without where(), by which failures of one kind are reported together.
std::string problemOf(const Error& error) {
  return error.remedy().empty() ? error.message() : fmt::format("{} ({})", error.message(), error.remedy());
}

class CharactersRun {
 public:
  CharactersRun(const CharactersJob& job, Progress& progress)
      : job_(job),
        progress_(progress),
        names_(characterFileNames(job.characters, job.motions, job.extension, job.isSeparate)),
        filesEach_(job.isSeparate ? job.motions.size() : 1) {}

  CharactersReport run() {
    progress_.stage("retarget");
    parallelFor(job_.characters.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) doCharacter(c);
    });
    report_.matches = matches_.made();
    for (const auto& [problem, report] : failures_.inOrder()) {
      report_.failures.push_back({problem, report.count, job_.characters[report.first]});
    }
    for (const auto& [kind, report] : warnings_.inOrder()) {
      report_.warnings.add(kind, report.warning.message, report.warning.where, report.count);
    }
    return std::move(report_);
  }

 private:
  void doCharacter(std::size_t c) {
    std::size_t written = 0;
    Warnings warnings;
    guarded(c, filesEach_, [&] {
      Asset character = readAsset(job_.characters[c]);
      warnings.append(character.warnings);
      character.warnings = {};
      if (!canMove(character)) {
        throw Error(ErrorCode::kBadArgument, "the model has no rig to move", character.name,
                    "limber animate rigs it first");
      }
      RetargetAssetOptions retarget = job_.retarget;
      retarget.matches = &matches_;
      const UprightCharacter upright = standUpright(character, warnings);
      retarget.turn = upright.turn;
      for (std::size_t f = 0; f < filesEach_; ++f) {
        const std::span<const Motion> motions(job_.motions.data() + f, job_.isSeparate ? 1 : job_.motions.size());
        const bool isWritten =
            guarded(c, 1, [&] { writeOne(character, upright.character, motions, retarget, c, f, warnings); });
        if (isWritten) ++written;
      }
    });
    finish(c, written, warnings);
  }

  // What `act` throws is told of the character. Whoever wants to stop all of it may.
  template <typename Act>
  bool guarded(std::size_t c, std::size_t files, const Act& act) {
    try {
      act();
      return true;
    } catch (const StorageError&) {
      throw;  // all others would fare alike
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      fail(c, files, problemOf(error));
    } catch (const std::bad_alloc&) {
      fail(c, files, "needs more memory than there is");
    }
    return false;
  }

  void writeOne(Asset& character, const Character& reading, std::span<const Motion> motions,
                const RetargetAssetOptions& options, std::size_t c, std::size_t f, Warnings& warnings) const {
    Asset copy;  // the last file may take the character itself
    const bool isLast = f + 1 == filesEach_;
    if (!isLast) copy = character.clone();
    Asset& asset = isLast ? character : copy;
    std::vector<std::string> clips;
    for (const Motion& motion : motions) {
      for (const RetargetedClip& clip : retargetOnto(asset, reading, motion, options)) clips.push_back(clip.name);
    }
    editClips(asset, clips, job_.edits, reading.reading());
    warnings.append(asset.warnings);
    WriteModelOptions write = job_.write;
    write.reading = reading.reading();
    const fs::path path = job_.folder / names_[c * filesEach_ + f];
    if (holdsOneClip(path)) write.clip = clips.front();
    warnings.append(writeModel(asset, path, write));
  }

  void fail(std::size_t c, std::size_t files, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    failures_.add(c, problem, files, {});
    report_.failed += files;
  }

  void finish(std::size_t c, std::size_t written, const Warnings& warnings) {
    const std::lock_guard lock(mutex_);
    report_.files += written;
    for (const Warning& warning : warnings.items()) warnings_.add(c, warning.kind, warning.count, warning);
    progress_.update(static_cast<double>(++done_) / static_cast<double>(job_.characters.size()));
  }

  const CharactersJob& job_;
  Progress& progress_;
  const std::vector<std::string> names_;
  const std::size_t filesEach_;
  SkeletonMatches matches_;
  std::mutex mutex_;  // guards the rest
  CharactersReport report_;
  Tally failures_, warnings_;
  std::size_t done_ = 0;
};

void checkJob(const CharactersJob& job) {
  if (job.characters.empty()) throw Error(ErrorCode::kBadArgument, "no character is given");
  if (job.motions.empty()) throw Error(ErrorCode::kBadArgument, "no motion is given");
  if (holdsOneClip("x" + job.extension) && !job.isSeparate && job.motions.size() > 1) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} keeps one clip a file", job.extension), {},
                "--separate writes a file for each motion");
  }
}

// A character must not be replaced by its own result, by whatever path.
void checkBesideCharacters(const CharactersJob& job) {
  std::set<fs::path> written;
  const fs::path folder = fs::weakly_canonical(job.folder);
  for (const std::string& name : characterFileNames(job.characters, job.motions, job.extension, job.isSeparate)) {
    written.insert(folder / name);
  }
  for (const fs::path& character : job.characters) {
    std::error_code ignored;
    if (!written.contains(fs::weakly_canonical(character, ignored))) continue;
    throw Error(ErrorCode::kBadArgument, "would be written over", character.string(), "choose another folder");
  }
}

}  // namespace

std::vector<fs::path> readCharacterList(const fs::path& list) {
  const Bytes bytes = readFile(list);
  const fs::path folder = list == "-" ? fs::path() : list.parent_path();
  std::vector<fs::path> characters;
  for (const ListLine& line : listLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
    characters.push_back(folder / fs::path(line.text));
  }
  if (characters.empty()) throw Error(ErrorCode::kBadData, "names no character", list.string(), "write a path a line");
  return characters;
}

std::vector<std::string> characterFileNames(std::span<const fs::path> characters, std::span<const Motion> motions,
                                            const std::string& extension, bool isSeparate) {
  std::vector<std::string> names;
  std::set<std::string> used;
  std::map<std::string, std::size_t> next;
  const auto add = [&](const std::string& wanted) {
    std::string name = wanted;
    std::size_t& number = next.try_emplace(lowerCase(wanted), 2).first->second;
    while (!used.insert(lowerCase(name)).second) name = fmt::format("{}_{}", wanted, number++);
    names.push_back(name + extension);
  };
  for (const fs::path& character : characters) {
    const std::string stem = character.stem().string();
    if (!isSeparate) add(stem);
    for (std::size_t m = 0; isSeparate && m < motions.size(); ++m) add(stem + "_" + motions[m].name);
  }
  return names;
}

CharactersReport retargetCharacters(const CharactersJob& job, Progress& progress) {
  checkJob(job);
  makeFolder(job.folder);
  checkBesideCharacters(job);
  return CharactersRun(job, progress).run();
}

}  // namespace limber
