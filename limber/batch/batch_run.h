// Runs a batch, or one of its shards: a command done to many files, each in a child of this process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "limber/batch/batch_plan.h"
#include "limber/core/error.h"

namespace limber {

// Where the parts of a batch's folder are, besides the outputs themselves.
struct BatchFolder {
  std::filesystem::path root;

  // All that is no output. A folder without it is no batch's.
  std::filesystem::path own() const { return root / kBatchOwnFolder; }
  // What the batch is known by: the PlannedOutputs of the latest run.
  std::filesystem::path plan() const { return own() / "plan.json"; }
  std::filesystem::path records() const { return own() / "records"; }
  std::filesystem::path recordsOf(const BatchShard& shard) const;
  std::filesystem::path unfinished(const BatchShard& shard) const;
};

// A command as the program's own does it: its arguments, without the program's name, and the one file that it may
// write; returns the exit code, and hands over the warnings that it gave, by kind. What it says of an error goes to
// standard error; it throws nothing.
using BatchWarnings = std::vector<std::pair<std::string, std::size_t>>;
using BatchCommand = std::function<int(const std::vector<std::string>& arguments, const std::filesystem::path& output,
                                       BatchWarnings& warnings)>;

// How far a shard is.
struct BatchProgress {
  std::size_t entries = 0, kept = 0, done = 0, failed = 0;  // kept: done or failed before, as they stand
  double seconds = 0;                                       // that this run has taken
  double perSecond = 0;     // entries that ran, over the last minute; 0 while it is not known
  double secondsLeft = 0;   // for what is left, at that pace; 0 while it is not known
  Warnings recordWarnings;  // of reading the records, before the first entry runs
};

struct BatchOptions {
  std::filesystem::path program;  // limber's own (ownProgram): another one makes everything anew
  std::filesystem::path output;   // made where it is missing
  BatchShard shard;
  int jobs = 1;              // at once
  int outOfMemoryCode = 0;   // by which the command says that memory did not suffice
  int storageCode = 4;       // by which it says that nothing can be written there (StorageError); not 0
  bool retries = false;      // what did not end well is done again
  BatchCommand command;      // called in a child; what it prints is the output where the plan names none
  bool takesThreads = true;  // does the command? Then "--threads 1" is added where the plan says nothing of threads
  // Where the command finds the user's adapters; absolute. It is given them as --adapter-folder behind an entry's
  // options where it takes adapters.
  std::vector<std::filesystem::path> adapterFolders;
  bool takesAdapters = false;
  std::function<void(const BatchProgress&)> tell;  // some fifty times a second; may throw to end the run
  std::function<void()> waiting;  // ten times a second while another program is at this shard; may throw likewise
};

// An input that is no plain file, or has more bytes than an entry may have memory, fails unread: it may have no end.
//
// A disk that is full, can only be read or fails is no entry's fault: it ends the batch, and the entry has no line.
//
// A command's temporary files (TMPDIR) lie in the batch's own folder and go with the entry, however that ends.
//
// An entry's output is written to a temporary path, hashed and renamed to its own; then its line is appended to the
// shard's records. So whatever ends a batch, an output is whole or not there, and the next run does the entries without
// a line. An entry with a line of the same key is left alone while its output matches the digest in that line; an entry
// that ran out of time or memory is done again where there is more of it, one that crashed always.
//
// A folder of an earlier plan is taken over: what is right in there stays. Throws Error kBadArgument where the folder
// is a file, or holds other things and no batch; kFile where nothing can be written.
//
// Where another program is at the same shard, its end is waited for: an engine may begin a task anew while what it
// thinks dead is still at work.
BatchProgress runBatch(const BatchPlan& plan, const BatchOptions& options);

}  // namespace limber
