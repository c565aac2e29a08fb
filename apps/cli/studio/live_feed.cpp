#include "live_feed.h"

namespace limber::cli {

namespace {

constexpr int kMaxPages = 4;

std::string eventOf(const char* name, const std::string& text) {
  return std::string("event: ") + name + "\ndata: " + text + "\n\n";
}

}  // namespace

void LiveFeed::putSkeleton(std::string text) {
  const std::lock_guard lock(mutex_);
  skeleton_ = std::move(text);
  frame_.clear();  // of another skeleton
  made_.frames = 0;
  ++made_.skeletons;
  changed_.notify_all();
}

void LiveFeed::putFrame(std::string text) {
  const std::lock_guard lock(mutex_);
  frame_ = std::move(text);
  ++made_.frames;
  changed_.notify_all();
}

std::string LiveFeed::next(Seen& seen, std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  const auto isNew = [&] { return seen.skeletons != made_.skeletons || seen.frames != made_.frames; };
  if (!changed_.wait_for(lock, longest, isNew)) return {};
  std::string events;
  if (seen.skeletons != made_.skeletons) events += eventOf("skeleton", skeleton_);
  if (!frame_.empty()) events += eventOf("frame", frame_);
  seen = made_;
  return events;
}

std::optional<LiveFeed::Listener> LiveFeed::enter() {
  const std::lock_guard lock(mutex_);
  if (pages_ == kMaxPages) return std::nullopt;
  ++pages_;
  return Listener(*this);
}

void LiveFeed::leave() {
  const std::lock_guard lock(mutex_);
  --pages_;
}

}  // namespace limber::cli
