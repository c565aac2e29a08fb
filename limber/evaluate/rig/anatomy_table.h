// How well bodies are read, against labels made by hand.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/evaluate/rig/labelled_skeleton.h"
#include "limber/report/table.h"

namespace limber {

// Counts over the parts of some skeletons. A part is right where a part of the same kind, side and number is read with
// at least half of the joints of both in common; its landmarks are right where each is the same joint.
struct AnatomyScore {
  std::size_t skeletons = 0, axes = 0;  // whose up and front are right, to 45 degrees
  std::size_t parts = 0, right = 0;     // labelled ones
  std::size_t landmarks = 0, landmarksRight = 0;
  // Of parts that were read with that confidence: how many, and how many of them are right. Bins of kConfidences.
  std::array<std::size_t, 6> said{}, saidRight{};

  void add(const AnatomyScore& other);
};
inline constexpr std::array<double, 7> kConfidences = {0, 0.5, 0.7, 0.8, 0.9, 0.95, 1};

void addScore(const LabelledSkeleton& body, const Anatomy& anatomy, AnatomyScore& score);

// The skeletons of the labelled files below `data` whose bytes are as they were when they were labelled. What is
// missing or has changed is counted in `skipped`.
std::vector<LabelledSkeleton> labelledSkeletons(std::string_view labels, const std::filesystem::path& data,
                                                Warnings& skipped);

// Parts right with names and without, whole and with each Damage, of files below creatures/check
// and wild/judge and of all others; and a table of how often parts were right by their confidence. Skeletons whose
// joints are all children of the root are listed apart. The same bytes for the same files.
std::vector<Table> anatomyTables(const std::vector<LabelledSkeleton>& bodies, Progress& progress);

}  // namespace limber
