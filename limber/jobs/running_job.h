// A job while it runs.
#pragma once

#include <sys/types.h>

#include <string>

#include "limber/jobs/job.h"

namespace limber {

// Starts the job on construction: in a process group of its own, with standard input empty, no core dumps, and (on
// Linux) ended with the thread that started it. Destroying one that still runs ends its whole group.
class RunningJob {
 public:
  // Throws Error kFile where the system gives no pipe or no process; a program that cannot be run is a result.
  explicit RunningJob(const Job& job);
  RunningJob(const RunningJob&) = delete;
  RunningJob& operator=(const RunningJob&) = delete;
  ~RunningJob();

  // Where its output comes from; -1 for streams that are closed. For poll().
  int outputPipe() const { return out_.pipe; }
  int errorPipe() const { return error_.pipe; }
  double deadline() const { return deadline_; }  // by secondsNow()

  // Takes what output there is and looks whether the job has ended or run out of time. Never waits.
  bool isOver();
  // Once, when it is over.
  JobResult takeResult();

 private:
  struct Stream {
    int pipe = -1;
    std::string text;
  };

  void readWhatIsThere(Stream& stream) const;
  void endGroup() const;
  void collect();

  Job job_;
  pid_t pid_ = -1;
  double startedAt_ = 0, deadline_ = 0;
  Stream out_, error_;
  bool isCollected_ = false, isTimedOut_ = false;
  int startError_ = 0;  // errno of a program that could not be run
  JobResult result_;
};

}  // namespace limber
