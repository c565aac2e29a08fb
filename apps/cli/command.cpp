#include "command.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "limber/core/names.h"
#include "limber/core/parallel.h"

namespace limber::cli {

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
  if (!quiet_) fmt::print(toError_ ? stderr : stdout, "{}\n", text);
}

void printWarnings(const Warnings& warnings, bool quiet) {
  if (quiet) return;
  for (const Warning& warning : warnings.items()) {
    const std::string where = warning.where.empty() ? "" : fmt::format(", first at {}", warning.where);
    fmt::print(stderr, "warning: {} {} [{}]{}\n", warning.count, warning.message, warning.kind, where);
  }
}

void refuseWarnings(const Warnings& warnings) {
  if (warnings.empty()) return;
  const Warning& first = warnings.items().front();
  const std::size_t others = warnings.items().size() - 1;
  throw Error(ErrorCode::kBadData,
              fmt::format("{} {}{}", first.count, first.message,
                          others == 0 ? "" : fmt::format(", and {} other kinds of warning", others)),
              first.where, "--strict takes warnings as errors");
}

std::string joinNames(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void checkOutput(std::string_view path, std::initializer_list<std::string_view> extensions) {
  if (path == "-") return;
  const std::string extension = lowerExtension(path);
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
  throw Error(ErrorCode::kBadArgument, "the name of the output does not say a format that this command writes",
              std::string(path), fmt::format("end it in {}", fmt::join(extensions, " or ")));
}

void writeText(const std::string& path, const std::string& text) {
  writeFile(path, asBytes(text));
}

void flushOutput() {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  throw Error(ErrorCode::kFile,
              fmt::format("cannot be written: {}", errno != 0 ? std::strerror(errno) : "it is closed"),
              "standard output");
}

}  // namespace limber::cli
