// What a user can do to a session, each as a value: the page, the command line and a test do the same things, and a
// list of them replayed gives the same result.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

// Points origin + t * direction, t > 0; the direction need not be a unit vector.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ();

  void fields(auto& field) { field("origin", origin)("direction", direction); }
};

// A command is a struct with its name in JSON and its fields, and a line in the list below; `fields` calls its argument
// with the name and the value of each, or calls `optional` where a text may be absent.
//
// Joints are named. Positions, axes and rays are in world space.

// Limbs follow: inverse kinematics begins on for a body that has limbs, and holds its feet where they stand.
struct OpenSample {
  std::string name;  // of sampleModels()
  bool limbsFollow = false;

  static constexpr std::string_view kName = "open_sample";
  void fields(auto& field) { field("name", name)("limbs_follow", limbsFollow); }
};
// The file is asked of the session's resolver; where a model came as bytes this is its name.
struct OpenFile {
  std::string file;
  bool limbsFollow = false;

  static constexpr std::string_view kName = "open_file";
  void fields(auto& field) { field("file", file)("limbs_follow", limbsFollow); }
};

// Makes the rig anew and keeps the pose: what the new handles hold goes where the old ones had taken it. A model that
// came with a rig of its own loses that one.
struct SetHandles {
  Index count = 20;

  static constexpr std::string_view kName = "set_handles";
  void fields(auto& field) { field("count", count); }
};
struct ChooseMethods {
  std::string rigger = "sphere-mesh";
  std::string skinning = "bone-heat";

  static constexpr std::string_view kName = "choose_methods";
  void fields(auto& field) { field("rigger", rigger)("skinning", skinning); }
};
// How the surface bends with the joints; the rig stays as it is.
struct SetDeformer {
  std::string deformer = "linear-blend";  // of deformers()

  static constexpr std::string_view kName = "set_deformer";
  void fields(auto& field) { field("deformer", deformer); }
};

// A correction of a rig that a template gave: the model is rigged anew with that joint where it is told to be, as the
// model is bound. Pins hold for every rig that a template gives this model, until its rest pose is another one.
struct PinJoint {
  std::string joint;
  Vec3 position = Vec3::Zero();

  static constexpr std::string_view kName = "pin_joint";
  void fields(auto& field) { field("joint", joint)("position", position); }
};
struct UnpinJoint {
  std::string joint;

  static constexpr std::string_view kName = "unpin_joint";
  void fields(auto& field) { field("joint", joint); }
};

// Move: the joint slides in the plane that faces the camera, and keeps its distance from the camera when that moves.
// Turn: the joint swings about its parent, around the camera's axis; a root rolls under the pointer like a trackball.
// Scale: the joint grows along all axes as the pointer goes up, and shrinks as it goes down, its children with it.
enum class DragMode { kMove, kTurn, kScale };
struct BeginDrag {
  std::string joint;
  DragMode mode = DragMode::kMove;
  Ray ray;                             // through the pointer
  Vec3 view = -Vec3::UnitZ();          // where the camera looks
  std::vector<std::string> with = {};  // joints that do the same
  bool mirrored = false;               // their mirror images do it as well, reflected

  static constexpr std::string_view kName = "begin_drag";
  void fields(auto& field) {
    field("joint", joint)("mode", mode)("ray", ray)("view", view)("with", with)("mirrored", mirrored);
  }
};
// Counts from where the drag began: of several updates only the last one matters.
struct UpdateDrag {
  Ray ray;
  Vec3 view = -Vec3::UnitZ();
  bool snap = false;  // to round positions and angles (snap.h)

  static constexpr std::string_view kName = "update_drag";
  void fields(auto& field) { field("ray", ray)("view", view)("snap", snap); }
};
// The dragged joint turns about its own origin, by degrees about an axis; counts from where the drag began, too.
struct TurnDrag {
  Vec3 axis = Vec3::UnitY();
  double degrees = 0;

  static constexpr std::string_view kName = "turn_drag";
  void fields(auto& field) { field("axis", axis)("degrees", degrees); }
};
// The dragged joint is so many times as large along all axes; counts from where the drag, one that scales, began, too.
struct ScaleDrag {
  double scale = 1;  // above 0

  static constexpr std::string_view kName = "scale_drag";
  void fields(auto& field) { field("scale", scale); }
};
// The dragged joint goes along with a hand that has hold of it: by an offset in metres, and turned about its own origin
// by a rotation vector in degrees. Counts from where the drag, one that moves, began.
struct MoveDrag {
  Vec3 offset = Vec3::Zero();
  Vec3 turn = Vec3::Zero();

  static constexpr std::string_view kName = "move_drag";
  void fields(auto& field) { field("offset", offset)("turn", turn); }
};
struct EndDrag {
  bool goesOn = false;  // one undo step with the drag that was ended before, where nothing was done between them

  static constexpr std::string_view kName = "end_drag";
  void fields(auto& field) { field("goes_on", goesOn); }
};
struct CancelDrag {
  static constexpr std::string_view kName = "cancel_drag";
};

// For exact work, what a drag to there does: with inverse kinematics on, the joint takes its limb along.
struct PlaceJoint {
  std::string joint;
  Vec3 position = Vec3::Zero();
  std::vector<std::string> with = {};  // joints that are displaced likewise
  bool mirrored = false;               // as of BeginDrag
  bool relative = false;               // `position` counts from where the joint is

  static constexpr std::string_view kName = "place_joint";
  void fields(auto& field) {
    field("joint", joint)("position", position)("with", with)("mirrored", mirrored)("relative", relative);
  }
};
// The joint turned so from its rest pose: degrees about the axes of its own frame (a rotation vector).
struct SetTurn {
  std::string joint;
  Vec3 turn = Vec3::Zero();
  std::vector<std::string> with = {};  // joints that are turned so from theirs
  bool mirrored = false;               // mirror images turn as far as their originals do
  bool relative = false;               // from the pose as it is instead, about the axes of the world

  static constexpr std::string_view kName = "set_turn";
  void fields(auto& field) {
    field("joint", joint)("turn", turn)("with", with)("mirrored", mirrored)("relative", relative);
  }
};

// The joint scaled so from its rest pose, along all axes, about itself, its children with it. Targets of pinned
// joints go where these are then. Refused where a recorded motion is shown: keys over one hold no scale.
struct SetScale {
  std::string joint;
  double scale = 1;                    // above 0
  std::vector<std::string> with = {};  // joints that are scaled so from theirs
  bool mirrored = false;               // mirror images are scaled as their originals are
  bool relative = false;               // from the pose as it is instead

  static constexpr std::string_view kName = "set_scale";
  void fields(auto& field) {
    field("joint", joint)("scale", scale)("with", with)("mirrored", mirrored)("relative", relative);
  }
};

// With inverse kinematics on, a joint that is moved takes its limb along, and joints with a target hold on to it.
struct SetIk {
  bool on = true;
  std::string solver = "whole-body";  // of ikMethods()

  static constexpr std::string_view kName = "set_ik";
  void fields(auto& field) { field("on", on)("solver", solver); }
};
struct SetTarget {
  std::string joint;
  Vec3 position = Vec3::Zero();
  std::vector<std::string> with = {};  // joints that are pinned where they are

  static constexpr std::string_view kName = "set_target";
  void fields(auto& field) { field("joint", joint)("position", position)("with", with); }
};
struct ClearTarget {
  std::string joint;
  std::vector<std::string> with = {};  // others that let go

  static constexpr std::string_view kName = "clear_target";
  void fields(auto& field) { field("joint", joint)("with", with); }
};
// The text of a limits file (limits_json.h); empty: no limits.
struct SetLimits {
  std::string limits;

  static constexpr std::string_view kName = "set_limits";
  void fields(auto& field) { field.optional("limits", limits); }
};

struct ResetJoint {
  std::string joint;
  std::vector<std::string> with = {};  // others that go back

  static constexpr std::string_view kName = "reset_joint";
  void fields(auto& field) { field("joint", joint)("with", with); }
};
struct ResetPose {
  static constexpr std::string_view kName = "reset_pose";
};
// Of a model that is its own mirror image: both sides swap their poses, or one side takes the other's. Left is the
// mirror plane's positive side.
enum class MirrorFrom { kBoth, kLeft, kRight };
struct MirrorPose {
  MirrorFrom from = MirrorFrom::kBoth;

  static constexpr std::string_view kName = "mirror_pose";
  void fields(auto& field) { field("from", from); }
};

// Puts the model, or only these joints of it, into a pose of this or of another skeleton (putPose); mirrored: swaps
// both sides then, as MirrorPose does. Planted feet are then pinned where they are, and targets go along.
struct ApplyPose {
  std::string pose;                      // the text of a pose file (pose_file.h)
  std::vector<std::string> joints = {};  // none: all
  bool mirrored = false;

  static constexpr std::string_view kName = "apply_pose";
  void fields(auto& field) { field("pose", pose)("joints", joints)("mirrored", mirrored); }
};

// Tasks for the whole body at once (parseTask: "look-at:head=0,1.6,2"). Pinned joints stay, but for joints of the
// tasks. The state reports the outcome of each, until the pose changes.
struct ApplyTasks {
  std::vector<std::string> tasks;
  bool rootMoves = false;

  static constexpr std::string_view kName = "apply_tasks";
  void fields(auto& field) { field("tasks", tasks)("root_moves", rootMoves); }
};

// The model's current pose becomes its bind pose.
struct SetRestPose {
  static constexpr std::string_view kName = "set_rest_pose";
};
struct RenameJoint {
  std::string joint, name;

  static constexpr std::string_view kName = "rename_joint";
  void fields(auto& field) { field("joint", joint)("name", name); }
};

// Paints weights of a joint with a round brush: adds or subtracts `strength` at its middle, replaces by it, or smooths
// the weights of all joints. The other joints lose in proportion what the joint gains, and gain what it loses; where
// there is no other, its parent gains that. Locked joints keep their weights. The brush's radius is measured in bind
// pose, in space and along the surface: it does not reach across gaps. All dabs are one stroke, in which each position
// is painted once.
enum class PaintMode { kAdd, kSubtract, kSmooth, kReplace };
// A point of the bound surface, on a triangle of the rig's Geometry: (1 - u - v, u, v) of its corners.
struct SurfaceDab {
  Index triangle = 0;
  double u = 0, v = 0;

  bool operator==(const SurfaceDab&) const = default;
};
struct PaintWeights {
  std::string joint;  // may be empty where the brush smooths
  PaintMode mode = PaintMode::kAdd;
  double strength = 0.5;  // 0 to 1
  double radius = 0.1;    // metres
  bool mirrored = false;  // on the model's other side, too, for the joint's mirror image
  std::vector<SurfaceDab> dabs;

  static constexpr std::string_view kName = "paint_weights";
  void fields(auto& field) {
    field.optional("joint", joint)("mode", mode)("strength", strength)("radius", radius)("mirrored", mirrored)("dabs",
                                                                                                               dabs);
  }
};
// A locked joint's weights stay when others are painted.
struct LockWeights {
  std::string joint;
  bool on = true;
  std::vector<std::string> with = {};  // others likewise

  static constexpr std::string_view kName = "lock_weights";
  void fields(auto& field) { field("joint", joint)("on", on)("with", with); }
};
// One side's weights for the other side; left is the mirror plane's positive side.
struct MirrorWeights {
  MirrorFrom from = MirrorFrom::kLeft;

  static constexpr std::string_view kName = "mirror_weights";
  void fields(auto& field) { field("from", from); }
};

// Corrections of the current rig; another rig of the model does not have them. The new joint is at `position` in the
// model's current pose, moves nothing until weights are painted for it, and gets a name if it is given none. A deleted
// joint's weights go to its parent. A joint that gets another parent stays where it is.
struct AddJoint {
  std::string parent;
  Vec3 position = Vec3::Zero();
  std::string name;

  static constexpr std::string_view kName = "add_joint";
  void fields(auto& field) { field("parent", parent)("position", position).optional("name", name); }
};
struct DeleteJoint {
  std::string joint;

  static constexpr std::string_view kName = "delete_joint";
  void fields(auto& field) { field("joint", joint); }
};
struct ReparentJoint {
  std::string joint, parent;

  static constexpr std::string_view kName = "reparent_joint";
  void fields(auto& field) { field("joint", joint)("parent", parent); }
};

// A file with motions (BVH, or a model with animations), asked of the session's resolver; it is called as the file is,
// without folder and extension, with a number behind it where that is taken.
struct AddMotion {
  std::string file;
  bool retarget = false;  // and puts its first clip onto the model; where that cannot be, nothing is added

  static constexpr std::string_view kName = "add_motion";
  void fields(auto& field) { field("file", file)("retarget", retarget); }
};
// A motion that limber makes itself; called by its name.
struct AddSampleMotion {
  std::string name;  // of sampleMotions()
  bool retarget = false;

  static constexpr std::string_view kName = "add_sample_motion";
  void fields(auto& field) { field("name", name)("retarget", retarget); }
};
// Retargets a clip of a motion to the model. Repeated with other options, it replaces its earlier result.
struct RetargetMotion {
  std::string motion;
  std::string clip;  // empty: the motion's first
  std::string method = "limb-ik";
  std::string map;   // which joint follows which (skeleton_map.h); empty: found
  double reach = 0;  // RetargetOptions::reach
  bool contacts = true;

  static constexpr std::string_view kName = "retarget";
  void fields(auto& field) {
    field("motion", motion)
        .optional("clip", clip)("method", method)
        .optional("map", map)("reach", reach)("contacts", contacts);
  }
};

// Sets whether a foot of the chosen clip's motion is planted in an interval, or takes that back; the clip is made anew.
// The setting stays when the motion is retargeted by another method or map.
enum class ContactChange { kPlanted, kFree, kFound };
struct SetContact {
  std::string foot;         // the motion's joint (ClipSource::feet)
  double from = 0, to = 0;  // seconds, both included
  ContactChange contact = ContactChange::kPlanted;

  static constexpr std::string_view kName = "set_contact";
  void fields(auto& field) { field("foot", foot)("from", from)("to", to)("contact", contact); }
};

// Clips of the model one after the other, each blended into the next one for so many seconds (joinMotions): a new
// clip, named after all of them, or one made by this command before, which is replaced.
struct JoinClips {
  std::vector<std::string> clips;
  double seconds = 0.3;
  std::string into;  // empty: a new one

  static constexpr std::string_view kName = "join_clips";
  void fields(auto& field) { field("clips", clips)("seconds", seconds).optional("into", into); }
};

// Clips are named; one at a time is shown. A new clip has no keys.
struct AddClip {
  std::string clip;

  static constexpr std::string_view kName = "add_clip";
  void fields(auto& field) { field("clip", clip); }
};
struct RemoveClip {
  std::string clip;

  static constexpr std::string_view kName = "remove_clip";
  void fields(auto& field) { field("clip", clip); }
};
struct RenameClip {
  std::string clip, name;

  static constexpr std::string_view kName = "rename_clip";
  void fields(auto& field) { field("clip", clip)("name", name); }
};
struct ChooseClip {
  std::string clip;  // empty: none, and the model is in rest pose

  static constexpr std::string_view kName = "choose_clip";
  void fields(auto& field) { field.optional("clip", clip); }
};
// Shows a moment of the chosen clip; of several only the last one counts, and there is nothing to undo.
struct SetTime {
  double seconds = 0;

  static constexpr std::string_view kName = "set_time";
  void fields(auto& field) { field("seconds", seconds); }
};
// Keys of the chosen clip: the pose becomes one at the moment that is shown.
struct SetKey {
  double span = 0;  // seconds over which a correction of recorded motion comes and goes (clip_layer.h)

  static constexpr std::string_view kName = "set_key";
  void fields(auto& field) { field("span", span); }
};
// One key of one joint of the chosen clip.
struct KeyOfJoint {
  std::string joint;  // empty: all that have a key then
  double seconds = 0;

  void fields(auto& field) { field.optional("joint", joint)("seconds", seconds); }
};
// Keys go to pivot + scale * (seconds - pivot) + shift, and replace those that are there.
struct EditKeys {
  std::vector<KeyOfJoint> keys;
  double shift = 0;   // seconds
  double scale = 1;   // above 0
  double pivot = 0;   // seconds
  bool copy = false;  // they stay where they were, too

  static constexpr std::string_view kName = "edit_keys";
  void fields(auto& field) { field("keys", keys)("shift", shift)("scale", scale)("pivot", pivot)("copy", copy); }
};
struct DeleteKeys {
  std::vector<KeyOfJoint> keys;

  static constexpr std::string_view kName = "delete_keys";
  void fields(auto& field) { field("keys", keys); }
};
// The joint's key at that moment, which is made where there is none.
struct SetJointKey {
  std::string joint;
  double seconds = 0;
  // The pose there, relative to the rest pose: degrees about the axes of the joint's own frame (a rotation vector),
  // metres along those of its parent's.
  Vec3 turn = Vec3::Zero();
  Vec3 offset = Vec3::Zero();

  static constexpr std::string_view kName = "set_joint_key";
  void fields(auto& field) { field("joint", joint)("seconds", seconds)("turn", turn)("offset", offset); }
};
struct SetInterpolation {
  Interpolation interpolation = Interpolation::kLinear;

  static constexpr std::string_view kName = "set_interpolation";
  void fields(auto& field) { field("interpolation", interpolation); }
};
// How the curves run through keys, where they are cubic.
struct SetTangents {
  std::vector<KeyOfJoint> keys;
  KeyTangents tangents = KeyTangents::kAuto;
  // With kFree what SetJointKey's change by, in a second.
  Vec3 turn = Vec3::Zero();
  Vec3 offset = Vec3::Zero();

  static constexpr std::string_view kName = "set_tangents";
  void fields(auto& field) { field("keys", keys)("tangents", tangents)("turn", turn)("offset", offset); }
};
// Joints of a pose file as keys at a moment: on this model or another, by anatomy (ApplyPose).
struct PoseKey {
  std::string pose;
  std::vector<std::string> joints;
  double seconds = 0;

  void fields(auto& field) { field("pose", pose)("joints", joints)("seconds", seconds); }
};
struct PasteKeys {
  std::vector<PoseKey> keys;

  static constexpr std::string_view kName = "paste_keys";
  void fields(auto& field) { field("keys", keys); }
};

struct Undo {
  static constexpr std::string_view kName = "undo";
};
struct Redo {
  static constexpr std::string_view kName = "redo";
};

// Of a scene (scene.h): its members are named. Another model, beside those that are there, on the same ground; it is
// the chosen one then. As a prop it gets a single joint where the file brings no rig.
struct AddSample {
  std::string name;  // of sampleModels()
  bool limbsFollow = false;
  bool asProp = false;

  static constexpr std::string_view kName = "add_sample";
  void fields(auto& field) { field("name", name)("limbs_follow", limbsFollow)("as_prop", asProp); }
};
struct AddFile {
  std::string file;
  bool limbsFollow = false;
  bool asProp = false;

  static constexpr std::string_view kName = "add_file";
  void fields(auto& field) { field("file", file)("limbs_follow", limbsFollow)("as_prop", asProp); }
};
struct RemoveMember {
  std::string member;

  static constexpr std::string_view kName = "remove_member";
  void fields(auto& field) { field("member", member); }
};
// All commands that are not of a scene go to the chosen member. Nothing to undo; of several in a row the last counts.
struct ChooseMember {
  std::string member;

  static constexpr std::string_view kName = "choose_member";
  void fields(auto& field) { field("member", member); }
};
struct RenameMember {
  std::string member, name;

  static constexpr std::string_view kName = "rename_member";
  void fields(auto& field) { field("member", member)("name", name); }
};
// A model's placement in the scene. What is attached stays attached, and keeps its new position at its joint.
struct PlaceMember {
  std::string member;
  Vec3 position = Vec3::Zero();  // of the model's origin, metres
  Vec3 turn = Vec3::Zero();      // a rotation vector, degrees
  double scale = 1;              // above 0

  static constexpr std::string_view kName = "place_member";
  void fields(auto& field) { field("member", member)("position", position)("turn", turn)("scale", scale); }
};
// From then on the member follows that joint, from where it is now or, snapped, with its middle at the joint.
struct AttachMember {
  std::string member, to, joint;
  bool snap = false;

  static constexpr std::string_view kName = "attach_member";
  void fields(auto& field) { field("member", member)("to", to)("joint", joint)("snap", snap); }
};
// It stays where it is.
struct DetachMember {
  std::string member;

  static constexpr std::string_view kName = "detach_member";
  void fields(auto& field) { field("member", member); }
};
// One clock for all members: each shows that moment of its chosen clip, again and again. Like SetTime otherwise.
struct SetClock {
  double seconds = 0;

  static constexpr std::string_view kName = "set_clock";
  void fields(auto& field) { field("seconds", seconds); }
};

// The rig of another file's body on the model: joints, weights and blend shapes (transferOnto). The file is asked of
// the session's resolver: a rigged model, or a body in SMPL's layout (.npz). Clips come along as to any other rig.
struct TransferRig {
  std::string file;

  static constexpr std::string_view kName = "transfer_rig";
  void fields(auto& field) { field("file", file); }
};
// Bones, weights and clips out of the file's own animation, whatever moves it (rigFromAnimation).
struct RigFromAnimation {
  Index bones = 0;  // 0: as many as an error of 0.2 % of the diagonal takes

  static constexpr std::string_view kName = "rig_from_animation";
  void fields(auto& field) { field("bones", bones); }
};

using Command =
    std::variant<OpenSample, OpenFile, SetHandles, ChooseMethods, PinJoint, UnpinJoint, BeginDrag, UpdateDrag, TurnDrag,
                 ScaleDrag, MoveDrag, EndDrag, CancelDrag, SetIk, SetTarget, ClearTarget, SetLimits, ResetJoint,
                 ResetPose, MirrorPose, SetRestPose, RenameJoint, AddMotion, AddSampleMotion, RetargetMotion,
                 SetContact, AddClip, RemoveClip, RenameClip, ChooseClip, SetTime, SetKey, EditKeys, DeleteKeys,
                 SetJointKey, SetInterpolation, SetTangents, PasteKeys, PaintWeights, LockWeights, MirrorWeights,
                 AddJoint, DeleteJoint, ReparentJoint, PlaceJoint, SetTurn, SetScale, ApplyPose, ApplyTasks, Undo, Redo,
                 AddSample, AddFile, RemoveMember, ChooseMember, RenameMember, PlaceMember, AttachMember, DetachMember,
                 SetClock, SetDeformer, TransferRig, RigFromAnimation, JoinClips>;

// "auto", "flat", "free", as in JSON.
std::string_view keyTangentsName(KeyTangents tangents);

// "set_handles", as in JSON.
std::string_view commandName(const Command& command);

// {"do": "set_handles", "count": 20}: every field is written; reading, those that are absent keep their default, but a
// joint, file, motion or name must be there. Throws Error kBadData naming the entry for a command or a field that is
// not known, or a value of the wrong kind.
Json commandToJson(const Command& command);
Command commandFromJson(const Json& json);

// The commands as a union of TypeScript types, as commandFromJson takes them: a misspelt field does not compile.
std::string commandTypes();

// {"limber_commands": 2, "commands": [...]}; lists of older versions are read as well.
std::string commandsToJson(std::span<const Command> commands);
std::vector<Command> commandsFromJson(std::string_view text);

}  // namespace limber
