#include "live_receiver.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "limber/document/bvh/bvh_stream.h"
#include "limber/document/live/live_text.h"
#include "limber/document/live/vmc_stream.h"

namespace limber::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxPacket = 16 * 1024;           // bytes; VMC's have one or two kB
constexpr std::size_t kMaxPackets = 20'000;             // a second
constexpr int kMaxAtOnce = 1000;                        // packets, before there is a look at other things
constexpr std::size_t kMaxBvhBytes = 16 * 1024 * 1024;  // a second
constexpr double kFrameSeconds = 1.0 / 250;             // between two frames that are handed on
constexpr int kReceiverPoll = 50;                       // milliseconds between two looks whether it is over

// Counts how much comes within each second.
class PerSecond {
 public:
  explicit PerSecond(std::size_t most) : most_(most) {}
  bool isSpent(double seconds) {
    if (seconds >= begun_ + 1) {
      begun_ = seconds;
      taken_ = 0;
    }
    return taken_ >= most_;
  }
  void add(std::size_t amount) { taken_ += amount; }

 private:
  std::size_t most_, taken_ = 0;
  double begun_ = 0;
};

int boundSocket(int type, int& port, const char* option) {
  const int made = socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  auto* const at = reinterpret_cast<sockaddr*>(&address);
  const int yes = 1;
  if (type == SOCK_STREAM) setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (made < 0 || bind(made, at, size) != 0 || (type == SOCK_STREAM && listen(made, 1) != 0) ||
      getsockname(made, at, &size) != 0) {
    if (made >= 0) close(made);
    throw Error(ErrorCode::kFile, fmt::format("the port {} cannot be listened on", port), "127.0.0.1",
                fmt::format("another program has it: choose one by {}", option));
  }
  port = ntohs(address.sin_port);
  return made;
}

// Forwards what one sender's stream has decoded to the pages.
class LiveSender {
 public:
  explicit LiveSender(LiveFeed& feed) : feed_(feed) {}

  void show(const Skeleton& skeleton, std::size_t number) {
    if (number == shown_) return;
    shown_ = number;
    feed_.putSkeleton(liveSkeletonText(skeleton));
  }
  void show(const Pose& pose, double seconds) { feed_.putFrame(liveFrameText(pose, seconds)); }
  // Whoever shows its skeleton afterwards shows it anew.
  void forget() { shown_ = 0; }

 private:
  LiveFeed& feed_;
  std::size_t shown_ = 0;
};

class VmcReceiver {
 public:
  VmcReceiver(int socket, LiveFeed& feed) : socket_(socket), sender_(feed) {}

  void receive(double seconds) {
    for (int packet = 0; packet < kMaxAtOnce; ++packet) {
      const ssize_t size = recv(socket_, buffer_.data(), buffer_.size(), MSG_TRUNC);
      if (size < 0) return;
      if (static_cast<std::size_t>(size) > kMaxPacket || rate_.isSpent(seconds)) continue;
      rate_.add(1);
      stream_.take({buffer_.data(), static_cast<std::size_t>(size)}, seconds);
    }
  }
  bool hasFrame() const { return stream_.taken() != handed_; }
  void handOn(double seconds) {
    const Skeleton* const skeleton = stream_.skeleton(seconds);
    handed_ = stream_.taken();
    if (!skeleton) return;
    sender_.show(*skeleton, stream_.skeletonNumber());
    sender_.show(stream_.pose(), seconds);
  }
  void forget() { sender_.forget(); }

 private:
  int socket_;
  LiveSender sender_;
  VmcStream stream_;
  PerSecond rate_{kMaxPackets};
  std::size_t handed_ = 0;
  std::array<std::uint8_t, kMaxPacket + 1> buffer_;
};

class BvhReceiver {
 public:
  BvhReceiver(int listening, LiveFeed& feed, const std::function<void(const std::string&)>& tell)
      : listening_(listening), sender_(feed), tell_(tell) {}
  ~BvhReceiver() { hangUp(); }
  BvhReceiver(const BvhReceiver&) = delete;
  BvhReceiver& operator=(const BvhReceiver&) = delete;

  // Has it sent more than it may within this second? What follows then waits.
  bool rests(double seconds) { return connection_ >= 0 && rate_.isSpent(seconds); }
  // To wait for: the sender, or the next one.
  int socket() const { return connection_ >= 0 ? connection_ : listening_; }

  void receive(double seconds) {
    if (connection_ < 0) {
      connection_ = accept4(listening_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
      if (connection_ >= 0) stream_.emplace();
      handed_ = 0;
      sender_.forget();
    }
    while (connection_ >= 0 && !rests(seconds)) {
      const ssize_t size = recv(connection_, buffer_.data(), buffer_.size(), 0);
      if (size == 0) hangUp();
      if (size <= 0) return;
      rate_.add(static_cast<std::size_t>(size));
      try {
        stream_->take({buffer_.data(), static_cast<std::size_t>(size)});
      } catch (const Error& error) {
        if (tell_) tell_(error.what());
        hangUp();
      }
    }
  }
  bool hasFrame() const { return stream_ && stream_->rows() != handed_; }
  void handOn(double seconds) {
    handed_ = stream_->rows();
    sender_.show(*stream_->skeleton(), 1);
    sender_.show(stream_->pose(), seconds);
  }
  void forget() { sender_.forget(); }

 private:
  void hangUp() {
    if (connection_ >= 0) close(connection_);
    connection_ = -1;
  }

  int listening_, connection_ = -1;
  LiveSender sender_;
  const std::function<void(const std::string&)>& tell_;
  std::optional<BvhStream> stream_;
  PerSecond rate_{kMaxBvhBytes};
  std::size_t handed_ = 0;
  std::array<char, 16 * 1024> buffer_;
};

}  // namespace

LiveReceiver::LiveReceiver(LivePorts ports, LiveFeed& feed, std::function<void(const std::string&)> tell)
    : ports_(ports), feed_(feed), tell_(std::move(tell)) {
  udp_ = boundSocket(SOCK_DGRAM, ports_.vmc, "--vmc-port");
  try {
    tcp_ = boundSocket(SOCK_STREAM, ports_.bvh, "--bvh-port");
  } catch (const Error&) {
    close(udp_);
    throw;
  }
  thread_ = std::thread([this] { run(); });
}

LiveReceiver::~LiveReceiver() {
  over_ = true;
  thread_.join();
  close(udp_);
  close(tcp_);
}

// Everything that has come is taken before the latest of it is handed on, so that packets of one frame go together.
void LiveReceiver::run() {
  VmcReceiver vmc(udp_, feed_);
  BvhReceiver bvh(tcp_, feed_, tell_);
  const Clock::time_point begun = Clock::now();
  const auto now = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  double handed = -1;
  while (!over_) {
    const double left = handed + kFrameSeconds - now();
    const bool waits = (vmc.hasFrame() || bvh.hasFrame()) && left > 0;
    std::array<pollfd, 2> sockets = {pollfd{udp_, POLLIN, 0}, pollfd{bvh.rests(now()) ? -1 : bvh.socket(), POLLIN, 0}};
    poll(sockets.data(), sockets.size(), waits ? static_cast<int>(left * 1000) + 1 : kReceiverPoll);
    if (sockets[0].revents != 0) vmc.receive(now());
    if (sockets[1].revents != 0) bvh.receive(now());
    if (now() < handed + kFrameSeconds) continue;
    // The one that sends last is shown.
    if (bvh.hasFrame()) {
      bvh.handOn(now());
      vmc.forget();
      handed = now();
    } else if (vmc.hasFrame()) {
      vmc.handOn(now());
      bvh.forget();
      handed = now();
    }
  }
}

}  // namespace limber::cli
