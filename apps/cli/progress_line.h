// Progress on a terminal, and Ctrl-C.
#pragma once

#include <string>

#include "limber/core/progress.h"

namespace limber::cli {

// A Progress that draws one line on standard error while work takes longer than a second, if that is a terminal, and
// that is cancelled by SIGINT and SIGTERM. One at a time.
class TerminalProgress {
 public:
  explicit TerminalProgress(bool quiet);
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;
  ~TerminalProgress();

  Progress& operator*() { return progress_; }
  Progress* operator->() { return &progress_; }
  // Closes the last stage and takes the line away, so that other text can follow.
  void finish();
  // Takes the line away; the next report draws it again.
  void clear();
  // Draws `text` instead of the name and the percentage of the stage, until the next call; empty: these again.
  void describe(std::string text);

 private:
  void draw(std::string_view stage, double fraction);

  bool enabled_;
  double startedAt_, drawnAt_ = 0;
  bool drawn_ = false;
  std::string description_;
  Progress progress_;
};

// A span of time as people say it: "40 s", "12 min", "3.5 h".
std::string timeText(double seconds);

// Has SIGINT or SIGTERM come?
bool interrupted();

}  // namespace limber::cli
