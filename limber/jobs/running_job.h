// A job while it runs.
#pragma once

#include <sys/types.h>

#include <string>

#include "limber/jobs/job.h"
#include "limber/jobs/process_group.h"

namespace limber {

// Starts the job on construction: in a process group of its own that ends with this program (process_group.h), with
// standard input empty and no core dumps. When the job ends, or one that still runs is destroyed, so does its group.
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
  void endAll();
  void collect();

  Job job_;
  ProcessGroup group_;
  pid_t pid_ = -1;
  double startedAt_ = 0, deadline_ = 0;
  Stream out_, error_;
  bool isCollected_ = false, isTimedOut_ = false;
  int startError_ = 0;  // errno of a program that could not be run
  JobResult result_;
};

}  // namespace limber
