// Files of votes on a study's results.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/study/ranking/ballot.h"

namespace limber::cli {

// All files' votes, one of each voter on each two results (lastVotes). Throws Error with the file's name.
std::vector<Vote> readVotes(std::span<const std::string> files);

}  // namespace limber::cli
