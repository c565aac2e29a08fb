// Names that must not be given twice.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace limber {

class UniqueNames {
 public:
  // `wanted`, or the first of wanted_2, wanted_3, ... that was not added before; counts as added from now on.
  std::string add(const std::string& wanted) {
    if (used_.insert(wanted).second) return wanted;
    // Goes on counting where the last one of that name stopped: thousands of equal names stay cheap.
    for (std::size_t& n = next_.try_emplace(wanted, 2).first->second;; ++n) {
      std::string name = wanted + "_" + std::to_string(n);
      if (used_.insert(name).second) return name;
    }
  }

 private:
  std::unordered_set<std::string> used_;
  std::unordered_map<std::string, std::size_t> next_;
};

}  // namespace limber
