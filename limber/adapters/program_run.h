// One run of an adapter's program: a file in (for retargeting two), a file out.
#pragma once

#include <string>

#include "limber/adapters/adapter.h"
#include "limber/core/file/file.h"
#include "limber/core/progress.h"

namespace limber {

struct ProgramInput {
  ByteSpan file;           // the model, or the motion
  ByteSpan skeleton = {};  // of adapters of kind retarget
};

struct ProgramOutput {
  std::string name;  // of the file, for messages
  Bytes bytes;
};

// Writes the input into a folder of the run's own, carries out the steps one after the other and reads what the last
// one wrote. The folder is gone afterwards, unless limber itself is killed. A program without a '/' in its name is
// looked for in $PATH.
//
// Throws Error kUnsupported, beginning with the adapter's name and with the program's last words: a step that cannot be
// started, ends with another exit code than 0, crashes, takes longer than its limits, or runs out of memory (as its
// last words say, or the system that ended it); kBadData: no output, or an empty one, whatever the exit code says.
// Progress as runJobs.
ProgramOutput runProgram(const Adapter& adapter, const ProgramInput& input, Progress& progress);

}  // namespace limber
