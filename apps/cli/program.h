// The program's commands as a call.
#pragma once

namespace limber::cli {

// What main does: parses the arguments (the first is the program's name), runs the command, and says what went wrong on
// standard error. Returns the exit code.
int runProgram(int argc, char** argv);

}  // namespace limber::cli
