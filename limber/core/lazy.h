// A value that is computed when it is first asked for, and kept.
#pragma once

#include <mutex>
#include <optional>

namespace limber {

// For any number of threads: the first one computes, others wait. A computation that throws is made again by the next
// one who asks.
template <typename T>
class Lazy {
 public:
  // make  () -> T
  template <typename Make>
  const T& get(Make make) const {
    const std::lock_guard lock(mutex_);
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;  // guarded by mutex_ until it is there; never changed after
};

}  // namespace limber
