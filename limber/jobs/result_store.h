// A folder of results by key that survives an end at any moment.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace limber {

// One text for each key. A text is there as a whole or not at all: it is written to a temporary file beside its final
// path and renamed. What an earlier run left half written is removed at the start. Only one store at a time may be open
// in a folder, in any process.
class ResultStore {
 public:
  // Makes the folder where it is missing. Throws Error kFile: it cannot be made, or another program has it open.
  explicit ResultStore(std::filesystem::path folder);
  ResultStore(const ResultStore&) = delete;
  ResultStore& operator=(const ResultStore&) = delete;
  ~ResultStore();

  // None where nothing is kept.
  std::optional<std::string> find(const std::string& key) const;
  void keep(const std::string& key, std::string_view text);

 private:
  std::filesystem::path pathOf(const std::string& key) const;

  std::filesystem::path folder_;
  int lock_ = -1;
};

}  // namespace limber
