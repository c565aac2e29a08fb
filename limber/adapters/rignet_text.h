// Rigs as RigNet writes them, and Puppeteer and MagicArticulate after it: a line for each joint, link and vertex.
#pragma once

#include <string_view>

#include "limber/core/error.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// weights  #V, no slots where the file gives none; a vertex without a line has none
struct RignetRig {
  Skeleton skeleton;  // without rotations, in the file's space
  SkinWeights weights;
  Warnings warnings;  // "loose-joints": that hang on nothing and are no root
};

// Lines in any order:
//   joints NAME x y z    (or joint)
//   root NAME            (where it is left out, who has no parent is)
//   hier PARENT CHILD
//   skin VERTEX NAME w NAME w ...
// Vertices are those of the OBJ that was handed over, from 0. Joints come in the file's order, parents before children.
// Of a vertex's weights the 8 strongest are kept, to a sum of 1.
//
// Throws Error kBadData with the line: a word that begins no line, what is missing or no number, a joint that is not
// known or there twice, with two parents or below itself, a vertex from `vertexCount` on or there twice, a weight below
// 0. Cost: linear in the text.
RignetRig readRignetText(std::string_view text, std::string_view name, Index vertexCount);

}  // namespace limber
