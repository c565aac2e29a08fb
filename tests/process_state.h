// Whether processes are still there that a test has only the numbers of.
#pragma once

#include <signal.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <string>

namespace limber::testing {

// Is it gone, or waits only to be collected by whoever inherited it?
inline bool isGone(pid_t pid) {
  if (kill(pid, 0) != 0 && errno == ESRCH) return true;
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::size_t name = text.rfind(')');
  return name != std::string::npos && text.compare(name, 3, ") Z") == 0;
}

// Waits for it to be gone; false where it still is there after a long time.
inline bool endsSoon(pid_t pid) {
  for (int i = 0; i < 4000 && !isGone(pid); ++i) usleep(5000);
  return isGone(pid);
}

}  // namespace limber::testing
