#include "adapter_arguments.h"

#include <algorithm>

#include <fmt/format.h>

#include "command.h"
#include "limber/adapters/adapter_folder.h"
#include "limber/core/error.h"

namespace limber::cli {

void AdapterArguments::addFolderTo(CLI::App& command) {
  command
      .add_option("--adapter-folder", folders,
                  "look here first for NAME.json, which tells how a program of yours is run (docs/adapters.md)")
      ->check(notForPlans())
      ->type_name("FOLDER")
      ->allow_extra_args(false);
}

void AdapterArguments::addTo(CLI::App& command) {
  addFolderTo(command);
  command.add_option("--adapter", files, "such a file, under its name without .json")
      ->check(notForPlans())
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--seed", seed, "what such a program is given as {seed} (default: the adapter's)")
      ->check(seedNumber())
      ->type_name("N");
}

std::vector<std::filesystem::path> AdapterArguments::allFolders() const {
  std::vector<std::filesystem::path> all(folders.begin(), folders.end());
  if (const auto usual = usualAdapterFolder()) all.push_back(*usual);
  return all;
}

std::optional<Adapter> AdapterArguments::programFor(std::string_view name, std::string_view what, AdapterKind kind,
                                                    const std::vector<std::string>& known) const {
  if (std::find(known.begin(), known.end(), name) != known.end()) return std::nullopt;
  const std::vector<std::filesystem::path> all = allFolders();
  const auto isCalledSo = [&](const std::string& file) { return std::filesystem::path(file).stem() == name; };
  const auto file = std::find_if(files.begin(), files.end(), isCalledSo);
  std::optional<Adapter> adapter = file != files.end() ? readAdapter(*file) : findAdapter(name, all);
  if (!adapter) {
    std::vector<std::string> names = known;
    for (const std::string& one : adapterNames(all)) names.push_back(one);
    throw Error(ErrorCode::kBadArgument, fmt::format("no {} is called '{}'", what, name), {},
                fmt::format("there are: {}; programs of yours are NAME.json in {}", joinNames(names),
                            all.empty() ? "a folder given by --adapter-folder" : all.back().string()));
  }
  if (adapter->kind != kind) {
    throw Error(ErrorCode::kBadArgument, fmt::format("is of kind {}, no {}", adapterKindName(adapter->kind), what),
                fmt::format("adapter {}", name));
  }
  if (seed) adapter->seed = *seed;
  return adapter;
}

void AdapterArguments::refuseUnused(const std::vector<std::string>& methods, bool hasProgram) const {
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).stem().string();
    if (std::find(methods.begin(), methods.end(), name) != methods.end()) continue;
    throw CLI::ValidationError("--adapter", fmt::format("{} is not used: ask for the method '{}'", file, name));
  }
  if (seed && !hasProgram) throw CLI::ValidationError("--seed", "is for a program of yours");
}

}  // namespace limber::cli
