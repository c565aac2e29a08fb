#include "limber/batch/batch_plan.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/adapters/job_limits.h"
#include "limber/batch/path_pattern.h"
#include "limber/core/file/file.h"
#include "limber/core/text/list_lines.h"
#include "limber/core/text/names.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_keys.h"
#include "limber/document/utf8.h"
#include "limber/study/study_input.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kVersionKey = "limber_batch";

std::vector<std::string> textsOf(const JsonView& list) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list.size(); ++i) texts.push_back(requiredText(list[i]));
  return texts;
}

// Calls `take` for each line of a list; errors say which.
template <typename Take>
void forEachLine(const fs::path& file, const Take& take) {
  const Bytes bytes = readFile(file);
  for (const ListLine& line : listLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
    try {
      take(line.text);
    } catch (const Error& error) {
      throw error.within(fmt::format("line {}", line.number)).within(file.string());
    }
  }
}

// Bytes that are not ASCII as "\xfe".
std::string withEscapes(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x80 ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return result;
}

// The path without links, also where its end is not there yet.
fs::path withoutLinks(const fs::path& path) {
  std::error_code problem;
  const fs::path absolute = fs::absolute(path, problem).lexically_normal();
  const fs::path found = fs::weakly_canonical(absolute, problem);
  return problem ? absolute : found;
}

// The folder that a batch writes to; it may be none.
class OutputFolder {
 public:
  explicit OutputFolder(const fs::path& path) : path_(path.empty() ? path : withoutLinks(path)) {}

  bool holds(const fs::path& file) {
    if (path_.empty()) return false;
    const auto [known, isNew] = known_.try_emplace(file.parent_path());
    if (isNew) {
      const fs::path folder = withoutLinks(file.parent_path());
      known->second = std::mismatch(path_.begin(), path_.end(), folder.begin(), folder.end()).first == path_.end();
    }
    return known->second;
  }

 private:
  fs::path path_;
  std::map<fs::path, bool> known_;  // by the files' folders
};

// Gathers what the inputs of a plan stand for.
class EntryList {
 public:
  EntryList(fs::path folder, const fs::path& outputs) : folder_(std::move(folder)), outputs_(outputs) {}

  void add(const JsonView& input) {
    if (input.json().is_object()) {
      addObject(input, {});
    } else {
      addName(requiredText(input), input);
    }
  }

  std::vector<BatchEntry> take(const std::string& extension) {
    nameOutputs(extension);
    return std::move(entries_);
  }

 private:
  void addObject(const JsonView& object, const fs::path& listFolder) {
    object.requireObject();
    allowKeys(object, {"path", "sha256", "options"});
    BatchEntry entry;
    entry.input = (listFolder / requiredText(object.member("path"))).lexically_normal().generic_string();
    entry.sha256 = object.text("sha256");
    constexpr std::size_t kDigits = 64;
    if (!entry.sha256.empty() &&
        (entry.sha256.size() != kDigits || entry.sha256.find_first_not_of("0123456789abcdef") != std::string::npos)) {
      object.member("sha256").fail("is not 64 hexadecimal digits in lower case");
    }
    entry.options = textsOf(object.array("options"));
    addEntry(std::move(entry));
  }

  void addFile(const std::string& file) {
    BatchEntry entry;
    entry.input = fs::path(file).lexically_normal().generic_string();
    addEntry(std::move(entry));
  }

  void addEntry(BatchEntry entry) {
    if (validUtf8(entry.input) != entry.input) {
      throw Error(ErrorCode::kBadData, fmt::format("the name '{}' is not UTF-8", withEscapes(entry.input)), {},
                  "rename the file: records could not tell it from others");
    }
    if (!known_.insert(entry.input).second) {
      throw Error(ErrorCode::kBadData, fmt::format("the plan names '{}' twice", entry.input));
    }
    entries_.push_back(std::move(entry));
  }

  void addName(const std::string& name, const JsonView& location) {
    if (isPathPattern(name)) {
      std::vector<std::string> files = filesMatching(folder_, name);
      std::erase_if(files, [&](const std::string& file) { return outputs_.holds(folder_ / file); });
      if (files.empty()) location.fail("matches no file, the batch's outputs left out");
      for (const std::string& file : files) addFile(file);
      return;
    }
    const fs::path path = folder_ / name, listFolder = fs::path(name).parent_path();
    std::error_code unseen;
    if (fs::is_directory(path, unseen)) return addFolder(path);
    if (!fs::exists(path, unseen)) {
      throw Error(ErrorCode::kFile, "is not there", path.string(), "paths in a plan are seen from the plan's folder");
    }
    const std::string extension = lowerExtension(path);
    if (extension == ".txt") {
      forEachLine(path, [&](std::string_view line) { addFile((listFolder / line).generic_string()); });
    } else if (extension == ".jsonl") {
      forEachLine(path, [&](std::string_view line) {
        const Json json = parseStrictly(line);
        addObject(JsonView(json), listFolder);
      });
    } else {
      addFile(name);
    }
  }

  void addFolder(const fs::path& path) {
    std::set<fs::path> files;
    for (const InputKind kind : {InputKind::kModel, InputKind::kMotion}) {
      for (const fs::path& file : inputFilesBelow(path, kind)) {
        if (!outputs_.holds(file)) files.insert(file);
      }
    }
    if (files.empty()) {
      throw Error(ErrorCode::kFile, "holds nothing that can be read, the batch's outputs left out", path.string());
    }
    for (const fs::path& file : files) addFile(file.lexically_relative(folder_).generic_string());
  }

  // Within the folder of outputs, wherever the input lies.
  static fs::path pathOf(const std::string& input) {
    fs::path location;
    for (const fs::path& part : fs::path(input).relative_path()) {
      if (part != "..") location /= part;
    }
    return location;
  }

  void nameOutputs(const std::string& extension) {
    std::map<std::string, std::size_t> users;
    const auto plain = [&](const BatchEntry& entry) {
      return pathOf(entry.input).replace_extension(extension).generic_string();
    };
    for (const BatchEntry& entry : entries_) ++users[plain(entry)];
    std::map<std::string, const BatchEntry*> taken;
    for (BatchEntry& entry : entries_) {
      entry.output = plain(entry);
      if (users[entry.output] > 1) {
        fs::path location = pathOf(entry.input);
        std::string own = location.extension().string();
        std::replace(own.begin(), own.end(), '.', '_');
        entry.output = location.replace_filename(location.stem().string() + own + extension).generic_string();
      }
      // A folder's name may be told by either case of its letters.
      if (const fs::path location = entry.output; lowerCase(location.begin()->string()) == kBatchOwnFolder) {
        throw Error(ErrorCode::kBadData,
                    fmt::format("would be written to '{}', among the batch's records", entry.output), entry.input,
                    fmt::format("take '{}' out of the input's path", location.begin()->string()));
      }
      if (!taken.emplace(entry.output, &entry).second) {
        throw Error(ErrorCode::kBadData, fmt::format("two inputs would be written to '{}'", entry.output), entry.input,
                    "give each a batch of its own");
      }
    }
    for (const auto& [output, entry] : taken) {
      const auto inside = taken.lower_bound(output + "/");
      if (inside == taken.end() || !inside->first.starts_with(output + "/")) continue;
      throw Error(ErrorCode::kBadData, fmt::format("the output '{}' would be the folder of another", output),
                  inside->second->input, "give each a batch of its own");
    }
  }

  fs::path folder_;
  OutputFolder outputs_;
  std::vector<BatchEntry> entries_;
  std::set<std::string> known_;
};

std::vector<std::string> commandOf(const JsonView& list, std::span<const std::string_view> commands) {
  std::vector<std::string> command = textsOf(list);
  if (command.empty()) list.fail("is not a list of texts");
  if (std::find(commands.begin(), commands.end(), command.front()) == commands.end()) {
    list[0].fail(fmt::format("is no command of a batch; there are: {}", fmt::join(commands, ", ")));
  }
  const auto count = [&](std::string_view word) { return std::count(command.begin(), command.end(), word); };
  if (count(kBatchInput) != 1) {
    list.fail(fmt::format("does not hold \"{}\" once, as an element of its own", kBatchInput));
  }
  if (count(kBatchOutput) > 1) list.fail(fmt::format("holds \"{}\" more than once", kBatchOutput));
  return command;
}

std::string extensionOf(const JsonView& value) {
  std::string extension = requiredText(value);
  if (extension.size() < 2 || extension.front() != '.' || extension.find_first_of("/\\") != std::string::npos) {
    value.fail("is no extension such as \".glb\"");
  }
  for (const std::string_view several : {".gltf", ".obj", ".usda"}) {
    if (!lowerCase(extension).ends_with(several)) continue;
    value.fail("is a format of several files; take one that is whole, such as \".glb\"");
  }
  return extension;
}

BatchPlan planOf(const JsonView& root, const fs::path& folder, std::span<const std::string_view> commands,
                 const fs::path& outputs) {
  root.requireObject();
  if (root.count(kVersionKey) != 1) root.fail(fmt::format("has no \"{}\": 1", kVersionKey));
  allowKeys(root, {kVersionKey, "command", "output", "inputs", "limits"});
  BatchPlan plan;
  plan.folder = folder;
  plan.command = commandOf(root.array("command"), commands);
  const std::string extension = extensionOf(root.member("output"));
  readJobLimits(root.object("limits"), plan.limits);
  const JsonView inputs = root.array("inputs");
  if (inputs.size() == 0) root.fail("names no inputs");
  EntryList entries(folder, outputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) entries.add(inputs[i]);
  plan.entries = entries.take(extension);
  return plan;
}

}  // namespace

BatchShard parseBatchShard(std::string_view text) {
  BatchShard shard;
  const std::size_t slash = text.find('/');
  const auto number = [&](std::string_view digits, std::size_t& value) {
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return problem == std::errc() && end == digits.data() + digits.size() && value > 0;
  };
  if (slash != std::string_view::npos && number(text.substr(0, slash), shard.number) &&
      number(text.substr(slash + 1), shard.count) && shard.number <= shard.count) {
    return shard;
  }
  throw Error(ErrorCode::kBadArgument, fmt::format("\"{}\" is no shard", validUtf8(text)), {},
              "write its number and how many there are: 3/16");
}

BatchPlan readBatchPlan(const fs::path& file, std::span<const std::string_view> commands, const fs::path& outputs) {
  const Bytes bytes = readFile(file);
  try {
    const Json json = parseStrictly({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const fs::path folder = fs::absolute(file == "-" ? "plan" : file).parent_path();
    return planOf(JsonView(json), folder.lexically_normal(), commands, outputs);
  } catch (const Error& error) {
    throw error.within(file == "-" ? "standard input" : file.string());
  }
}

std::string exampleBatchPlan() {
  return R"({
  "limber_batch": 1,
  "command": ["rig", "{input}", "-o", "{output}", "--handles", "20"],
  "output": ".glb",
  "inputs": ["."],
  "limits": {"seconds": 60, "memory_mb": 2048}
}
)";
}

}  // namespace limber
