// fork and exec rather than posix_spawn: only a child between the two can limit its own memory before the program
// begins. It calls nothing there but what is safe after a fork, so other threads of this process do not matter but to
// work that runs in the child itself.
#include "limber/jobs/running_job.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/core/sanitizers.h"

namespace limber {

namespace {

constexpr int kCannotRun = 127;
constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes read at once

// The soft limit alone: a program may give one that it starts another.
void limitResource(int resource, rlim_t value) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? value : std::min(value, limit.rlim_max);
  setrlimit(resource, &limit);
}

void limitMemory(std::size_t bytes) {
  if (kAddressSanitizer) return;  // which takes terabytes of addresses for itself
#ifdef __linux__
  limitResource(RLIMIT_DATA, bytes);
#elif defined(RLIMIT_AS)
  limitResource(RLIMIT_AS, bytes);
#endif
}

struct ChildStart {
  char* const* arguments;
  const std::function<int()>* work;
  const char* folder;
  std::size_t memory;
  pid_t parent, group;
  int out, error, status;
};

[[noreturn]] void failBeforeProgram(const ChildStart& start) {
  const int reason = errno;
  const ssize_t written = write(start.status, &reason, sizeof reason);
  _exit(written == sizeof reason ? kCannotRun : kCannotRun - 1);
}

// What exec would close: pipes of guards, which would not see this program's end, and locks of files.
void closeInherited() {
#ifdef __linux__
  if (close_range(STDERR_FILENO + 1, ~0u, 0) == 0) return;
#endif
  const long most = sysconf(_SC_OPEN_MAX);
  for (int file = STDERR_FILENO + 1; file < most; ++file) close(file);
}

// Runs the job's function instead of calling exec. The end of the child writes, flushes or removes none of this
// process's files.
[[noreturn]] void doWork(const ChildStart& start) {
  closeInherited();
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int code = (*start.work)();
  std::fflush(stdout);
  std::fflush(stderr);
  _exit(code);
}

// Between fork and exec.
[[noreturn]] void becomeProgram(const ChildStart& start) {
  // One that has joined the group ends with it; the parent may have ended before.
  if (setpgid(0, start.group) != 0 || getppid() != start.parent) failBeforeProgram(start);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);  // the one that is left ignored across exec, where this program ignores it
  limitResource(RLIMIT_CORE, 0);
  limitMemory(start.memory);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(start.out, STDOUT_FILENO) >= 0 &&
      dup2(start.error, STDERR_FILENO) >= 0 && chdir(start.folder) == 0) {
    if (nothing > STDERR_FILENO) close(nothing);
    if (*start.work) doWork(start);
    execv(start.arguments[0], start.arguments);
  }
  failBeforeProgram(start);
}

// What the child says of its start: 0 once the program runs, else why it does not.
int startErrorFrom(int pipe) {
  int reason = 0;
  ssize_t got = 0;
  while ((got = read(pipe, &reason, sizeof reason)) < 0 && errno == EINTR) {
  }
  return got == sizeof reason ? reason : 0;
}

}  // namespace

RunningJob::RunningJob(const Job& job) : job_(job) {
  if (job.command.empty() && !job.work) throw Error(ErrorCode::kBadArgument, "a job has no command");
  std::vector<char*> arguments;
  for (std::string& argument : job_.command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const std::string folder = job.folder.empty() ? "." : job.folder.string();
  Pipe out, error, status;
  startedAt_ = secondsNow();
  deadline_ = startedAt_ + job.limits.seconds;
  const ChildStart start{arguments.data(), &job_.work,    folder.c_str(),  job.limits.memory, getpid(),
                         group_.id(),      out.writing(), error.writing(), status.writing()};
  if (job_.work) std::fflush(nullptr);  // or the child would write what is still to be written here
  pid_ = fork();
  if (pid_ < 0) {
    throw Error(ErrorCode::kFile, std::string("cannot start a process: ") + std::strerror(errno));
  }
  if (pid_ == 0) becomeProgram(start);
  status.closeWriting();
  startError_ = startErrorFrom(status.reading());
  for (auto [stream, pipe] : {std::pair{&out_, &out}, {&error_, &error}}) {
    stream->pipe = pipe->takeReading();
    fcntl(stream->pipe, F_SETFL, O_NONBLOCK);
  }
}

RunningJob::~RunningJob() {
  if (!isCollected_) {
    endAll();
    collect();
  }
  closeEnd(out_.pipe);
  closeEnd(error_.pipe);
}

void RunningJob::readWhatIsThere(Stream& stream) const {
  std::array<char, kPiece> piece;
  while (stream.pipe >= 0) {
    const ssize_t got = read(stream.pipe, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (got <= 0) return closeEnd(stream.pipe);
    stream.text.append(piece.data(), static_cast<std::size_t>(got));
    if (stream.text.size() > 2 * job_.maxOutput) stream.text.erase(0, stream.text.size() - job_.maxOutput);
    if (secondsNow() > deadline_) return;  // of a program that never stops printing
  }
}

void RunningJob::endAll() {
  group_.end();
  kill(pid_, SIGKILL);  // should it have left its group
}

bool RunningJob::isOver() {
  if (isCollected_) return true;
  readWhatIsThere(out_);
  readWhatIsThere(error_);
  siginfo_t ended{};
  const bool hasEnded =
      waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == pid_;
  isTimedOut_ = !hasEnded && secondsNow() > deadline_;
  if (!hasEnded && !isTimedOut_) return false;
  endAll();
  collect();
  return true;
}

void RunningJob::collect() {
  int status = 0;
  rusage usage{};
  while (wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  isCollected_ = true;
  result_.seconds = secondsNow() - startedAt_;
#ifdef __APPLE__
  constexpr std::size_t kUnit = 1;
#else
  constexpr std::size_t kUnit = 1024;
#endif
  result_.peakMemory = kUnit * static_cast<std::size_t>(usage.ru_maxrss);
  if (startError_ != 0) {
    result_.outcome = JobOutcome::kNotStarted;
    result_.code = startError_;
  } else if (isTimedOut_) {
    result_.outcome = JobOutcome::kTimedOut;
  } else if (WIFSIGNALED(status)) {
    result_.outcome = JobOutcome::kCrashed;
    result_.code = WTERMSIG(status);
  } else {
    result_.code = WEXITSTATUS(status);
    result_.outcome = result_.code == 0                      ? JobOutcome::kDone
                      : result_.code == job_.outOfMemoryCode ? JobOutcome::kOutOfMemory
                                                             : JobOutcome::kFailed;
  }
}

JobResult RunningJob::takeResult() {
  for (Stream* stream : {&out_, &error_}) {
    readWhatIsThere(*stream);
    closeEnd(stream->pipe);
    std::string& text = stream->text;
    if (text.size() > job_.maxOutput) text.erase(0, text.size() - job_.maxOutput);
  }
  result_.out = std::move(out_.text);
  result_.error = std::move(error_.text);
  return std::move(result_);
}

}  // namespace limber
