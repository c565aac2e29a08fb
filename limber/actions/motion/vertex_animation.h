// Animations of a document as what each vertex does, whatever moves it: joints, nodes or morph targets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/character/character.h"
#include "limber/core/progress.h"
#include "limber/rigging/decomposition/bone_skeleton.h"
#include "limber/rigging/decomposition/vertex_sequence.h"

namespace limber {

struct VertexAnimation {
  VertexSequence sequence{0, 0};  // in world space; vertices that begin and move alike, to the bit, are one point
  std::vector<Index> pointOf;     // #S vertices of the surface: their points
  std::vector<FrameSpan> clips;   // one behind the other, together all frames of the sequence
};

struct VertexAnimationOptions {
  std::string clip;                       // as findClip reads it; empty: all
  std::optional<double> framesPerSecond;  // to sample at; none: what the keys of each clip tell, 30 where they do not
};

// Every animation of the document, sampled: skins by linear blend, morph targets by their weights, meshes on animated
// nodes with these. The rest pose is that of the surface, without morphs.
//
// Throws Error kBadData where the document has no animation, a clip has a single frame or nothing moves, kBadArgument
// for a clip that is not there or a rate that is not positive and finite, kLimit for more frames or positions than a
// VertexSequence holds, kCancelled.
// Each frame is made twice: first to find vertices that move alike, so that only points are kept. Memory beside the
// sequence: 60 bytes a vertex, and 12 a vertex and morph target.
VertexAnimation readVertexAnimation(const Character& character, const VertexAnimationOptions& options,
                                    Progress& progress);

// Throws Error kBadData, with `name` as where, where the sequence has a single frame or all frames are the same.
void refuseStill(const VertexSequence& sequence, const std::string& name);

}  // namespace limber
