// Motions in the form of SMPL's family: arrays of joint rotations, as AMASS and generators of motions save them.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "limber/document/bvh/bvh_read.h"
#include "limber/document/smpl/npz.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct SmplOptions {
  // None: told from the frames. Z where heads lie above ankles along Z by more than along Y or -Y, over all frames.
  std::optional<UpAxis> up;
  // A model whose joints (smplSkeleton) are taken, shaped by the motion's betas; null for a person of our own.
  std::shared_ptr<const NpzFiles> body;
};

// A motion with one clip, named after the file. Of #N frames, each joint's rotation from the rest pose as an axis times
// an angle in radians, local to its parent:
//   poses             #N x 3J or #N x J x 3: 22, 24, 52 (SMPL-H) or 55 (SMPL-X) joints; or pose, fullpose, full_pose
// or, of which what is absent stays at rest, each #N x ... or of one row for all frames:
//   root_orient       3                 or global_orient
//   pose_body         63, 69 (SMPL)     or body_pose
//   pose_hand         90, left first    or left_hand_pose and right_hand_pose, 45 each
//   pose_jaw          3                 or jaw_pose
//   pose_eye          6, left first     or leye_pose and reye_pose, 3 each
// and
//   trans             #N x 3 metres, how far the pelvis is from where it rests; or transl. None: it stays
//   mocap_framerate   one number; or mocap_frame_rate, frame_rate, fps. None: 30, with a warning "frame-rate"
//   betas             read with a body alone; of several rows the first
// Other arrays are not looked at.
//
// Rest pose: with a body its own, which has the motion's number of joints or shares the first 22 with it; the pelvis
// rests where it is there. Without one, smplSkeleton's; as the pelvis's rest position is then unknown, the clip is
// raised or lowered as a whole until the lowest joint of all frames is as high as that of the rest pose.
//
// Warnings: "converted-axes" (another up axis converted to Y up), "upside-down" (heads are below ankles in all frames),
// "hand-components" (hands as another number of values than 45: the components of a model, left at rest), "bad-numbers"
// (not finite, or too large: replaced by the previous frame), "frame-rate". Throws Error kBadData naming the array:
// none of poses, of another shape than the above, of other numbers of frames, no frame; kLimit beyond 2^22 frames;
// kUnsupported as readNpy does; where() begins with `name`.
Motion readSmplMotion(const NpzFiles& arrays, std::string_view name, const SmplOptions& options = {});

// The same from the archive (readSmplArrays).
Motion readSmplMotion(ByteSpan npz, std::string_view name, const SmplOptions& options = {});

// Does it begin as an archive whose first file is an array?
bool looksLikeNpz(ByteSpan bytes);

}  // namespace limber
