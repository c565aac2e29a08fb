// Votes on which of two results looks better, as a study's page saves them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/study/study_cell.h"

namespace limber {

enum class Choice { kFirst, kSecond, kAlike };

// One voter on two methods' results of one subject.
struct Vote {
  std::string voter;
  CellKind kind = CellKind::kRig;
  std::string subject;        // StudyCell::subject()
  std::string first, second;  // StudyCell::method(), not the same
  Choice choice = Choice::kAlike;
};

// Comma separated (RFC 4180), UTF-8 with or without a byte order mark, below a line with the columns' names voter,
// kind (rig or retarget), subject, first, second and choice (first, second or alike), in any order; other columns and
// empty lines are skipped. Throws Error kBadData with the line, counted from 1, where the text is none such.
std::vector<Vote> parseVotes(std::string_view text);

// A voter has one vote on each pair of results, in either order: the last one counts, at the index of the first.
// So a file that was saved twice, with more votes the second time, counts once.
std::vector<Vote> lastVotes(std::span<const Vote> votes);

// Those on results that the study has.
std::vector<Vote> votesOn(std::span<const StudyCell> cells, std::span<const Vote> votes);

}  // namespace limber
