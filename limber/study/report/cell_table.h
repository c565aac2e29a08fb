// A study's results as tidy tables.
#pragma once

#include <string>

#include "limber/study/study_run.h"

namespace limber {

// One line a cell and measure, below a line of names (RFC 4180); a cell without any measure has one line without one.
// The same from run to run but for the measure "seconds".
std::string cellsCsv(const StudyResult& study);

// The same rows as objects in an array, below "cells".
std::string cellsJson(const StudyResult& study);

}  // namespace limber
