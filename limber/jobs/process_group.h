// Processes that end together, and with the program that started them.
#pragma once

#include <sys/types.h>

#include "limber/jobs/pipe.h"

namespace limber {

// A process group with a guard in it: a process that waits at a pipe whose other end this program alone has. When this
// program ends, however it does, the pipe closes, and the guard kills the group with SIGKILL. So do groups of groups:
// where a program of one has a group of its own, that one's guard sees it end. A process that leaves its group (setsid)
// escapes.
//
// The alternatives fall short: Linux's PR_SET_PDEATHSIG reaches children alone, not theirs, and fires when the thread
// that started them ends rather than the program; signal handlers do not see SIGKILL; and macOS lacks Linux's
// subreapers. The guard is a shell (1 MB, about a millisecond), so that it inherits none of this program's pages.
class ProcessGroup {
 public:
  // Throws Error kFile where the system gives no pipe or no process.
  ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;
  ~ProcessGroup() { end(); }

  // For setpgid() between fork and exec. It means no other group until end(). A process that holds the guard's pipe
  // until it has joined (any child until its exec) cannot come too late to be killed with the others.
  pid_t id() const { return guard_; }

  // Kills all that is in it, once; its processes are then collected by whoever started them.
  void end();

 private:
  Pipe pipe_;
  pid_t guard_ = -1;
};

}  // namespace limber
