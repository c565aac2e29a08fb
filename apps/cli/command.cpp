#include "command.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/counted.h"
#include "limber/core/file/storage_error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/names.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/json_text.h"

namespace limber::cli {

namespace {

constexpr const char* kNotForPlans = "not for plans";  // a validator's name

bool isSameLocation(const std::string& a, const std::string& b) {
  if (a == b) return true;
  if (a == "-" || b == "-") return false;
  std::error_code unseen;  // of files that are not there
  if (std::filesystem::equivalent(a, b, unseen)) return true;
  const auto locationOf = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, unseen), unseen);
  };
  return locationOf(a) == locationOf(b);
}

Warnings& allGiven() {
  static Warnings all;
  return all;
}

}  // namespace

void Common::addTo(CLI::App& command) {
  command.add_flag("--quiet,-q", quiet, "print nothing but errors");
  command.add_option("--threads", threads, "threads to use; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->type_name("T");
}

void Common::apply() const {
  setThreadCount(threads);
}

void Account::line(std::string_view text) const {
  if (!quiet_) fmt::print(toError_ ? stderr : stdout, "{}\n", printable(text));
}

const Warnings& givenWarnings() {
  return allGiven();
}

void printWarnings(const Warnings& warnings, bool quiet) {
  allGiven().append(warnings);
  if (quiet) return;
  for (const Warning& warning : warnings.items()) {
    const std::string_view at = warning.count == 1 ? "at" : "first at";
    const std::string where = warning.where.empty() ? "" : fmt::format(", {} {}", at, warning.where);
    fmt::print(stderr, "warning: {} [{}]{}\n", printable(warningText(warning)), warning.kind, printable(where));
  }
}

void refuseWarnings(const Warnings& warnings) {
  if (warnings.empty()) return;
  const Warning& first = warnings.items().front();
  const std::size_t others = warnings.items().size() - 1;
  throw Error(
      ErrorCode::kBadData,
      warningText(first) + (others == 0 ? "" : fmt::format(", and {} of warning", counted(others, "other kind"))),
      first.where, "--strict takes warnings as errors");
}

void refuseNothing(bool isEmpty, const Warnings& skipped) {
  if (!isEmpty) return;
  if (skipped.empty()) throw Error(ErrorCode::kBadData, "there is nothing to compare");
  const Warning& first = skipped.items().front();
  throw Error(ErrorCode::kBadData, "there is nothing to compare: " + warningText(first), first.where);
}

std::string joinNames(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void checkOutput(std::string_view path, const std::vector<std::string_view>& extensions) {
  if (path == "-") return;
  const std::string extension = lowerExtension(path);
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
  throw Error(ErrorCode::kBadArgument, "the name of the output does not say a format that this command writes",
              std::string(path), fmt::format("end it in {}", fmt::join(extensions, " or ")));
}

void checkBeside(const std::string& option, const std::string& path, const std::vector<std::string>& others) {
  if (path.empty()) return;
  for (const std::string& other : others) {
    if (!isSameLocation(path, other)) continue;
    throw CLI::ValidationError(option, fmt::format("{} would take the place of {}", path, other));
  }
}

CLI::Option* addMarkdownOutput(CLI::App& command, std::string& output, std::string_view what) {
  return command.add_option("-o,--output", output, fmt::format("{} to write, in Markdown; - is standard output", what))
      ->type_name("FILE")
      ->capture_default_str();
}

CLI::Validator notForPlans() {
  return CLI::Validator([](std::string&) { return std::string(); }, "", kNotForPlans);
}

bool isForPlans(CLI::Option& option) {
  try {
    option.get_validator(kNotForPlans);
    return false;
  } catch (const CLI::OptionNotFound&) {
    return true;
  }
}

CLI::Validator numberIn(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
        return fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
      },
      "");
}

CLI::Validator seedNumber() {
  return CLI::Validator(
      [](std::string& text) {
        if (text.find_first_not_of("0123456789") == std::string::npos) return std::string();
        return fmt::format("Value {} is no whole number from 0", text);
      },
      "");
}

CLI::Validator momentOfClip() {
  return numberIn(0, 1e6);
}

void printText(std::string_view text) {
  fmt::print("{}", printableText(text));
}

void printJson(const Json& json) {
  fmt::print("{}\n", dumpReport(json));
}

void writeText(const std::string& path, const std::string& text) {
  writeFile(path, asBytes(printableText(text)));
}

void writeTexts(const std::string& pathBeside, const std::string& beside, const std::string& path,
                const std::string& text) {
  const std::string plainBeside = printableText(beside), plain = printableText(text);
  std::vector<OutputFile> files;
  if (!pathBeside.empty()) files.push_back({pathBeside, asBytes(plainBeside)});
  files.push_back({path, asBytes(plain)});
  writeFiles(files);
}

void flushOutput() {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  if (errno != 0) failToWrite("standard output", errno);
  throw Error(ErrorCode::kFile, "cannot be written: it is closed", "standard output");
}

}  // namespace limber::cli
