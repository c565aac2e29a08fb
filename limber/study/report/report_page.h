// A study as a page that works from disk.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "limber/study/ranking/vote_ranking.h"
#include "limber/study/study_run.h"

namespace limber {

// One HTML file without references to a network: rankings with intervals and tests, time against each measure, the
// worst cells, a ballot by eye, and each model's pictures side by side with the commands that made them. Rankings by
// eye, at most one of each kind, stand beside the measured ones. Pictures are read from `folder` and embedded as long
// as the page stays below 15 MB; where they do not all fit, all are referred to beside the page. Everything out of
// files is escaped. The same from run to run but for seconds.
std::string reportPage(const StudyResult& study, const std::filesystem::path& folder,
                       std::span<const VoteRanking> byEye = {});

}  // namespace limber
