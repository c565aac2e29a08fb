#include "limber/session/edit/rig_commands.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "limber/document/rig/rest_pose.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/session/edit/pose_commands.h"
#include "limber/session/edit/pose_transfer.h"
#include "limber/session/edit/taken_rig.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

bool sameRig(const RiggedModel& a, const RiggedModel& b) {
  const std::vector<Joint>&x = a.skeleton().joints, &y = b.skeleton().joints;
  return a.weights.joints == b.weights.joints && a.weights.weights == b.weights.weights &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Joint& p, const Joint& q) {
           return p.name == q.name && p.parent == q.parent && sameTransform(p.rest, q.rest);
         });
}

// Whether the rig is one of as many handles as were asked for.
bool countsHandles(const SessionState& state) {
  return !state.rig->report || (state.rig->report->matches.empty() && state.rigger != kPropRigger);
}

// False where it has none.
bool erasePin(std::vector<JointPin>& pins, const std::string& joint) {
  return std::erase_if(pins, [&](const JointPin& pin) { return pin.joint == joint; }) > 0;
}

void rigAnew(SessionState& next, std::optional<Index> handles, Progress& progress) {
  AutoRigOptions options;
  options.rigger = next.rigger;
  options.skinning = next.skinning;
  options.rig.handles = handles;
  options.existingRig = hasRig(*next.base) ? ExistingRig::kReplace : ExistingRig::kRefuse;
  options.rig.memory = next.memory;
  options.rig.pins = next.pins;
  options.rig.templateName = next.templateName;
  options.rig.mayAbstain = false;  // who chose the rigger looks at what comes, and corrects it
  setRig(next, makeRiggedModel(*next.base, options, progress), progress);
}

void requirePinnable(const SessionState& state) {
  if (!state.rig->report || state.rig->report->matches.empty()) {
    refuse("only joints of a template can be pinned", {}, "choose_methods with the rigger template comes first");
  }
}

// The model as it is becomes the one that was opened.
void adopt(SessionState& state, Asset asset) {
  state.base = std::make_shared<const Asset>(std::move(asset));
  state.memory = std::make_shared<RigMemory>();
  state.rig = openRiggedModel(*state.base);
  state.pose = state.rig->home;
}

}  // namespace

void setRig(SessionState& state, std::shared_ptr<const RiggedModel> rig, Progress& progress) {
  if (sameRig(*rig, *state.authoredRig)) rig = state.authoredRig;
  for (const SessionClip& clip : state.movement.clips) {
    if (rig != state.authoredRig && clip.authored && rig != clip.authored->rig && sameRig(*rig, *clip.authored->rig))
      rig = clip.authored->rig;
  }
  state.pose =
      rig == state.authoredRig ? state.authoredPose : transferPose(*state.authoredRig, state.authoredPose, *rig);
  moveToRig(state.movement, state.rig, rig, progress);
  state.rig = std::move(rig);
  state.targets.clear();
  state.locked.clear();
  setLimits(state, {});
  holdStandingFeet(state);
}

void apply(const SetHandles& c, SessionState& next, Progress& progress) {
  // A rigger that fits a named skeleton has no use for a number, nor has one that gives a prop its joint.
  if (!countsHandles(next)) next.rigger = AutoRigOptions().rigger;
  rigAnew(next, c.count, progress);
}

void apply(const ChooseMethods& c, SessionState& next, Progress& progress) {
  const bool uncounted = !countsHandles(next) && next.rigger != c.rigger;
  next.rigger = c.rigger;
  next.skinning = c.skinning;
  rigAnew(next, uncounted ? std::nullopt : std::optional(next.rig->skeleton().jointCount()), progress);
}

void apply(const PinJoint& c, SessionState& next, Progress& progress) {
  requirePinnable(next);
  requireJoint(next, c.joint);
  erasePin(next.pins, c.joint);
  next.pins.push_back({c.joint, c.position});
  next.templateName = next.rig->report->matches.front().name;
  rigAnew(next, std::nullopt, progress);
}

void apply(const UnpinJoint& c, SessionState& next, Progress& progress) {
  requirePinnable(next);
  if (!erasePin(next.pins, c.joint)) refuse(fmt::format("no joint called '{}' is pinned", c.joint));
  if (next.pins.empty()) next.templateName = RigOptions().templateName;
  rigAnew(next, std::nullopt, progress);
}

void apply(const RigFromAnimation& c, SessionState& next, Progress& progress) {
  const std::shared_ptr<const RiggedModel> made = rigOfAnimation(*next.base, c, progress);
  setRig(next, made, progress);
  takeOwnClips(next.movement, *made);
  show(next);
}

// The clips are read anew with the model; where they came from is still known.
void apply(const SetRestPose&, SessionState& state) {
  Asset asset = assetWithClips(*state.rig, state.rig->home, basesOf(state.movement));
  setRestPose(asset, state.rig->binding(), state.pose);
  adopt(state, std::move(asset));
  state.pins.clear();
  state.templateName = RigOptions().templateName;
  Movement read = movementOf(state.rig->clips);
  for (SessionClip& clip : state.movement.clips) {
    const auto now = std::find_if(read.clips.begin(), read.clips.end(),
                                  [&](const SessionClip& known) { return known.clip->name == clip.clip->name; });
    if (now == read.clips.end()) continue;
    if (clip.base) {
      setBase(clip, state.rig->skeleton(), now->clip);
    } else {
      clip.clip = now->clip;
    }
  }
  state.targets.clear();
  holdStandingFeet(state);
  authored(state);
}

void apply(const SetDeformer& c, SessionState& next) {
  next.deformer = findDeformer(c.deformer).name;
}

}  // namespace limber
