#include "vote_files.h"

#include "limber/core/file/file.h"
#include "limber/core/known_error.h"

namespace limber::cli {

std::vector<Vote> readVotes(std::span<const std::string> files) {
  std::vector<Vote> votes;
  for (const std::string& file : files) {
    const Bytes text = readFile(file);
    try {
      const std::vector<Vote> more = parseVotes({reinterpret_cast<const char*>(text.data()), text.size()});
      votes.insert(votes.end(), more.begin(), more.end());
    } catch (const Error& error) {
      throwWithin(error, file == "-" ? "standard input" : file);
    }
  }
  return lastVotes(votes);
}

}  // namespace limber::cli
