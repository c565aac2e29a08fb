// Animations cut to a span of time, or to a loop, whatever they move.
#pragma once

#include "limber/document/asset.h"
#include "limber/skeleton/clip/keys/time_span.h"

namespace limber {

// Cuts what all channels of an animation say (weights of blend shapes, movements of nodes, what KHR_animation_pointer
// names) to what lies in the span (infinite: to the end), starting at 0, as trimClip cuts the tracks of joints. What
// ends before the span stays as it is at its end. Values get new accessors, in floats where they were fractions; those
// that they had stay in the document (AccessorSweep takes them out). The animation need not be one of the document's. A
// channel whose keys are not in order, or whose values do not fit them, stays as it is (warning "invalid-keys").
void trimAnimation(Asset& asset, gltf::Animation& animation, const TimeSpan& span);

// The same with the ends of all weights of blend shapes joined (joinTrack) unless they are one (kClosedLoop): a face
// that loops with the joints that joinLoop joins. What else moves is cut alone.
void loopAnimation(Asset& asset, gltf::Animation& animation, const TimeSpan& span);

}  // namespace limber
