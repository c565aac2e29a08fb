// Motion that other programs of this machine send: VMC's packets by UDP, a BVH line by line by TCP.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "live_feed.h"

namespace limber::cli {

struct LivePorts {
  int vmc = 39539;  // as the protocol has it
  int bvh = 39540;
};

// Listens on 127.0.0.1 alone and gives `feed` what comes, as limber/document/live/live_text.h writes it, until it is
// destroyed. Packets are of 16 KiB at most and 20,000 a second, a BVH of one sender at a time and 16 MiB a second; what
// is more is dropped, or waits. At most 250 frames a second are handed on, the latest of each moment. A sender whose
// BVH breaks the format is hung up on, and `tell` says why: so is a web page, whose requests are none.
class LiveReceiver {
 public:
  // Throws Error kFile where a port is taken. 0 takes a free one.
  LiveReceiver(LivePorts ports, LiveFeed& feed, std::function<void(const std::string&)> tell);
  ~LiveReceiver();
  LiveReceiver(const LiveReceiver&) = delete;
  LiveReceiver& operator=(const LiveReceiver&) = delete;

  LivePorts ports() const { return ports_; }

 private:
  void run();

  LivePorts ports_;
  LiveFeed& feed_;
  std::function<void(const std::string&)> tell_;
  int udp_ = -1, tcp_ = -1;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace limber::cli
