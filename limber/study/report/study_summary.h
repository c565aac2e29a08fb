// A study in a page of Markdown.
#pragma once

#include <string>

#include "limber/study/study_run.h"

namespace limber {

struct SummaryOptions {
  bool hasTimes = true;  // a last column of each table; without it the summary is the same to the byte from run to run
};

// For all models, and for each folder where there are several: medians with their 95 % intervals, a line for each
// method and a column for each measure, and below in words which methods the signed rank test tells apart. Measures
// that rank nothing have tables of their own, without words. Methods, measures and folders in the order of the study.
// What comes out of files and plans is escaped.
std::string studySummary(const StudyResult& study, const SummaryOptions& options = {});

}  // namespace limber
