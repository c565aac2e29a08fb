#include "limber/session/session.h"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "limber/actions/edit_text.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/rig/body_masses.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/clip/pose_file.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/uri.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/samples.h"
#include "limber/session/drag/live_character.h"
#include "limber/session/drag/standing_feet.h"
#include "limber/session/edit/apply_pose.h"
#include "limber/session/edit/edit_joints.h"
#include "limber/session/edit/mirror_pose.h"
#include "limber/session/edit/pose_transfer.h"
#include "limber/session/edit/taken_rig.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_file.h"
#include "limber/session/scene/session_io.h"
#include "limber/skeleton/ik/limits/limits_json.h"

namespace limber {

namespace {

constexpr std::size_t kMaxRigs = 12;             // that an undo history keeps
constexpr std::size_t kMaxWeights = 32'000'000;  // influences that the rigs of an undo history hold

[[noreturn]] void refuseSecond() {
  refuse("a session holds one model", {}, "a scene holds several");
}

bool sameRig(const RiggedModel& a, const RiggedModel& b) {
  const std::vector<Joint>&x = a.skeleton().joints, &y = b.skeleton().joints;
  return a.weights.joints == b.weights.joints && a.weights.weights == b.weights.weights &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Joint& p, const Joint& q) {
           return p.name == q.name && p.parent == q.parent && sameTransform(p.rest, q.rest);
         });
}

// #J
std::vector<bool> locksOf(const SessionState& state) {
  std::vector<bool> locked;
  for (const Joint& joint : state.rig->skeleton().joints) locked.push_back(state.locked.count(joint.name) > 0);
  return locked;
}

// Those that a command names in `joint` and `with`.
template <class C>
std::vector<Index> jointsOf(const SessionState& state, const C& c) {
  std::vector<Index> joints = {requireJoint(state, c.joint)};
  for (const std::string& name : c.with) joints.push_back(requireJoint(state, name));
  return joints;
}

// Returns pinned joints to their targets.
void holdTargets(SessionState& state) {
  if (!state.ik || state.targets.empty()) return;
  LimbPull pull(state.rig->skeleton(), state.targets, state.limits.get(), state.solver);
  pull.solve(state.pose, state.targets);
}

// Those of the targets for which `which` says so go where their joints are now.
template <class Which>
void followPose(SessionState& state, const Which& which) {
  const std::vector<Affine> globals = poseGlobals(state.rig->skeleton(), state.pose);
  for (PinnedTarget& target : state.targets) {
    if (!which(target)) continue;
    target.position = globals[target.joint].translation();
    if (target.rotation) target.rotation = decompose(globals[target.joint]).rotation;
  }
}

// Pinned joints have priority over the tasks.
void applyTasks(SessionState& state, const ApplyTasks& command) {
  const Skeleton& skeleton = state.rig->skeleton();
  std::vector<TaskEdit> edits;
  for (const std::string& text : command.tasks) edits.push_back(parseTask(text));
  if (edits.empty()) refuse("there are no tasks");
  std::vector<IkTask> tasks = resolveTasks(skeleton, edits);
  const auto isAsked = [&](Index joint) {
    return std::any_of(edits.begin(), edits.end(), [&](const TaskEdit& edit) {
      return !edit.joint.empty() && requireJoint(skeleton, edit.joint, edit.where) == joint;
    });
  };
  for (const PinnedTarget& target : state.targets) {
    if (!state.ik || isAsked(target.joint)) continue;
    tasks.push_back({PositionTask{target.joint, target.position}, 1, -1});
    if (target.rotation) tasks.push_back({OrientationTask{target.joint, *target.rotation}, 1, -1});
  }
  IkTaskOptions options;
  options.ik.rootMotion = command.rootMoves ? RootMotion::kTranslate : RootMotion::kFixed;
  options.masses = bodyMasses(state.rig->geometry(), state.rig->weights, skeleton);
  const IkTaskResult result = solveIkTasks(skeleton, state.pose, tasks, state.limits.get(), options);
  followPose(state, [&](const PinnedTarget& target) { return isAsked(target.joint); });
  authored(state);
  for (std::size_t t = 0; t < edits.size(); ++t) {
    state.tasks.push_back({command.tasks[t], taskOutcome(result.tasks[t]), result.tasks[t].met});
  }
}

// Pins the feet that are planted in this pose, where limbs follow by themselves.
void holdStandingFeet(SessionState& state) {
  if (state.limbsFollow && state.ik) state.targets = standingFeet(*state.rig, state.pose);
}

// Soles that were pinned are released where the pose lifts them; other joints take their targets along.
void applyPose(SessionState& state, const ApplyPose& command) {
  state.pose = appliedPose(*state.rig, state.pose, command);
  if (state.limbsFollow && state.ik) {
    std::erase_if(state.targets, [](const PinnedTarget& target) { return target.rotation.has_value(); });
  }
  followPose(state, [](const PinnedTarget&) { return true; });
  if (!state.limbsFollow || !state.ik) return;
  for (const PinnedTarget& foot : standingFeet(*state.rig, state.pose)) setTarget(state.targets, foot);
}

void letLimbsFollow(SessionState& state) {
  state.limbsFollow = true;
  state.ik = hasLimbs(state.rig->anatomy());
  holdStandingFeet(state);
}

// Targets and limits speak of joints, so they go with the rig that had those; clips come along.
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

// The model as it is becomes the one that was opened.
void adopt(SessionState& state, Asset asset) {
  state.base = std::make_shared<const Asset>(std::move(asset));
  state.memory = std::make_shared<RigMemory>();
  state.rig = openRiggedModel(*state.base);
  state.pose = state.rig->home;
}

// The clips are read anew with the model; where they came from is still known.
void setRestPose(SessionState& state) {
  Asset asset = assetWithClips(*state.rig, state.rig->home, basesOf(state.movement));
  limber::setRestPose(asset, state.rig->binding(), state.pose);
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

// Whether the rig is one of as many handles as were asked for.
bool countsHandles(const SessionState& state) {
  return !state.rig->report || (state.rig->report->matches.empty() && state.rigger != kPropRigger);
}

// False where it has none.
bool erasePin(std::vector<JointPin>& pins, const std::string& joint) {
  return std::erase_if(pins, [&](const JointPin& pin) { return pin.joint == joint; }) > 0;
}

void show(SessionState& next) {
  next.pose = shownPose(next.movement, next.rig->skeleton());
  holdStandingFeet(next);
  authored(next);
}

void addMotionTo(SessionState& next, Motion motion, bool retarget) {
  limber::addMotion(next.movement, std::move(motion));
  if (!retarget) return;
  RetargetMotion command;
  command.motion = next.movement.motions.back()->name;
  retargetMotion(next.movement, *next.rig, command);
  show(next);
}

}  // namespace

// Carries out one command; those that change the document commit a changed copy of its state.
struct Session::Runner {
  Session& session;
  const Command& command;
  Progress& progress;

  SessionState state() const {
    session.requireOpen();
    if (session.drag_) refuseDragged();
    return session.state_;
  }

  void operator()(const OpenSample& c) const { session.start(makeSample(c.name), command, {c.limbsFollow}, progress); }
  void operator()(const OpenFile& c) const { session.open(session.fileOf(c.file), c.file, progress, c.limbsFollow); }
  void operator()(const AddSample& c) const {
    if (session.isOpen()) refuseSecond();
    session.start(makeSample(c.name), command, {c.limbsFollow, c.asProp}, progress);
  }
  void operator()(const AddFile& c) const { session.add(session.fileOf(c.file), c, progress); }
  void operator()(const RemoveMember&) const { refuseOfScene(); }
  void operator()(const ChooseMember&) const { refuseOfScene(); }
  void operator()(const RenameMember&) const { refuseOfScene(); }
  void operator()(const PlaceMember&) const { refuseOfScene(); }
  void operator()(const AttachMember&) const { refuseOfScene(); }
  void operator()(const DetachMember&) const { refuseOfScene(); }
  void operator()(const SetClock&) const { refuseOfScene(); }
  [[noreturn]] static void refuseOfScene() { refuse("only a scene has members", {}, "run the command on a scene"); }
  void operator()(const SetHandles& c) const {
    SessionState next = state();
    // A rigger that fits a named skeleton has no use for a number, nor has one that gives a prop its joint.
    if (!countsHandles(next)) next.rigger = AutoRigOptions().rigger;
    rig(next, c.count);
    session.commit(command, std::move(next));
  }
  void operator()(const ChooseMethods& c) const {
    SessionState next = state();
    const bool uncounted = !countsHandles(next) && next.rigger != c.rigger;
    next.rigger = c.rigger;
    next.skinning = c.skinning;
    rig(next, uncounted ? std::nullopt : std::optional(next.rig->skeleton().jointCount()));
    session.commit(command, std::move(next));
  }
  void rig(SessionState& next, std::optional<Index> handles) const {
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

  void operator()(const PinJoint& c) const {
    SessionState next = pinnable();
    requireJoint(next, c.joint);
    erasePin(next.pins, c.joint);
    next.pins.push_back({c.joint, c.position});
    next.templateName = next.rig->report->matches.front().name;
    rig(next, std::nullopt);
    session.commit(command, std::move(next));
  }
  void operator()(const UnpinJoint& c) const {
    SessionState next = pinnable();
    if (!erasePin(next.pins, c.joint)) refuse(fmt::format("no joint called '{}' is pinned", c.joint));
    if (next.pins.empty()) next.templateName = RigOptions().templateName;
    rig(next, std::nullopt);
    session.commit(command, std::move(next));
  }
  SessionState pinnable() const {
    SessionState next = state();
    if (!next.rig->report || next.rig->report->matches.empty()) {
      refuse("only joints of a template can be pinned", {}, "choose_methods with the rigger template comes first");
    }
    return next;
  }

  void operator()(const BeginDrag& c) const {
    const SessionState now = state();
    const Index joint = requireJoint(now, c.joint);
    DragScene scene = sceneOf(now, joint, c);
    session.drag_ = std::make_unique<Drag>(std::move(scene), joint, c.mode, c.ray, c.view);
    session.record_->add(command);
  }
  // `c` names joints in `with`, and may be `mirrored`.
  template <class Gesture>
  static DragScene sceneOf(const SessionState& now, Index joint, const Gesture& c) {
    DragScene scene;
    scene.skeleton = &now.rig->skeleton();
    scene.limits = now.limits.get();
    scene.start = now.pose;
    scene.ik = now.ik;
    scene.pinned = pinnedDuringDrag(*now.rig, now.pose, now.targets, joint);
    scene.rollRadius = std::max(2 * now.rig->radii[joint], longestSide(*now.rig) / 8);
    scene.solver = now.solver;
    scene.followers = followersOf(now, joint, c.with, c.mirrored);
    scene.snap = snapOf(*now.rig, joint);
    return scene;
  }
  static std::vector<DragFollower> followersOf(const SessionState& now, Index joint,
                                               const std::vector<std::string>& with, bool mirrored) {
    std::vector<DragFollower> followers;
    const auto add = [&](Index follower, const Mat3& reflection, std::optional<Index> imageOf = std::nullopt) {
      const bool known = follower == joint || std::any_of(followers.begin(), followers.end(),
                                                          [&](const DragFollower& f) { return f.joint == follower; });
      if (!known) followers.push_back({follower, reflection, imageOf});
    };
    for (const std::string& name : with) add(requireJoint(now, name), Mat3::Identity());
    if (!mirrored) return followers;
    const auto [plane, images] = mirrorOfRig(*now.rig);
    const Mat3 reflection = Mat3::Identity() - 2 * plane.normal * plane.normal.transpose();
    const std::size_t onThisSide = followers.size();
    if (images[joint] != kNoIndex) add(images[joint], reflection, joint);
    for (std::size_t f = 0; f < onThisSide; ++f) {
      const Index original = followers[f].joint;
      if (images[original] != kNoIndex) add(images[original], reflection, original);
    }
    return followers;
  }
  Drag& drag() const {
    if (!session.drag_) refuse("no joint is being dragged", {}, "begin_drag comes first");
    return *session.drag_;
  }
  void operator()(const UpdateDrag& c) const {
    std::optional<Pose> pose = drag().at(c.ray, c.view, c.snap);
    if (!pose) return;
    session.state_.pose = *std::move(pose);
    session.record_->add(command);
  }
  void operator()(const TurnDrag& c) const {
    session.state_.pose = drag().turned(c.axis, c.degrees);
    session.record_->add(command);
  }
  void operator()(const MoveDrag& c) const {
    if (!c.offset.allFinite() || !c.turn.allFinite()) refuse("the offset or the turn is no number");
    session.state_.pose = drag().carried(c.offset, c.turn);
    session.record_->add(command);
  }
  // The undo step is the whole drag: it goes back to the pose at its beginning.
  void operator()(const EndDrag&) const {
    SessionState next = session.state_;
    session.state_.pose = drag().start();
    letGo(next, drag());
    session.drag_.reset();
    session.commit(command, std::move(next));
  }
  // Moves the targets of pinned joints to where the drag moved these.
  static void letGo(SessionState& next, const Drag& drag) {
    const Skeleton& skeleton = next.rig->skeleton();
    followPose(next, [&](const PinnedTarget& target) {
      return std::any_of(drag.dragged().begin(), drag.dragged().end(), [&](const DragFollower& f) {
        return f.joint == target.joint || isInLimbAbove(skeleton, f.joint, target.joint);
      });
    });
    authored(next);
  }
  void operator()(const CancelDrag&) const {
    session.state_.pose = drag().start();
    session.drag_.reset();
    session.record_->cancelDrag();
  }

  void operator()(const PlaceJoint& c) const {
    if (!c.position.allFinite()) refuse("the position is no number");
    dragOnce(c, DragMode::kMove, [&](Drag& drag, const Vec3& position) {
      return drag.moved(c.relative ? c.position : Vec3(c.position - position));
    });
  }
  void operator()(const SetTurn& c) const {
    if (!c.turn.allFinite()) refuse("the turn is no number");
    dragOnce(c, DragMode::kTurn, [&](Drag& drag, const Vec3&) {
      if (!c.relative) return drag.turnedTo(c.turn);
      return c.turn.isZero(0) ? drag.start() : drag.turned(c.turn, c.turn.norm());
    });
  }
  // A drag without a pointer, from taking hold to letting go.
  template <class Gesture, class Move>
  void dragOnce(const Gesture& c, DragMode mode, const Move& move) const {
    SessionState next = state();
    const Index joint = requireJoint(next, c.joint);
    const Vec3 position = poseGlobals(next.rig->skeleton(), next.pose)[joint].translation();
    Drag drag(sceneOf(next, joint, c), joint, mode, {position + Vec3::UnitZ(), -Vec3::UnitZ()}, -Vec3::UnitZ());
    next.pose = move(drag, position);
    letGo(next, drag);
    session.commit(command, std::move(next));
  }

  void operator()(const SetIk& c) const {
    SessionState next = state();
    findIkMethod(c.solver);
    next.ik = c.on;
    next.solver = c.solver;
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const SetDeformer& c) const {
    SessionState next = state();
    next.deformer = findDeformer(c.deformer).name;
    session.commit(command, std::move(next));
  }
  void operator()(const SetTarget& c) const {
    SessionState next = state();
    setTarget(next.targets, {requireJoint(next, c.joint), c.position});
    const std::vector<Affine> globals = poseGlobals(next.rig->skeleton(), next.pose);
    for (const std::string& name : c.with) {
      const Index joint = requireJoint(next, name);
      setTarget(next.targets, {joint, globals[joint].translation()});
    }
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const ClearTarget& c) const {
    SessionState next = state();
    for (const Index joint : jointsOf(next, c)) eraseTarget(next.targets, joint);
    session.commit(command, std::move(next));
  }
  void operator()(const SetLimits& c) const {
    SessionState next = state();
    setLimits(next, c.limits);
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const ResetJoint& c) const {
    SessionState next = state();
    const std::vector<PinnedTarget> feet =
        next.limbsFollow ? standingFeet(*next.rig, next.rig->home) : std::vector<PinnedTarget>();
    for (const Index joint : jointsOf(next, c)) {
      next.pose.locals[joint] = next.rig->home.locals[joint];
      eraseTarget(next.targets, joint);
      for (const PinnedTarget& foot : feet) {
        if (foot.joint == joint) next.targets.push_back(foot);
      }
    }
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const ResetPose&) const {
    SessionState next = state();
    next.pose = next.rig->home;
    next.targets.clear();
    holdStandingFeet(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const MirrorPose& c) const {
    SessionState next = state();
    const auto [plane, images] = mirrorOfRig(*next.rig);
    next.pose = mirrorPose(next.rig->skeleton(), next.pose, plane, images, c.from);
    followPose(next, [](const PinnedTarget&) { return true; });
    authored(next);
    session.commit(command, std::move(next));
  }

  void operator()(const ApplyPose& c) const {
    SessionState next = state();
    applyPose(next, c);
    authored(next);
    session.commit(command, std::move(next));
  }

  void operator()(const ApplyTasks& c) const {
    SessionState next = state();
    applyTasks(next, c);
    session.commit(command, std::move(next));
  }

  void operator()(const SetRestPose&) const {
    SessionState next = state();
    setRestPose(next);
    session.commit(command, std::move(next));
  }
  // Limits speak of joints by name.
  void operator()(const RenameJoint& c) const {
    SessionState next = state();
    next.rig = renameJoint(*next.rig, requireJoint(next, c.joint), c.name);
    if (next.limits) next.limitsText = limitsToJson(*next.limits, next.rig->skeleton());
    if (next.locked.erase(c.joint) > 0) next.locked.insert(c.name);
    authored(next);
    session.commit(command, std::move(next));
  }

  // A stroke that changes no weight is no step.
  void operator()(const PaintWeights& c) const {
    const SessionState now = state();
    WeightStroke stroke(*now.rig, session.brush_->surface(*now.rig), locksOf(now), c);
    stroke.add(c.dabs);
    reweigh(now, stroke.weights());
  }
  void operator()(const MirrorWeights& c) const {
    const SessionState now = state();
    reweigh(now, mirroredWeights(*now.rig, session.brush_->surface(*now.rig), locksOf(now), c.from));
  }
  void reweigh(SessionState next, SkinWeights weights) const {
    if (weights.joints == next.rig->weights.joints && weights.weights == next.rig->weights.weights) return;
    next.rig = withWeights(*next.rig, std::move(weights));
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const AddJoint& c) const {
    SessionState next = state();
    const Skeleton& skeleton = next.rig->skeleton();
    std::string name = c.name;
    for (int number = 1; name.empty() || (c.name.empty() && skeleton.find(name)); ++number) {
      name = fmt::format("joint_{}", number);
    }
    takeJointEdit(next, withJoint(*next.rig, next.pose, requireJoint(next, c.parent), c.position, name));
    session.commit(command, std::move(next));
  }
  void operator()(const DeleteJoint& c) const {
    SessionState next = state();
    takeJointEdit(next, withoutJoint(*next.rig, requireJoint(next, c.joint)));
    session.commit(command, std::move(next));
  }
  void operator()(const ReparentJoint& c) const {
    SessionState next = state();
    takeJointEdit(next, withJointOn(*next.rig, requireJoint(next, c.joint), requireJoint(next, c.parent)));
    session.commit(command, std::move(next));
  }
  void operator()(const LockWeights& c) const {
    SessionState next = state();
    for (const Index joint : jointsOf(next, c)) {
      const std::string& name = next.rig->skeleton().joints[joint].name;
      if (c.on) {
        next.locked.insert(name);
      } else {
        next.locked.erase(name);
      }
    }
    session.commit(command, std::move(next));
  }

  void operator()(const TransferRig& c) const { session.transferRig(session.fileOf(c.file), c, progress); }
  void operator()(const RigFromAnimation& c) const {
    SessionState next = state();
    const std::shared_ptr<const RiggedModel> made = rigOfAnimation(*next.base, c, progress);
    setRig(next, made, progress);
    takeOwnClips(next.movement, *made);
    show(next);
    session.commit(command, std::move(next));
  }

  void operator()(const AddMotion& c) const { session.addMotion(session.fileOf(c.file), c); }
  void operator()(const AddSampleMotion& c) const {
    SessionState next = state();
    addMotionTo(next, makeSampleMotion(c.name), c.retarget);
    session.commit(command, std::move(next));
  }
  // What changes clips, and then shows the moment anew.
  template <class Edit>
  void move(const Edit& edit) const {
    SessionState next = state();
    edit(next);
    if (next.movement.chosen) show(next);
    session.commit(command, std::move(next));
  }
  void operator()(const RetargetMotion& c) const {
    move([&](SessionState& next) { retargetMotion(next.movement, *next.rig, c); });
  }
  void operator()(const SetContact& c) const {
    move([&](SessionState& next) { setContactOf(next.movement, *next.rig, c); });
  }
  void operator()(const JoinClips& c) const {
    move([&](SessionState& next) { joinClips(next.movement, *next.rig, c); });
  }
  // A clip without keys shows nothing yet: the pose stays.
  void operator()(const AddClip& c) const {
    SessionState next = state();
    addClip(next.movement, c.clip);
    session.commit(command, std::move(next));
  }
  void operator()(const RemoveClip& c) const {
    move([&](SessionState& next) { removeClip(next.movement, c.clip); });
  }
  void operator()(const RenameClip& c) const {
    SessionState next = state();
    renameClip(next.movement, c.clip, c.name);
    session.commit(command, std::move(next));
  }
  void operator()(const ChooseClip& c) const {
    move([&](SessionState& next) {
      chooseClip(next.movement, c.clip);
      next.pose = next.rig->home;
      holdStandingFeet(next);
      authored(next);
    });
  }
  void operator()(const SetTime& c) const {
    session.showMoment(c.seconds);
    session.record_->add(command);
  }
  void operator()(const SetKey& c) const {
    SessionState next = state();
    setKeyOf(next.movement, next.rig->skeleton(), next.pose, c.span);
    session.commit(command, std::move(next));
  }
  void operator()(const EditKeys& c) const {
    move([&](SessionState& next) { retimeKeysOf(next.movement, next.rig->skeleton(), c); });
  }
  void operator()(const DeleteKeys& c) const {
    move([&](SessionState& next) { deleteKeysOf(next.movement, next.rig->skeleton(), c.keys); });
  }
  void operator()(const SetJointKey& c) const {
    move([&](SessionState& next) { setJointKeyOf(next.movement, next.rig->skeleton(), c); });
  }
  void operator()(const SetTangents& c) const {
    move([&](SessionState& next) { setTangentsOf(next.movement, next.rig->skeleton(), c); });
  }
  void operator()(const PasteKeys& c) const {
    move([&](SessionState& next) { pasteKeysOf(next.movement, *next.rig, c); });
  }
  void operator()(const SetInterpolation& c) const {
    move([&](SessionState& next) { setInterpolationOf(next.movement, next.rig->skeleton(), c.interpolation); });
  }

  void operator()(const Undo&) const {
    state();
    if (session.undo_.empty()) refuse(ErrorKind::kNothingToUndo, "there is nothing to undo");
    go(session.undo_, session.redo_);
  }
  void operator()(const Redo&) const {
    state();
    if (session.redo_.empty()) refuse(ErrorKind::kNothingToRedo, "there is nothing to do again");
    go(session.redo_, session.undo_);
  }
  void go(std::vector<Step>& from, std::vector<Step>& to) const {
    Step step = std::move(from.back());
    from.pop_back();
    SessionState now = session.state_;
    session.setState(std::exchange(step.before, std::move(now)));
    to.push_back(std::move(step));
    session.record_->add(command);
  }
};

Session::Session(Resolver files, std::shared_ptr<CommandRecord> record)
    : files_(std::move(files)), brush_(std::make_unique<Brush>()), record_(std::move(record)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::run(const Command& command, Progress& progress) {
  endLive();
  std::visit(Runner{*this, command, progress}, command);
}

void Session::open(ByteSpan bytes, std::string_view name, Progress& progress, bool limbsFollow) {
  progress.stage("read");
  start(readAsset(bytes, name, files_), OpenFile{std::string(name), limbsFollow}, {limbsFollow}, progress);
}

void Session::add(ByteSpan bytes, const AddFile& command, Progress& progress) {
  if (isOpen()) refuseSecond();
  progress.stage("read");
  start(readAsset(bytes, command.file, files_), command, {command.limbsFollow, command.asProp}, progress);
}

// Percent signs and the like belong to the name; what leads out of the folder is refused.
Bytes Session::fileOf(const std::string& name) const {
  std::optional<Bytes> bytes = files_ ? files_(localPath(percentEncode(name))) : std::nullopt;
  if (!bytes) throw Error(ErrorCode::kFile, "cannot be opened", name);
  return *std::move(bytes);
}

void Session::addMotion(ByteSpan bytes, const AddMotion& command) {
  endLive();
  requireOpen();
  if (drag_) refuseDragged();
  SessionState next = state_;
  addMotionTo(next, readMotion(bytes, command.file, {}, files_), command.retarget);
  commit(command, std::move(next));
}

void Session::transferRig(ByteSpan bytes, const TransferRig& command, Progress& progress) {
  endLive();
  requireOpen();
  if (drag_) refuseDragged();
  SessionState next = state_;
  setRig(next, rigOfOther(next, bytes, command.file, files_, progress), progress);
  commit(command, std::move(next));
}

void Session::start(Asset source, const Command& command, Opening how, Progress& progress) {
  endLive();
  const std::optional<SavedSession> saved = takeSession(source);
  state_ = startState(std::make_shared<const Asset>(std::move(source)), saved, how.asProp, progress);
  if (!saved && how.limbsFollow) letLimbsFollow(state_);
  undo_.clear();
  redo_.clear();
  drag_.reset();
  record_->add(command);
}

// Whether it is one undo step with the one before it.
bool Session::goesOnWithLast(const Command& command) const {
  const std::span<const Command> done = record_->commands();
  if (std::holds_alternative<SetHandles>(command)) return std::holds_alternative<SetHandles>(done.back());
  const auto* ended = std::get_if<EndDrag>(&command);
  if (!ended || !ended->goesOn) return false;
  const auto begin =
      std::find_if(done.rbegin(), done.rend(), [](const Command& c) { return std::holds_alternative<BeginDrag>(c); });
  const auto before = std::next(begin);  // the record begins with a model's opening
  return std::holds_alternative<EndDrag>(*before);
}

// Rigs of an undo history keep nothing that their deformers prepared.
void Session::setState(SessionState next) {
  if (next.rig->preparations != state_.rig->preparations) state_.rig->preparations->forget();
  state_ = std::move(next);
}

void Session::commit(const Command& command, SessionState next) {
  const bool again = !undo_.empty() && goesOnWithLast(command);
  if (!again) {
    undo_.push_back({commandName(command), state_});
    ++stepsMade_;
  }
  setState(std::move(next));
  redo_.clear();
  record_->add(command);

  // A rig whose weights alone are edited has the document of the original.
  std::set<const RiggedModel*> rigs;
  std::set<const Asset*> documents;
  std::size_t weights = 0, kept = 0;
  const auto count = [&](const SessionState& of) {
    for (const std::shared_ptr<const RiggedModel>& rig : {of.rig, of.authoredRig}) {
      documents.insert(&rig->asset());
      if (rigs.insert(rig.get()).second) weights += rig->weights.weights.size();
    }
    return documents.size() <= kMaxRigs && weights <= kMaxWeights;
  };
  count(state_);
  while (kept < std::min(undo_.size(), kMaxSteps) && count(undo_[undo_.size() - 1 - kept].before)) ++kept;
  undo_.erase(undo_.begin(), undo_.end() - static_cast<std::ptrdiff_t>(kept));
}

void Session::showMoment(double seconds) {
  endLive();
  requireOpen();
  if (drag_) refuseDragged();
  setTime(state_.movement, seconds);
  show(state_);
}

void Session::beginLive(Skeleton source) {
  requireOpen();
  if (drag_) refuseDragged();
  endLive();
  live_ = std::make_unique<LiveCharacter>(state_.rig, std::move(source));
  beforeLive_ = state_.pose;
}

void Session::showLive(const Pose& source, double seconds) {
  requireLive();
  state_.pose = live_->next(source, seconds);
}

void Session::endLive() {
  if (!live_) return;
  state_.pose = std::move(beforeLive_);
  live_.reset();
}

Motion Session::recordedLive() const {
  return requireLive().recorded();
}

const LiveCharacter& Session::requireLive() const {
  if (!live_) refuse("no motion is live");
  return *live_;
}

void Session::requireOpen() const {
  if (!isOpen()) refuse(ErrorKind::kNoModel, "no model is open");
}

const SessionState& Session::state() const {
  requireOpen();
  return state_;
}

const Asset& Session::source() const {
  requireOpen();
  return *state_.base;
}

Session Session::fork() const {
  requireOpen();
  if (drag_) refuseDragged();
  Session session(files_, std::make_shared<CommandRecord>(*record_));
  session.state_ = state_;
  if (live_) session.state_.pose = beforeLive_;
  return session;
}

std::optional<Index> Session::draggedJoint() const {
  return drag_ ? std::optional<Index>(drag_->joint()) : std::nullopt;
}

std::optional<PickHit> Session::pick(const Ray& ray, double slope) const {
  requireOpen();
  if (!ray.origin.allFinite() || !ray.direction.allFinite() || !(ray.direction.norm() > 0)) {
    refuse("the ray has no direction");
  }
  const std::vector<Vec3> centers = posePositions(state_.rig->skeleton(), state_.pose);
  if (const std::optional<PickHit> handle = pickHandle(ray, centers, state_.rig->radii, slope)) return handle;
  return limber::pickSurface(ray, *state_.rig, state_.pose, findDeformer(state_.deformer));
}

std::optional<SurfaceHit> Session::pickSurface(const Ray& ray) const {
  requireOpen();
  if (!ray.origin.allFinite() || !ray.direction.allFinite() || !(ray.direction.norm() > 0)) {
    refuse("the ray has no direction");
  }
  return brush_->hit(ray, state_.rig, state_.pose, findDeformer(state_.deformer));
}

SkinWeights Session::previewPaint(const PaintWeights& stroke) const {
  requireOpen();
  return brush_->preview(state_.rig, locksOf(state_), stroke);
}

std::vector<Affine> Session::skinMatrices() const {
  requireOpen();
  std::vector<Affine> skin(state_.rig->inverseBind.size());
  skinTransforms(poseGlobals(state_.rig->skeleton(), state_.pose), state_.rig->inverseBind, skin);
  return skin;
}

Bytes Session::exportModel(ExportFormat format) const {
  requireOpen();
  return exportState(state_, format);
}

std::string Session::savePose(std::string_view name) const {
  requireOpen();
  return poseToJson({std::string(name), state_.rig->skeleton(), state_.pose});
}

Bytes Session::saveSession() const {
  requireOpen();
  return savedState(state_);
}

}  // namespace limber
