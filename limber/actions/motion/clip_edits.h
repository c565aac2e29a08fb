// What is done to finished clips before they go to an engine: loops, root motion, frame rate, fewer keys.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/document/asset.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/motion.h"

namespace limber {

// In this order, whatever is asked for.
struct ClipEdits {
  bool loop = false;                     // cut to its best loop and joined (findLoop, joinLoop), where it has one
  bool inPlace = false;                  // without the body's travel (clipInPlace)
  std::optional<std::string> rootJoint;  // the travel goes to the root joint; where there is none it gets this name
  bool height = false, heading = false;  // travel taken besides that over the ground (RootMotionOptions)
  double smoothing = 0.3;                // seconds, likewise
  std::optional<double> frameRate;       // keys a second
  std::optional<double> tolerance;       // metres, above 0: fewest keys (reduceKeys), written compactly

  bool any() const { return loop || inPlace || rootJoint || frameRate || tolerance; }
};

struct ClipEditReport {
  std::string clip;
  std::optional<ClipLoop> loop;       // the one that was found, in seconds of the clip before
  double gap = 0, largestChange = 0;  // of a joined loop, metres (JoinedLoop)
  std::size_t keysBefore = 0, keysAfter = 0;
  double largestError = 0;  // metres, of the reduction of keys
};

// The joint whose travel is the body's: the pelvis by its anatomy, else the first.
Index bodyJoint(const SkeletonReading& skeleton);

// Edits the animations of these names; all others stay as they are, and so does what else theirs move (weights of blend
// shapes, other nodes), but that it is cut to a loop, too, with the weights joined (loopAnimation). With `rootJoint`
// the skeleton has a root joint afterwards (root_joint.h), and the clips of other names leave it where it is; warning
// "root-weights" where vertices follow it besides other joints: these move by as much of the travel as their weight
// says. What the clips took before leaves the file. Without a skin the ends of bones count as the surface. Throws Error
// kBadArgument where a name is no animation's, and as addRootJoint, extractRootMotion and resampleClip do.
//
// known  a reading of the document's skeleton, if there is one
std::vector<ClipEditReport> editClips(Asset& asset, std::span<const std::string> names, const ClipEdits& edits,
                                      const SkeletonReading& known = Skeleton());

// The same for all clips of a motion. The tolerance has no meaning there and is left out.
std::vector<ClipEditReport> editClips(Motion& motion, const ClipEdits& edits);

}  // namespace limber
