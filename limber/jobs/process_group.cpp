#include "limber/jobs/process_group.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "limber/core/error.h"

namespace limber {

namespace {

// Signals that a program sends to its own group, to end its children, are none of the guard's business.
constexpr const char* kGuard = "trap '' HUP INT QUIT TERM USR1 USR2 ALRM PIPE TSTP; read -r end; kill -s KILL 0";

// In a group of its own; `input` becomes its standard input. Returns 0, or why it does not run.
int startGuard(int input, pid_t& guard) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  std::string name = "sh", option = "-c", script = kGuard;
  const std::array<char*, 4> arguments = {name.data(), option.data(), script.data(), nullptr};
  const std::array<char*, 1> environment = {nullptr};
  const int reason = posix_spawn(&guard, "/bin/sh", &files, &attributes, arguments.data(), environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return reason;
}

}  // namespace

ProcessGroup::ProcessGroup() {
  if (const int reason = startGuard(pipe_.reading(), guard_); reason != 0) {
    throw Error(ErrorCode::kFile, std::string("cannot start a process: ") + std::strerror(reason), "/bin/sh");
  }
  pipe_.closeReading();
}

void ProcessGroup::end() {
  if (guard_ < 0) return;
  kill(-guard_, SIGKILL);
  int ignored = 0;
  while (waitpid(guard_, &ignored, 0) < 0 && errno == EINTR) {
  }
  guard_ = -1;
}

}  // namespace limber
