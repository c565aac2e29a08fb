// A cell of a study: one method on one model, as commands of the program.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/jobs/job.h"
#include "limber/study/measure.h"
#include "limber/study/study_input.h"
#include "limber/study/study_plan.h"

namespace limber {

enum class CellKind { kRig, kRetarget };
std::string_view cellKindName(CellKind kind);  // "rig", "retarget"

// A command of the program; what it writes goes into the cell's own folder.
struct CellStep {
  std::string name;                    // "evaluate rig"
  std::vector<std::string> arguments;  // of the program
  MeasureSource measures = MeasureSource::kNone;
  std::string report = {};   // the file with the measures; empty: they are printed
  std::string picture = {};  // the picture that is made, without .png; empty: none
  bool isTimed = false;      // takes the cell's seconds, with reading and writing of files
  bool needsMotion = false;  // refuses what has no part that bends: the cell goes without, and ends well; the last step
};

struct StudyCell {
  CellKind kind = CellKind::kRig;
  std::string group, model, motion;           // motion: of retargeting
  std::string rigger, skinning, options;      // of rigs
  std::string deformer;                       // of rigs, where the plan names some
  std::string retargeting, solver;            // of retargeting
  std::vector<std::filesystem::path> inputs;  // as they stand among the arguments
  std::vector<CellStep> steps;                // in order; a cell ends with the first that fails

  std::string subject() const;  // the model, and the motion where there is one
  std::string method() const;   // "template + bone-heat + delta-mush, 20 handles"
};

// A model of a study with what is known of it.
struct StudyModel {
  StudyInput input;
  bool isRigged = false;  // has a skeleton and weights of its own: a truth to compare with
};

// For each model each combination, in order. Models without a skeleton of their own are left out where that is to be
// kept. Of combinations that differ in the deformer alone, the first measures (and times) the rig; the others make the
// same again, and measure what the surface does in motion.
std::vector<StudyCell> rigCells(const StudyPlan& plan, std::span<const StudyModel> models);
// For each character each motion and each combination, in order.
std::vector<StudyCell> retargetCells(const StudyPlan& plan, std::span<const StudyInput> characters,
                                     std::span<const StudyInput> motions);

struct CellPicture {
  std::string name;            // "bones"
  std::filesystem::path file;  // seen from the study's folder
};

struct CellResult {
  JobOutcome outcome = JobOutcome::kDone;
  std::string problem;  // empty where all is done, else in one line: which step, what happened
  std::vector<MeasuredValue> measures;
  std::vector<CellPicture> pictures;

  std::optional<double> valueOf(const Measure& measure) const;
};

// As a POSIX shell reads it.
std::string commandText(const CellStep& step);

}  // namespace limber
