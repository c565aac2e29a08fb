#include "limber/character/matching/skeleton_matches.h"

#include <cstdint>

namespace limber {

namespace {

// Matches, and readings; 16 and more; that are kept at once: bounds memory. The oldest matches go, so that a thousand bodies of as many
// builds need no more memory. A key and a map of 100 joints take some 40 KB.
constexpr std::size_t kMaxKept = 256;

template <typename Number>
void addBytes(std::string& key, const Number& number) {
  key.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void addBytes(std::string& key, const Transform& transform) {
  for (int i = 0; i < 3; ++i) addBytes(key, transform.translation[i]);
  for (int i = 0; i < 4; ++i) addBytes(key, transform.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) addBytes(key, transform.scale[i]);
}

void addBytes(std::string& key, const Skeleton& skeleton) {
  addBytes(key, skeleton.jointCount());
  addBytes(key, skeleton.boneShape);
  for (const Joint& joint : skeleton.joints) {
    addBytes(key, static_cast<std::uint64_t>(joint.name.size()));
    key += joint.name;
    addBytes(key, static_cast<std::uint64_t>(joint.declaredBone.size()));
    key += joint.declaredBone;
    addBytes(key, joint.parent.value_or(kNoIndex));
    addBytes(key, joint.radius);
    addBytes(key, joint.rest);
  }
}

}  // namespace

std::shared_ptr<SkeletonMatches::Entry> SkeletonMatches::entryOf(std::string key) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Entry>& entry = entries_[key];
  if (entry) return entry;
  entry = std::make_shared<Entry>();
  std::shared_ptr<Entry> made = entry;
  byAge_.push_back(std::move(key));
  if (byAge_.size() > kMaxKept) {
    entries_.erase(byAge_.front());
    byAge_.pop_front();
  }
  return made;
}

SkeletonReading SkeletonMatches::reading(const Skeleton& skeleton) {
  std::string key;
  addBytes(key, skeleton);
  const std::lock_guard lock(mutex_);
  if (readings_.size() >= kMaxKept) readings_.clear();
  return readings_.try_emplace(std::move(key), skeleton).first->second;
}

SkeletonMap SkeletonMatches::match(const SkeletonReading& source, const SkeletonReading& target, bool unlikeBodies,
                                   const Pose* sourcePose) {
  std::string key;
  addBytes(key, unlikeBodies);
  addBytes(key, source.skeleton());
  addBytes(key, target.skeleton());
  if (sourcePose) {
    for (const Transform& local : sourcePose->locals) addBytes(key, local);
  }
  const std::shared_ptr<Entry> entry = entryOf(std::move(key));
  const std::lock_guard lock(entry->making);  // matching starts no threads that could wait for this one
  if (!entry->map) {
    entry->map = matchSkeletons(source, target, unlikeBodies, sourcePose);
    const std::lock_guard count(mutex_);
    ++made_;
  }
  return *entry->map;
}

std::size_t SkeletonMatches::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

}  // namespace limber
