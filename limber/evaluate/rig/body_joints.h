// Which joints of an artist's skeleton are the body, and which are only of props, accessories or controls.
#pragma once

#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// Joints that count in comparisons: those that move a vertex by a tenth of its weight or more, those that play a bone
// of a person by their names, and those between two such. #J
std::vector<bool> countedJoints(const SkinnedModel& model);

// What is left of `counted` without the parts that a template has no joints for, identified by names alone:
// - fingers, and all other descendants of a hand (palms, props);
// - descendants of a head (eyes, jaws, ears, hair, noses, horns), and ears attached elsewhere;
// - descendants of a foot, but for its toes as a whole;
// - ends of chains (tip, end, leaf, nub), breasts, stomachs that swing.
std::vector<bool> bodyJoints(const Skeleton& skeleton, std::vector<bool> counted);

struct BoneLine {
  Vec3 a, b;
};

// Joints and bones as they are compared: model space, rest pose.
// - Of joints at one position one counts.
// - A bone leads to each joint from its nearest ancestor that counts. A joint without one (feet that inverse kinematics
//   drives are children of the root) is attached to the joint nearest to it of the tree that has the most joints.
struct BodyFigure {
  std::vector<Vec3> joints;
  std::vector<BoneLine> bones;
};
BodyFigure figureOf(const Skeleton& skeleton, const std::vector<bool>& counts);

}  // namespace limber
