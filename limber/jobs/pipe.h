// Pipes between processes.
#pragma once

#include <array>
#include <utility>

namespace limber {

// Closes a file descriptor, if it is one, and makes it -1.
void closeEnd(int& end);

// A pipe whose ends no other program inherits, beside the three standard streams even where one of those is closed.
class Pipe {
 public:
  // Throws Error kFile where the system gives none.
  Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe();

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void closeReading() { closeEnd(ends_[0]); }
  void closeWriting() { closeEnd(ends_[1]); }
  int takeReading() { return std::exchange(ends_[0], -1); }

 private:
  std::array<int, 2> ends_{-1, -1};
};

}  // namespace limber
