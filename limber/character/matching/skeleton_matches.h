// Readings and matches of skeletons, each made once.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "limber/character/matching/skeleton_map.h"

namespace limber {

// Two skeletons are the same where their joints have the same names, declared bones, parents and rest transforms, and
// are read in the same pose, whatever file they came from. For any number of threads: what two ask for at once is made
// by one, while the other waits.
class SkeletonMatches {
 public:
  // As matchSkeletons, whose errors it throws.
  SkeletonMap match(const SkeletonReading& source, const SkeletonReading& target, bool unlikeBodies,
                    const Pose* sourcePose = nullptr);

  // A reading of the skeleton, which others have who ask for one of the same.
  SkeletonReading reading(const Skeleton& skeleton);

  // How many matches were made.
  std::size_t made() const;

 private:
  struct Entry {
    std::mutex making;
    std::optional<SkeletonMap> map;  // guarded by `making`
  };
  std::shared_ptr<Entry> entryOf(std::string key);

  mutable std::mutex mutex_;  // guards the rest
  std::map<std::string, SkeletonReading> readings_;
  std::map<std::string, std::shared_ptr<Entry>> entries_;
  std::deque<std::string> byAge_;  // keys, the oldest first
  std::size_t made_ = 0;
};

}  // namespace limber
