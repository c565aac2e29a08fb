// Runs a study: what its plan names, cell by cell, each as a process of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/study/study_cell.h"
#include "limber/study/study_plan.h"

namespace limber {

// How far the cells of a study are.
struct StudyProgress {
  std::size_t cells = 0, done = 0;  // done: also those kept from before
  double secondsLeft = 0;           // at the mean pace of the cells that ran; 0 while none did
};

struct StudyOptions {
  std::filesystem::path program;                        // limber's own (ownProgram)
  std::filesystem::path planFolder;                     // that the plan's paths are seen from
  std::filesystem::path output;                         // made where it is missing
  int jobs = 1;                                         // at once
  int outOfMemoryCode = 0;                              // by which the program says that memory did not suffice
  bool retries = false;                                 // what did not end well is run again
  std::function<void(const StudyProgress&)> tell = {};  // before the first cell runs, and after each
};

struct StudyResult {
  std::string title;
  std::vector<StudyCell> cells;
  std::vector<CellResult> results;  // of each cell
  std::size_t ran = 0;              // the others were kept from before
};

// Results are kept in `output`/cells under a hash of the program, the arguments and the inputs' bytes, each as soon as
// it is there: whatever ends a study costs the cells that ran, and the next goes on. A cell that ran out of time or
// memory runs again where there is more of it. Throws Error as findInputs does, kFile, and kCancelled.
StudyResult runStudy(const StudyPlan& plan, const StudyOptions& options, Progress& progress);

}  // namespace limber
