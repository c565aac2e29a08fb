// The child sends one message through a pipe: a kind, a length, the bytes. Whatever it sends, the parent reads no more
// than the length it announced and than the memory it was allowed.
#include "limber/document/import/import_sandbox.h"

#if defined(__unix__) || defined(__APPLE__)
#define LIMBER_CAN_FORK
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <string>
#include <string_view>

#include "limber/core/progress.h"
#include "limber/core/sanitizers.h"
#endif

namespace limber {

#ifndef LIMBER_CAN_FORK

Bytes runIsolated(const std::function<Bytes()>& work, const SandboxLimits&) {
  return work();
}

void allowMemory(std::size_t) {}

#else

namespace {

constexpr double kClockPerProcessorTime = 10;  // other programs run too

enum class Kind : std::uint64_t { kResult, kError };

struct MessageHeader {
  Kind kind = Kind::kResult;
  std::uint64_t length = 0;
};

// Address space that this process has now, in bytes; 0 where the system does not tell.
std::size_t addressSpace() {
  std::size_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void setLimit(int resource, rlim_t value) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  if (now.rlim_max != RLIM_INFINITY) value = std::min(value, now.rlim_max);
  const rlimit wanted{value, now.rlim_max};
  setrlimit(resource, &wanted);
}

std::size_t memoryLimit = 0;  // of a child's address space; 0 where it has none

void applyLimits(const SandboxLimits& limits, std::size_t inherited) {
  setLimit(RLIMIT_CORE, 0);
  setLimit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)));
#ifdef RLIMIT_AS
  if (!kAddressSanitizer && inherited > 0) {
    memoryLimit = inherited + limits.memory;
    setLimit(RLIMIT_AS, memoryLimit);
  }
#endif
  const int nowhere = ::open("/dev/null", O_WRONLY);  // what a dying importer prints is no message of ours
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
}

bool sendAll(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = write(pipe, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

void sendMessage(int pipe, Kind kind, ByteSpan bytes) {
  const MessageHeader header{kind, bytes.size()};
  if (sendAll(pipe, &header, sizeof header)) sendAll(pipe, bytes.data(), bytes.size());
}

// An Error as text: code, then its parts, each closed by a zero byte.
void sendError(int pipe, const Error& error) {
  std::string text(1, static_cast<char>('0' + static_cast<int>(error.code())));
  for (const std::string* part : {&error.message(), &error.where(), &error.remedy()}) {
    text += *part;
    text += '\0';
  }
  sendMessage(pipe, Kind::kError, asBytes(text));
}

Error parseError(const Bytes& bytes) {
  std::array<std::string, 3> parts;
  std::size_t part = 0;
  for (std::size_t i = 1; i < bytes.size() && part < parts.size(); ++i) {
    if (bytes[i] == 0) {
      ++part;
    } else {
      parts[part] += static_cast<char>(bytes[i]);
    }
  }
  const int code = bytes.empty() ? 0 : bytes[0] - '0';
  const bool known = code >= 0 && code <= static_cast<int>(ErrorCode::kCancelled);
  return Error(known ? static_cast<ErrorCode>(code) : ErrorCode::kBadData, parts[0], parts[1], parts[2]);
}

[[noreturn]] void runChild(int pipe, const std::function<Bytes()>& work, const SandboxLimits& limits,
                           std::size_t inherited) {
  for (const int handled : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGPIPE}) std::signal(handled, SIG_DFL);
  applyLimits(limits, inherited);
  try {
    sendMessage(pipe, Kind::kResult, work());
  } catch (const Error& error) {
    sendError(pipe, error);
  } catch (const std::bad_alloc&) {
    sendError(pipe, Error(ErrorCode::kLimit, "asks for more memory than a file of its size may", {},
                          "convert it to GLB, or split it"));
  } catch (const std::exception& error) {
    sendError(pipe, Error(ErrorCode::kBadData, error.what()));
  }
  _exit(0);  // no destructors, no exit handlers: they belong to the parent
}

// The child as its parent sees it; ended and collected with this object, however that goes out of scope.
class Child {
 public:
  Child(pid_t pid, int pipe, double deadline) : pid_(pid), pipe_(pipe), deadline_(deadline) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    close(pipe_);
    if (!collected_) {
      kill(pid_, SIGKILL);
      collect(0);
    }
  }

  void receive(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      waitForData();
      const ssize_t got = read(pipe_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) failEarly();
      at += got;
      size -= static_cast<std::size_t>(got);
    }
  }

 private:
  // Looks at the child now and then: the pipe's end alone would not tell of its death while a process that another
  // thread forked meanwhile holds the writing end too.
  void waitForData() {
    constexpr double kSlice = 0.1;
    while (true) {
      const double left = deadline_ - secondsNow();
      if (left <= 0) throw Error(ErrorCode::kBadData, kTooLong);
      pollfd descriptor{pipe_, POLLIN, 0};
      const double slice = collected_ ? 0 : std::min(left, kSlice);
      if (poll(&descriptor, 1, static_cast<int>(slice * 1000) + (collected_ ? 0 : 1)) > 0) return;
      if (collected_) failEarly();
      collect(WNOHANG);
    }
  }

  void collect(int options) {
    pid_t ended = 0;
    while ((ended = waitpid(pid_, &status_, options)) < 0 && errno == EINTR) {
    }
    if (ended != 0) collected_ = true;
  }

  // The child ended before its message did.
  [[noreturn]] void failEarly() {
    if (!collected_) collect(0);
    const bool stopped = WIFSIGNALED(status_) && (WTERMSIG(status_) == SIGXCPU || WTERMSIG(status_) == SIGKILL);
    throw Error(ErrorCode::kBadData, stopped ? kTooLong : "the file makes the importer crash");
  }

  static constexpr const char* kTooLong = "takes too long to read";

  pid_t pid_;
  int pipe_;
  double deadline_;
  int status_ = 0;
  bool collected_ = false;
};

Bytes receiveMessage(Child& child, std::size_t memory) {
  MessageHeader header;
  child.receive(&header, sizeof header);
  if (header.length > memory && !kAddressSanitizer) {
    throw Error(ErrorCode::kLimit, "becomes larger than a file of its size may");
  }
  Bytes bytes;
  bytes.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(header.length, memory)));
  constexpr std::uint64_t kChunk = std::uint64_t{16} << 20;
  while (bytes.size() < header.length) {
    const std::size_t have = bytes.size();
    bytes.resize(static_cast<std::size_t>(std::min(header.length, have + kChunk)));
    child.receive(bytes.data() + have, bytes.size() - have);
  }
  if (header.kind == Kind::kError) throw parseError(bytes);
  return bytes;
}

}  // namespace

Bytes runIsolated(const std::function<Bytes()>& work, const SandboxLimits& limits) {
  const std::size_t inherited = addressSpace();
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw Error(ErrorCode::kFile, std::string("cannot open a pipe: ") + std::strerror(errno));
  const pid_t pid = fork();
  if (pid < 0) {
    const int reason = errno;
    close(ends[0]);
    close(ends[1]);
    throw Error(ErrorCode::kFile, std::string("cannot start a process: ") + std::strerror(reason));
  }
  if (pid == 0) {
    close(ends[0]);
    runChild(ends[1], work, limits, inherited);
  }
  close(ends[1]);
  Child child(pid, ends[0], secondsNow() + kClockPerProcessorTime * limits.seconds);
  return receiveMessage(child, limits.memory);
}

void allowMemory([[maybe_unused]] std::size_t bytes) {
#ifdef RLIMIT_AS
  if (memoryLimit > 0) setLimit(RLIMIT_AS, memoryLimit += bytes);
#endif
}

#endif

}  // namespace limber
