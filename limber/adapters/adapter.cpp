#include "limber/adapters/adapter.h"

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/adapters/job_limits.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_keys.h"

namespace limber {

namespace {

constexpr std::string_view kVersionKey = "limber_adapter";
constexpr double kMinSize = 1e-3, kMaxSize = 1e6, kMinUnit = 1e-6, kMaxUnit = 1e6;
// Learned riggers load networks of gigabytes.
constexpr std::size_t kMemoryByDefault = std::size_t{16384} << 20;

struct NamedKind {
  std::string_view name;
  AdapterKind kind;
};
constexpr std::array kKinds = {NamedKind{"rig", AdapterKind::kRig}, NamedKind{"weights", AdapterKind::kWeights},
                               NamedKind{"retarget", AdapterKind::kRetarget}};

struct NamedFormat {
  std::string_view name, extension;
  AdapterFormat format;
};
constexpr std::array kFormats = {
    NamedFormat{"obj", ".obj", AdapterFormat::kObj}, NamedFormat{"glb", ".glb", AdapterFormat::kGlb},
    NamedFormat{"fbx", ".fbx", AdapterFormat::kFbx}, NamedFormat{"rignet-text", ".txt", AdapterFormat::kRignetText},
    NamedFormat{"bvh", ".bvh", AdapterFormat::kBvh}};

struct NamedUp {
  std::string_view name;
  AdapterUp up;
};
constexpr std::array kUps = {NamedUp{"+y", AdapterUp::kY}, NamedUp{"+z", AdapterUp::kZ}};

constexpr std::array kMotions = {AdapterFormat::kBvh};

// What can go in and come out, the first by default.
std::span<const AdapterFormat> inputFormatsOf(AdapterKind kind) {
  static constexpr std::array kRig = {AdapterFormat::kObj, AdapterFormat::kGlb};
  static constexpr std::array kWeights = {AdapterFormat::kGlb};
  if (kind == AdapterKind::kRetarget) return kMotions;
  if (kind == AdapterKind::kRig) return kRig;
  return kWeights;
}

std::span<const AdapterFormat> outputFormatsOf(AdapterKind kind) {
  static constexpr std::array kRig = {AdapterFormat::kRignetText, AdapterFormat::kGlb, AdapterFormat::kFbx};
  static constexpr std::array kWeights = {AdapterFormat::kGlb, AdapterFormat::kFbx};
  if (kind == AdapterKind::kRetarget) return kMotions;
  if (kind == AdapterKind::kRig) return kRig;
  return kWeights;
}

const NamedFormat& formatEntry(AdapterFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(), [&](const NamedFormat& f) { return f.format == format; });
}

template <typename Table>
const auto& entryOf(const Table& table, const JsonView& object, std::string_view key, std::string_view byDefault) {
  const std::string_view name = object.exists() ? object.text(key, byDefault) : byDefault;
  std::string known;
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  object.member(key).fail(fmt::format("is none of {}", known));
}

AdapterFormat formatOf(const JsonView& object, std::span<const AdapterFormat> possible, std::string_view kind) {
  std::vector<NamedFormat> table;
  for (const AdapterFormat format : possible) table.push_back(formatEntry(format));
  const std::string_view name = object.exists() ? object.text("format", table.front().name) : table.front().name;
  std::string known;
  for (const NamedFormat& entry : table) {
    if (entry.name == name) return entry.format;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  object.member("format").fail(fmt::format("is none of {}, which go with the kind {}", known, kind));
}

// Calls `take` with each piece of `text`: plain, or the name of a placeholder. Braces round anything but small letters
// and underscores are plain text, as in a line of a program.
void walkPlaceholders(std::string_view text, const std::function<void(std::string_view piece, bool isName)>& take) {
  std::size_t plainFrom = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '{') continue;
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", at + 1);
    if (end == std::string_view::npos || text[end] != '}' || end == at + 1) continue;
    take(text.substr(plainFrom, at - plainFrom), false);
    take(text.substr(at + 1, end - at - 1), true);
    plainFrom = end + 1;
    at = end;
  }
  take(text.substr(plainFrom), false);
}

std::span<const std::string_view> placeholdersOf(AdapterKind kind) {
  static constexpr std::array<std::string_view, 5> kModels = {"folder", "input", "input_folder", "output", "seed"};
  static constexpr std::array<std::string_view, 6> kOfMotions = {"folder",       "motion", "skeleton",
                                                                 "input_folder", "output", "seed"};
  if (kind == AdapterKind::kRetarget) return kOfMotions;
  return kModels;
}

void checkPlaceholders(const JsonView& location, std::string_view text, AdapterKind kind) {
  const std::span<const std::string_view> known = placeholdersOf(kind);
  walkPlaceholders(text, [&](std::string_view name, bool isName) {
    if (!isName) return;
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      location.fail(
          fmt::format("has a placeholder that is not known: {{{}}}; there are: {}", name, fmt::join(known, ", ")));
    }
  });
}

// For a command or a path.
std::string argumentOf(const JsonView& value) {
  std::string text = requiredText(value);
  if (text.find('\0') != std::string::npos) value.fail("holds a zero byte");
  return text;
}

AdapterStep stepOf(const JsonView& entry, AdapterKind kind) {
  entry.requireObject();
  allowKeys(entry, {"command", "folder"});
  AdapterStep step;
  const JsonView command = entry.array("command");
  for (std::size_t i = 0; i < command.size(); ++i) {
    step.command.push_back(argumentOf(command[i]));
    checkPlaceholders(command[i], step.command.back(), kind);
  }
  if (step.command.empty()) entry.fail("has no command");
  if (const JsonView folder = entry.member("folder"); folder.exists()) {
    step.folder = argumentOf(folder);
    checkPlaceholders(folder, step.folder.string(), kind);
  }
  return step;
}

void readSteps(const JsonView& root, Adapter& adapter) {
  const JsonView steps = root.array("steps");
  for (std::size_t i = 0; i < steps.size(); ++i) adapter.steps.push_back(stepOf(steps[i], adapter.kind));
  if (adapter.steps.empty()) root.fail("has no steps");
  std::vector<std::string> named;
  for (const AdapterStep& step : adapter.steps) {
    for (const std::string& argument : step.command) {
      walkPlaceholders(argument, [&](std::string_view name, bool isName) {
        if (isName) named.emplace_back(name);
      });
    }
  }
  const auto isNamed = [&](std::string_view name) {
    return std::find(named.begin(), named.end(), name) != named.end() ||
           std::find(named.begin(), named.end(), "input_folder") != named.end() ||
           std::find(named.begin(), named.end(), "folder") != named.end();
  };
  if (adapter.kind == AdapterKind::kRetarget && !(isNamed("motion") && isNamed("skeleton"))) {
    steps.fail("never name the files that are handed over: {motion} and {skeleton}, or {input_folder}");
  }
  if (adapter.kind != AdapterKind::kRetarget && !isNamed("input")) {
    steps.fail("never name the file that is handed over: {input} or {input_folder}");
  }
}

// Of lengths in a BVH, which does not say its own.
double unitOf(const JsonView& object, double byDefault) {
  constexpr std::string_view kKey = "metres_per_unit";
  const double unit = object.exists() ? object.number(kKey, byDefault) : byDefault;
  if (!(unit >= kMinUnit && unit <= kMaxUnit)) {
    object.member(kKey).fail(fmt::format("is not from {} to {}", kMinUnit, kMaxUnit));
  }
  return unit;
}

void readMotions(const JsonView& input, const JsonView& output, Adapter& adapter) {
  if (input.exists()) allowKeys(input, {"format", "up", "metres_per_unit"});
  if (output.exists()) allowKeys(output, {"format", "up", "metres_per_unit", "file"});
  adapter.inputMetresPerUnit = unitOf(input, 1);
  adapter.outputMetresPerUnit = unitOf(output, adapter.inputMetresPerUnit);
}

void readInput(const JsonView& input, Adapter& adapter) {
  if (input.exists() && adapter.kind == AdapterKind::kRig) allowKeys(input, {"format", "up", "size"});
  if (input.exists() && adapter.kind == AdapterKind::kWeights) allowKeys(input, {"format", "up", "size", "weights"});
  adapter.inputFormat = formatOf(input, inputFormatsOf(adapter.kind), adapterKindName(adapter.kind));
  adapter.inputUp = entryOf(kUps, input, "up", "+y").up;
  if (adapter.inputUp != AdapterUp::kY && adapter.inputFormat == AdapterFormat::kGlb) {
    input.member("up").fail("is not +y, which a GLB always has");
  }
  if (input.exists()) adapter.inputSize = input.number("size", adapter.inputSize);
  if (!(adapter.inputSize >= kMinSize && adapter.inputSize <= kMaxSize)) {
    input.member("size").fail(fmt::format("is not from {} to {}", kMinSize, kMaxSize));
  }
  if (input.exists()) adapter.takesWeights = input.flag("weights", true);
}

void readOutput(const JsonView& output, Adapter& adapter) {
  const bool isMotion = adapter.kind == AdapterKind::kRetarget;
  if (output.exists() && !isMotion) allowKeys(output, {"format", "up", "file", "may_rescale", "weights"});
  adapter.outputFormat = formatOf(output, outputFormatsOf(adapter.kind), adapterKindName(adapter.kind));
  const bool isText = adapter.outputFormat == AdapterFormat::kRignetText;
  const bool isTurned = (isText || isMotion) && adapter.inputUp == AdapterUp::kZ;
  adapter.outputUp = entryOf(kUps, output, "up", isTurned ? "+z" : "+y").up;
  adapter.outputFile =
      fmt::format("output/{}{}", adapterFileStem(adapter.kind), adapterExtension(adapter.outputFormat));
  if (!output.exists()) return;
  if (const JsonView file = output.member("file"); file.exists()) {
    adapter.outputFile = argumentOf(file);
    const std::filesystem::path path(adapter.outputFile);
    const bool leaves = std::find(path.begin(), path.end(), "..") != path.end();
    if (path.is_absolute() || leaves) file.fail("does not lie in the run's folder, from which it is seen");
  }
  adapter.mayRescale = output.flag("may_rescale", false);
  if (adapter.mayRescale && isText) output.member("may_rescale").fail("needs a surface in the file that comes back");
  adapter.ignoresWeights = !output.flag("weights", true);
  if (adapter.ignoresWeights && adapter.kind != AdapterKind::kRig) {
    output.member("weights").fail("is for riggers alone");
  }
}

Adapter adapterOf(const JsonView& root) {
  root.requireObject();
  if (root.count(kVersionKey) != 1) root.fail(fmt::format("has no \"{}\": 1", kVersionKey));
  allowKeys(root, {kVersionKey, "summary", "kind", "steps", "input", "output", "limits", "seed"});
  Adapter adapter;
  adapter.summary = root.text("summary");
  adapter.kind = entryOf(kKinds, root, "kind", "").kind;
  readSteps(root, adapter);
  if (adapter.kind == AdapterKind::kRetarget) readMotions(root.object("input"), root.object("output"), adapter);
  readInput(root.object("input"), adapter);
  readOutput(root.object("output"), adapter);
  adapter.limits.memory = kMemoryByDefault;
  readJobLimits(root.object("limits"), adapter.limits);
  adapter.seed = root.count("seed").value_or(0);
  return adapter;
}

}  // namespace

std::string_view adapterKindName(AdapterKind kind) {
  return std::find_if(kKinds.begin(), kKinds.end(), [&](const NamedKind& k) { return k.kind == kind; })->name;
}

std::string_view adapterExtension(AdapterFormat format) {
  return formatEntry(format).extension;
}

std::string_view adapterFileStem(AdapterKind kind) {
  return kind == AdapterKind::kRetarget ? "motion" : "model";
}

Adapter adapterFromJson(std::string_view text, std::string name) {
  try {
    const Json json = parseStrictly(text);
    Adapter adapter = adapterOf(JsonView(json));
    adapter.name = std::move(name);
    return adapter;
  } catch (const Error& error) {
    throw error.within("adapter " + name);
  }
}

std::string filledIn(std::string_view text, const AdapterPaths& paths, std::uint64_t seed) {
  std::string result;
  walkPlaceholders(text, [&](std::string_view piece, bool isName) {
    if (!isName) {
      result += piece;
    } else if (piece == "folder") {
      result += paths.folder.string();
    } else if (piece == "input" || piece == "motion") {
      result += paths.input.string();
    } else if (piece == "skeleton") {
      result += paths.skeleton.string();
    } else if (piece == "input_folder") {
      result += paths.input.parent_path().string();
    } else if (piece == "output") {
      result += paths.output.string();
    } else {
      result += std::to_string(seed);
    }
  });
  return result;
}

}  // namespace limber
