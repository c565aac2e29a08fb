#include "limber/jobs/pipe.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "limber/core/error.h"

namespace limber {

namespace {

[[noreturn]] void failToOpen(int reason) {
  throw Error(ErrorCode::kFile, std::string("cannot open a pipe: ") + std::strerror(reason));
}

}  // namespace

void closeEnd(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

Pipe::Pipe() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) failToOpen(errno);
  constexpr int kFirstFree = 3;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    ends_[i] = fcntl(ends[i], F_DUPFD_CLOEXEC, kFirstFree);
  }
  const int reason = errno;
  for (int& end : ends) closeEnd(end);
  if (ends_[0] >= 0 && ends_[1] >= 0) return;
  for (int& end : ends_) closeEnd(end);
  failToOpen(reason);
}

Pipe::~Pipe() {
  for (int& end : ends_) closeEnd(end);
}

}  // namespace limber
