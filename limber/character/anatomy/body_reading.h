// What is made of a skeleton before its parts are told: the fold, its measures and the guesses of its axes. Internal to
// the module; the tool that fits the weights uses it, too.
#pragma once

#include <vector>

#include "limber/character/anatomy/names/joint_words.h"
#include "limber/character/anatomy/part_field.h"

namespace limber {

// The skeleton and what it is made of must outlive this; it stays where it was made.
struct BodyReading {
  // conventions: whether names that are a convention's (naming_convention.h) are certain; else they are words as
  // others.
  BodyReading(const Skeleton& read, const Pose& pose, bool names, bool conventions = true);
  BodyReading(const BodyReading&) = delete;
  BodyReading& operator=(const BodyReading&) = delete;

  const Skeleton& skeleton;
  std::optional<ConventionMatch> convention;       // of the names, where they have a say
  std::vector<std::optional<NamedRole>> declared;  // #J, what is certain: by the file, else by the convention
  std::vector<JointWords> words;                   // #J, empty where names have no say
  std::vector<Vec3> positions;                     // #J
  JointTree tree;
  HalfBody body;
  BodyMeasures measures;
  // Left or right along the fold's lateral, as the file declares it or else both; up along any axis that lies in its
  // plane.
  std::vector<Axes> hypotheses;
};

// How much all labellings under a guess say for it: their scores count each joint as if it were independent of the
// others, which makes them too sure of the axes. Fitted by leaving skeletons out (tools/fit_anatomy.cpp --folds).
inline constexpr double kAxesByLabels = 0.3;

// Logarithm of a guess's probability, but for a constant: by its labellings, names for sides and the habits of files.
double axesScore(const BodyMeasures& measures, const Axes& hypothesis, const PartField& field,
                 const PartWeights& weights);

// readAnatomy with other weights than the fitted ones: for the tool that fits them.
Anatomy readAnatomyWith(const PartWeights& weights, const Skeleton& skeleton, const Pose& pose,
                        const AnatomyOptions& options);

}  // namespace limber
