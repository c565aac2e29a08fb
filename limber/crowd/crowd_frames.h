// A crowd's file read back for drawing: its bodies, and of each build and clip the joints' matrices, frame by frame.
// A program draws all bodies of a build at once then, each at a row of its own of one table.
#pragma once

#include <string>
#include <vector>

#include "limber/document/asset.h"

namespace limber {

// A body of a crowd's file.
struct CrowdMember {
  Index build = 0;                        // from 0; members of one build have the same surface and joints
  std::string clip;                       // its name
  Index offset = 0;                       // frames of its clip at which it begins
  Affine transform = Affine::Identity();  // of all of it, in the world
  Index node = 0;                         // that it hangs on
};

// The members of what makeCrowd wrote, in the order of its nodes; none for any other document. Throws Error kBadData
// where a note in a node's extras ("limber_crowd") is not as makeCrowd writes it.
std::vector<CrowdMember> crowdMembers(const Asset& asset);

// One of them by itself, at the origin, with the channels that move it.
Asset crowdMemberAlone(const Asset& asset, const CrowdMember& member);

// Of one build in one clip.
//
// matrices  #frames x #joints x 12: for each joint of readSkeleton the first three rows of what takes a bound point to
//           where it is posed, without the member's placement; row by row, metres
struct CrowdFrames {
  Index build = 0;
  std::string clip;
  Index first = 0;  // frame of the clip in the first row: a member's frame f is row offset - first + f
  Index frames = 0, joints = 0;
  std::vector<float> matrices;
};

struct CrowdAnimation {
  Index frames = 0;                 // steps between keys, so a member shows frames + 1 rows
  double seconds = 0;               // that all of them last
  std::vector<CrowdFrames> tables;  // by build, then clip
};

// Cost: a copy of the document for each table and again for what lies beyond its frames, then frames x joints. Throws
// as readSkeleton and readClips do, kBadData where a member has no clip or other joints than its build, kLimit above
// 4 GB of matrices.
CrowdAnimation readCrowdAnimation(const Asset& asset, const std::vector<CrowdMember>& members);

}  // namespace limber
