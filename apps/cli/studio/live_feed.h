// Live motion between whoever receives it and the pages that show it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace limber::cli {

// The latest skeleton and the latest frame of it, as text: a page that is slow leaves frames out and falls behind by
// none. All calls may come from several threads.
class LiveFeed {
 public:
  void putSkeleton(std::string text);
  void putFrame(std::string text);

  // What a page has seen.
  struct Seen {
    std::size_t skeletons = 0, frames = 0;
  };
  // What it has not, as Server-Sent Events ("event: skeleton", "event: frame", each with its text as the data), once
  // there is something or the time is over: empty then.
  std::string next(Seen& seen, std::chrono::milliseconds longest);

  // One of the pages that may listen at once; nothing where there are as many as may be.
  class Listener {
   public:
    explicit Listener(LiveFeed& feed) : feed_(&feed) {}
    Listener(Listener&& other) noexcept : feed_(std::exchange(other.feed_, nullptr)) {}
    Listener& operator=(Listener&&) = delete;
    ~Listener() {
      if (feed_) feed_->leave();
    }

   private:
    LiveFeed* feed_;
  };
  std::optional<Listener> enter();

 private:
  void leave();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string skeleton_, frame_;
  Seen made_;
  int pages_ = 0;
};

}  // namespace limber::cli
