// What every automatic rigger is: a mesh goes in, a skeleton comes out. One table lists them by name.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// A joint whose position is given.
struct JointPin {
  std::string joint;
  Vec3 position = Vec3::Zero();  // in the space of the mesh
};

class CurveSkeleton;
class SphereMesh;
struct MeasuredModel;
struct ReadingWeights;

// What a rigger found out about a mesh and can use again for the same mesh: filled by one call, read by the next.
struct RigMemory {
  std::shared_ptr<const SphereMesh> spheres;
  std::shared_ptr<const CurveSkeleton> curves;
  std::shared_ptr<const MeasuredModel> measured;
  std::shared_ptr<RigMemory> bare;  // of the same model without what it wears or holds
};

struct RigOptions {
  std::optional<Index> handles;  // number of joints, 1 to #V (with a triangle); none: the best suggested count

  // Shared by calls for one and the same mesh; null: everything is worked out anew. The answers are the same.
  std::shared_ptr<RigMemory> memory = {};

  // For riggers that fit a named skeleton.
  std::string templateName = "auto";              // auto: that of the likeliest kind of body
  bool mayAbstain = true;                         // auto: handles where none is likely (kLikelyTemplate)
  std::optional<Skeleton> templateSkeleton = {};  // a user's own, instead of that
  std::optional<Vec3> up = {}, front = {};        // along an axis of the mesh's space; none: found
  std::vector<JointPin> pins = {};
  std::shared_ptr<const ReadingWeights> reading = {};  // networks that read the shape; null: shapeWeights()
};

// The confidence from which on a template is taken for what the model is; below it is a guess.
inline constexpr double kLikelyTemplate = 0.4;

// A template, and how sure it is that the model is of its kind and has its limbs: 0 to 1.
struct TemplateMatch {
  std::string name;
  double confidence = 0;
};

// Joints in doubt that a user is asked for.
inline constexpr std::size_t kMaxDoubts = 3;

// The confidence from which on a template is taken without a question, and its up axis for the model's.
inline constexpr double kSureTemplate = 0.75;

// A count of handles worth choosing.
struct HandleSuggestion {
  Index handles = 0;
  double score = 0;  // 0 to 1, how clearly the error jumps there; suggestions come best first
};

struct AutoRig {
  Skeleton skeleton;  // in the space of the mesh
  // #V: the joint whose region of the surface each vertex is of; kNoIndex where no triangle uses it. Empty where the
  // rigger knows of no regions.
  std::vector<Index> jointOf;
  bool isAbstained = false;  // it has handles instead of a template (RigOptions::mayAbstain)
  std::vector<HandleSuggestion> suggestions;
  std::vector<TemplateMatch> matches;  // of "auto" all kinds, likeliest first; else the one that was asked for
  // Joints at the ends of limbs that the body seems to lack or that may be far off, first things first, kMaxDoubts at
  // most; none where the rig has handles.
  std::vector<std::string> doubts;
  std::optional<Vec3> up;  // of the model as it was fitted
  Warnings warnings;
};

using AutoRigger = AutoRig (*)(const TriMesh& mesh, const RigOptions& options, Progress& progress);

struct RiggerMethod {
  std::string_view name;     // "sphere-mesh"
  std::string_view summary;  // one line for --help
  std::string_view paper;    // empty: none
  AutoRigger rig;      // vertices that no triangle uses say nothing of a model and are left out, if it has a triangle
  bool looksForLimbs;  // is better given a body without what it wears or holds
};

std::span<const RiggerMethod> riggerMethods();
// Throws Error kBadArgument that lists the names there are.
const RiggerMethod& findRigger(std::string_view name);

}  // namespace limber
