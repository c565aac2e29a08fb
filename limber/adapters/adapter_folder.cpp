#include "limber/adapters/adapter_folder.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "limber/core/file/file.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// Names come from plans, too, and must lead nowhere else.
bool isAdapterName(std::string_view name) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  return !name.empty() && name.front() != '.' && name.find_first_not_of(kPlain) == std::string_view::npos;
}

}  // namespace

std::optional<fs::path> usualAdapterFolder() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != '\0') return fs::path(config) / "limber" / "adapters";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return std::nullopt;
  return fs::path(home) / ".config" / "limber" / "adapters";
}

std::vector<std::string> adapterNames(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code unseen;
    for (fs::directory_iterator it(folder, unseen), end; !unseen && it != end; it.increment(unseen)) {
      const std::string name = it->path().stem().string();
      if (it->path().extension() == ".json" && isAdapterName(name)) names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Adapter readAdapter(const fs::path& file) {
  std::error_code unseen;
  const fs::path location = fs::absolute(file, unseen).lexically_normal();
  const Bytes bytes = readFile(location);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Adapter adapter = adapterFromJson(text, location.stem().string());
  adapter.file = location;
  for (AdapterStep& step : adapter.steps) {
    const bool isOfRun = step.folder.empty() || step.folder.string().front() == '{';
    if (!isOfRun) step.folder = location.parent_path() / step.folder;  // an absolute one stays
  }
  return adapter;
}

std::optional<Adapter> findAdapter(std::string_view name, const std::vector<fs::path>& folders) {
  if (!isAdapterName(name)) return std::nullopt;
  for (const fs::path& folder : folders) {
    std::error_code unseen;
    const fs::path file = folder / (std::string(name) + ".json");
    if (fs::exists(file, unseen)) return readAdapter(file);
  }
  return std::nullopt;
}

}  // namespace limber
