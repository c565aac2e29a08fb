#include "command.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include <fmt/format.h>

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

void printWarnings(const Account& account, const Warnings& warnings) {
  for (const Warning& warning : warnings.items()) {
    const std::string where = warning.where.empty() ? "" : fmt::format(", first at {}", warning.where);
    account.line(fmt::format("warning: {} {} [{}]{}", warning.count, warning.message, warning.kind, where));
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
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
  throw Error(ErrorCode::kBadArgument, "the name of the output does not say a format that this command writes",
              std::string(path), fmt::format("end it in {}", fmt::join(extensions, " or ")));
}

void writeText(const std::string& path, const std::string& text) {
  writeFile(path, asBytes(text));
}

}  // namespace limber::cli
