#include "vote_files.h"

#include "command.h"

namespace limber::cli {

std::vector<Vote> readVotes(std::span<const std::string> files) {
  std::vector<Vote> votes;
  for (const std::string& file : files) {
    const std::vector<Vote> more = parsedFile(file, parseVotes);
    votes.insert(votes.end(), more.begin(), more.end());
  }
  return lastVotes(votes);
}

}  // namespace limber::cli
