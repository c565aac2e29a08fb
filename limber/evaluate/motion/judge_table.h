// The judge's figures (retarget_judge.h, known_answers.h, body_contacts.h) over many files, in two halves.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/evaluate/motion/retarget_table.h"

namespace limber {

struct AnswerScore {
  std::string motion, change, method;
  bool heldOut = false;
  double error = 0;  // errorOfAnswer, heights
};

// Every clip of the motions, and of the characters that have some, onto the bodies of knownAnswers; characters onto
// themselves only. `mostFrames` of each clip.
std::vector<AnswerScore> scoreAnswers(const RetargetTrial& trial, Progress& progress, Warnings& skipped);

// A line for each measure, for each method two columns, of pairs by which constants may be tuned and of
// held-out pairs (whose motion or character is held out): means, worst values in brackets; and how contacts of the body
// with itself are kept (scoreContact). `scores` with verdicts (RetargetTrial::judge).
std::vector<Table> judgeTables(std::span<const RetargetScore> scores, std::span<const AnswerScore> answers);
// A line for each answer.
Table eachAnswer(std::span<const AnswerScore> answers);

}  // namespace limber
