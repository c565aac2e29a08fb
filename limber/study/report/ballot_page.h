// The blind ballot on a study's page: two results of one subject at a time.
#pragma once

#include <string>
#include <string_view>

#include "limber/study/study_run.h"

namespace limber {

// A section that its script shows where two methods have pictures of one subject, which it takes from the page's
// figures: data-kind, data-subject and data-method, with data-picture at each picture. Which pair comes next, and which
// result is on the left, is drawn from the voter's name and the study; votes are kept in the browser for the same
// pictures alone, and saved as parseVotes reads them.
std::string ballotSection(const StudyResult& study);

extern const std::string_view kBallotStyle, kBallotScript;

}  // namespace limber
