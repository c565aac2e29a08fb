// Clothes, hair and other attachments, hung by code on skeletons whose joints are known.
#pragma once

#include "limber/core/random.h"
#include "limber/evaluate/rig/labelled_skeleton.h"

namespace limber {

// Adds some of these, as artists do: a ring of skirt or coat chains at the hips, hair on the head, a cape on the chest,
// breasts, buttocks, straps, sleeves, targets of inverse kinematics at the root, leaf joints. Names are words of the
// thing, or of nothing. Hair is labelled as hair, all else as attachments. A body without a trunk stays as it is.
void addAttachments(LabelledSkeleton& body, Random& random);

}  // namespace limber
