#include "bounded_server.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <semaphore>
#include <string_view>
#include <utility>

namespace limber::cli {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t kMaxRequestBytes = 16 * 1024;  // line and headers; a browser's have one or two kB
constexpr std::size_t kMaxWritten = 16 * 1024;       // at once: a record of TLS
constexpr auto kMaxRequestTime = 10s;                // for all of a request, the handshake before it included
constexpr auto kMaxWriteTime = 10s;                  // for one piece
constexpr auto kMaxGoodbyeTime = 1s;                 // for what comes behind a last request
constexpr std::size_t kMaxUnread = 256 * 1024;       // of that
constexpr auto kKeptAlive = 5s;                      // between two requests
constexpr int kMaxRequests = 200;                    // on one connection
constexpr int kLook = 100;                           // milliseconds between two looks whether the server stops

// A socket that does not block, in the form that the library reads and writes.
class Connection : public httplib::Stream {
 public:
  Connection(socket_t socket, SSL* tls, const std::atomic<socket_t>& listening)
      : socket_(socket), tls_(tls), listening_(listening) {}

  bool shakeHands() {
    deadline_ = Clock::now() + kMaxRequestTime;
    return !tls_ || carryOut([&] { return SSL_accept(tls_); }, 0) > 0;
  }

  // Whether the first byte of a further request has come.
  bool requestComes() {
    left_ = kMaxRequestBytes;
    answered_ = false;
    deadline_ = Clock::now() + kKeptAlive;
    if (at_ == end_ && !fill()) return false;
    deadline_ = Clock::now() + kMaxRequestTime;
    return true;
  }

  // Whether nothing more may be read as a request. To be told before its answer, or found by that.
  bool isLast() const { return last_; }
  void makeLast() { last_ = true; }

  // What the other side still sends is let go, for a moment: where it was unread, the system would take back the
  // answer.
  void sayGoodbye() {
    if (tls_) SSL_shutdown(tls_);
    if (!last_) return;
    shutdown(socket_, SHUT_WR);
    deadline_ = Clock::now() + kMaxGoodbyeTime;
    std::size_t unread = 0;
    while (unread < kMaxUnread && fill()) unread += end_;
  }

  ssize_t read(char* to, std::size_t size) override {
    if (left_ == 0 || (at_ == end_ && !fill())) return -1;
    const std::size_t count = std::min({size, end_ - at_, left_});
    std::copy_n(buffer_.data() + at_, count, to);
    at_ += count;
    left_ -= count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!std::exchange(answered_, true) && !isSuccess({from, size})) last_ = true;
    deadline_ = Clock::now() + kMaxWriteTime;
    const int piece = static_cast<int>(std::min(size, kMaxWritten));
    return carryOut(
        [&] {
          return tls_ ? SSL_write(tls_, from, piece)
                      : static_cast<int>(send(socket_, from, static_cast<std::size_t>(piece), MSG_NOSIGNAL));
        },
        POLLOUT);
  }

  bool is_readable() const override { return true; }  // reading and writing wait for themselves
  bool is_writable() const override { return true; }
  socket_t socket() const override { return socket_; }
  void get_remote_ip_and_port(std::string& ip, int& port) const override { tell(getpeername, ip, port); }
  void get_local_ip_and_port(std::string& ip, int& port) const override { tell(getsockname, ip, port); }

 private:
  // By an answer's first bytes: status 2xx or 3xx.
  static bool isSuccess(std::string_view answer) {
    constexpr std::string_view kVersion = "HTTP/1.1 ";
    return answer.size() > kVersion.size() && answer.starts_with(kVersion) &&
           (answer[kVersion.size()] == '2' || answer[kVersion.size()] == '3');
  }

  bool fill() {
    const ssize_t count = carryOut(
        [&] {
          return tls_ ? SSL_read(tls_, buffer_.data(), static_cast<int>(buffer_.size()))
                      : static_cast<int>(recv(socket_, buffer_.data(), buffer_.size(), 0));
        },
        POLLIN);
    at_ = 0;
    end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
    return count > 0;
  }

  // Tries until it is done: what `act` gives then, or -1 where the other side is gone, the time is up or the server
  // stops. `plain_wait` is what a socket without TLS waits for.
  template <typename Act>
  ssize_t carryOut(const Act& act, short plain_wait) {
    for (;;) {
      const int done = act();
      if (done > 0) return done;
      if (!wait(waitsFor(done, plain_wait))) return -1;
    }
  }

  // Events of poll; 0 where waiting is no use.
  short waitsFor(int done, short plain_wait) const {
    if (!tls_) return done < 0 && (errno == EAGAIN || errno == EINTR) ? plain_wait : short{0};
    switch (SSL_get_error(tls_, done)) {
      case SSL_ERROR_WANT_READ:
        return POLLIN;
      case SSL_ERROR_WANT_WRITE:
        return POLLOUT;
      default:
        return 0;
    }
  }

  bool wait(short events) const {
    while (events != 0 && listening_ != INVALID_SOCKET && Clock::now() < deadline_) {
      pollfd waiting{socket_, events, 0};
      if (poll(&waiting, 1, kLook) > 0) return true;
    }
    return false;
  }

  template <typename Name>
  void tell(const Name& name, std::string& ip, int& port) const {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    auto* at = reinterpret_cast<sockaddr*>(&address);
    if (name(socket_, at, &size) != 0 || getnameinfo(at, size, host.data(), host.size(), service.data(), service.size(),
                                                     NI_NUMERICHOST | NI_NUMERICSERV) != 0)
      return;
    ip = host.data();
    port = std::atoi(service.data());
  }

  const socket_t socket_;
  SSL* const tls_;
  const std::atomic<socket_t>& listening_;
  Clock::time_point deadline_;
  std::array<char, 4096> buffer_;
  std::size_t at_ = 0, end_ = 0;
  std::size_t left_ = 0;   // bytes that the request may still have
  bool answered_ = false;  // the request, in part
  bool last_ = false;
};

// What the library takes from a request's headers. Memory for many ranges would be many times the file's.
void takeNoRanges(httplib::Request& request) {
  request.ranges.clear();
  request.headers.erase("Range");
}

// The library's own keeps an endless list of connections.
class BoundedPool : public httplib::TaskQueue {
 public:
  explicit BoundedPool(std::size_t most) : free_(static_cast<std::ptrdiff_t>(most)), threads_(most) {}

  void enqueue(std::function<void()> answer) override {
    free_.acquire();
    threads_.enqueue([this, answer = std::move(answer)] {
      answer();
      free_.release();
    });
  }
  void shutdown() override { threads_.shutdown(); }

 private:
  std::counting_semaphore<> free_;
  httplib::ThreadPool threads_;
};

}  // namespace

bool hasBody(const httplib::Request& request) {
  const std::size_t lengths = request.get_header_value_count("Content-Length");
  return lengths > 1 || (lengths == 1 && request.get_header_value("Content-Length") != "0") ||
         request.has_header("Transfer-Encoding") || request.has_header("Expect");
}

BoundedServer::BoundedServer(SSL_CTX* tls, std::size_t most) : tls_(tls) {
  new_task_queue = [most] { return new BoundedPool(most); };
  set_payload_max_length(0);
  set_error_handler([](const httplib::Request&, httplib::Response& response) {
    // Said to who would send a further request already.
    if (!response.has_header("Connection")) response.set_header("Connection", "close");
  });
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
  const std::unique_ptr<SSL, decltype(&SSL_free)> tls(tls_ ? SSL_new(tls_) : nullptr, SSL_free);
  if (tls) SSL_set_fd(tls.get(), socket);
  bool answered = false;
  if (tls || !tls_) {
    Connection connection(socket, tls.get(), svr_sock_);
    bool open = connection.shakeHands();
    for (int request = 1; open && request <= kMaxRequests && connection.requestComes(); ++request) {
      bool asked_to_close = false;
      const auto look = [&](httplib::Request& asked) {
        takeNoRanges(asked);
        if (hasBody(asked)) connection.makeLast();
      };
      open = process_request(connection, request == kMaxRequests, asked_to_close, look) && !asked_to_close &&
             !connection.isLast();
      answered = true;
    }
    if (answered) connection.sayGoodbye();
  }
  shutdown(socket, SHUT_RDWR);
  close(socket);
  return answered;
}

}  // namespace limber::cli
