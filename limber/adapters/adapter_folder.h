// Where adapters are found: in folders of the user's own, one file each.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/adapters/adapter.h"

namespace limber {

// $XDG_CONFIG_HOME/limber/adapters, or ~/.config/limber/adapters; none where neither variable is set.
std::optional<std::filesystem::path> usualAdapterFolder();

// The names of the files NAME.json in these folders, in order, each once. A folder that is not there holds none.
std::vector<std::string> adapterNames(const std::vector<std::filesystem::path>& folders);

// Named after the file. Throws Error kFile, and as adapterFromJson does. Folders that its steps work in are seen from
// the file's own.
Adapter readAdapter(const std::filesystem::path& file);

// The adapter of that name, from the first folder that has it; none where no folder does. A name with anything but
// letters, digits, '-', '_' and '.' is none. Throws as readAdapter does.
std::optional<Adapter> findAdapter(std::string_view name, const std::vector<std::filesystem::path>& folders);

}  // namespace limber
