#include "limber/session/session.h"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "limber/asset/mesh_export.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/uri.h"
#include "limber/asset/write.h"
#include "limber/ik/limits_json.h"
#include "limber/pipeline/pose_asset.h"
#include "limber/rigging/mirror_map.h"
#include "limber/samples/samples.h"
#include "limber/session/mirror_pose.h"
#include "limber/session/pose_transfer.h"
#include "limber/session/session_file.h"

namespace limber {

namespace {

constexpr std::size_t kMostSteps = 200, kMostRigs = 12;  // that an undo history keeps
constexpr double kMirrorTolerance = 0.01;                // of the longest side, for joints that are images

[[noreturn]] void refuse(std::string message, std::string where = {}, std::string remedy = {}) {
  throw Error(ErrorCode::kBadArgument, std::move(message), std::move(where), std::move(remedy));
}

Index requireJoint(const SessionState& state, const std::string& name) {
  const std::optional<Index> joint = state.rig->skeleton().find(name);
  if (!joint) refuse(fmt::format("no joint is called '{}'", name));
  return *joint;
}

bool sameRig(const RiggedModel& a, const RiggedModel& b) {
  const std::vector<Joint>&x = a.skeleton().joints, &y = b.skeleton().joints;
  return a.weights.joints == b.weights.joints && a.weights.weights == b.weights.weights &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Joint& p, const Joint& q) {
           return p.name == q.name && p.parent == q.parent && sameTransform(p.rest, q.rest);
         });
}

double longestSide(const RiggedModel& rig) {
  Box box;
  for (const Vec3f& position : rig.geometry.positions) box.add(position.cast<double>());
  return box.longestSide();
}

void authored(SessionState& state) {
  state.authoredRig = state.rig;
  state.authoredPose = state.pose;
}

// Joints that hold on to a place go back there.
void holdTargets(SessionState& state) {
  if (!state.ik || state.targets.empty()) return;
  LimbPull pull(state.rig->skeleton(), state.targets, state.limits.get());
  pull.solve(state.pose, state.targets);
}

void editPoseOf(SessionState& state, const PoseEdits& edits) {
  editPose(state.rig->skeleton(), state.pose, edits, state.limits.get());
  holdTargets(state);
  authored(state);
}

void setLimits(SessionState& state, const std::string& text) {
  state.limits =
      text.empty() ? nullptr : std::make_shared<const JointLimits>(limitsFromJson(text, state.rig->skeleton()));
  state.limitsText = text;
}

// Targets and limits speak of joints by name, so they go with the rig that had those.
void setRig(SessionState& state, std::shared_ptr<const RiggedModel> rig) {
  if (sameRig(*rig, *state.authoredRig)) rig = state.authoredRig;
  state.pose =
      rig == state.authoredRig ? state.authoredPose : transferPose(*state.authoredRig, state.authoredPose, *rig);
  state.rig = std::move(rig);
  state.targets.clear();
  setLimits(state, {});
}

void setTarget(std::vector<HeldTarget>& targets, const HeldTarget& target) {
  for (HeldTarget& known : targets) {
    if (known.joint == target.joint) {
      known = target;
      return;
    }
  }
  targets.push_back(target);
}

void eraseTarget(std::vector<HeldTarget>& targets, Index joint) {
  targets.erase(std::remove_if(targets.begin(), targets.end(), [&](const HeldTarget& t) { return t.joint == joint; }),
                targets.end());
}

SavedSession savedOf(const SessionState& state) {
  const Skeleton& skeleton = state.rig->skeleton();
  SavedSession saved;
  saved.ownRig = !state.rig->report;
  saved.rigger = state.rigger;
  saved.skinning = state.skinning;
  saved.handles = skeleton.jointCount();
  saved.ik = state.ik;
  saved.limits = state.limitsText;
  for (const HeldTarget& target : state.targets) {
    saved.targets.push_back({skeleton.joints[target.joint].name, target.position});
  }
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (sameTransform(state.pose.locals[j], state.rig->home.locals[j])) continue;
    saved.pose.push_back({skeleton.joints[j].name, state.pose.locals[j]});
  }
  return saved;
}

void restore(SessionState& state, const SavedSession& saved) {
  for (const SavedJoint& joint : saved.pose) state.pose.locals[requireJoint(state, joint.joint)] = joint.local;
  for (const SavedTarget& target : saved.targets) {
    state.targets.push_back({requireJoint(state, target.joint), target.position});
  }
  setLimits(state, saved.limits);
  state.ik = saved.ik;
}

SessionState firstState(const Asset& source, const std::optional<SavedSession>& saved, Progress& progress) {
  AutoRigOptions options;
  const bool own = saved ? saved->ownRig : hasRig(source);
  if (saved && !own) {
    options.rigger = saved->rigger;
    options.skinning = saved->skinning;
    options.rig.handles = saved->handles;
    options.existingRig = hasRig(source) ? ExistingRig::kReplace : ExistingRig::kRefuse;
  }
  SessionState state;
  state.rig = own ? openRiggedModel(source) : makeRiggedModel(source, options, progress);
  state.rigger = options.rigger;
  state.skinning = options.skinning;
  state.pose = saved || !own ? state.rig->home : readNodePose(state.rig->asset, state.rig->binding);
  if (saved) restore(state, *saved);
  authored(state);
  return state;
}

}  // namespace

// Carries out one command; those that change the document commit a changed copy of its state.
struct Session::Runner {
  Session& session;
  const Command& command;
  Progress& progress;

  SessionState state() const {
    session.requireOpen();
    if (session.drag_) refuse("a joint is being dragged", {}, "end_drag or cancel_drag comes first");
    return session.state_;
  }

  void operator()(const OpenSample& c) const { session.start(makeSample(c.name), command, progress); }
  void operator()(const OpenFile& c) const {
    // Percent signs and the like belong to the name; what leads out of the folder is refused.
    const std::string path = localPath(percentEncode(c.file));
    const std::optional<Bytes> bytes = session.files_ ? session.files_(path) : std::nullopt;
    if (!bytes) throw Error(ErrorCode::kFile, "cannot be opened", c.file);
    session.open(*bytes, c.file, progress);
  }
  void operator()(const SetHandles& c) const {
    SessionState next = state();
    rig(next, c.count);
    session.commit(command, std::move(next));
  }
  void operator()(const ChooseMethods& c) const {
    SessionState next = state();
    next.rigger = c.rigger;
    next.skinning = c.skinning;
    rig(next, next.rig->skeleton().jointCount());
    session.commit(command, std::move(next));
  }
  void rig(SessionState& next, Index handles) const {
    AutoRigOptions options;
    options.rigger = next.rigger;
    options.skinning = next.skinning;
    options.rig.handles = handles;
    options.existingRig = hasRig(*session.source_) ? ExistingRig::kReplace : ExistingRig::kRefuse;
    setRig(next, makeRiggedModel(*session.source_, options, progress));
  }

  void operator()(const BeginDrag& c) const {
    const SessionState now = state();
    const Index joint = requireJoint(now, c.joint);
    DragScene scene{&now.rig->skeleton(), now.limits.get(), now.pose, now.ik, now.targets, 2 * now.rig->radii[joint]};
    scene.rollRadius = std::max(scene.rollRadius, longestSide(*now.rig) / 8);
    session.drag_ = std::make_unique<Drag>(std::move(scene), joint, c.mode, c.ray, c.view);
    session.remember(command);
  }
  Drag& drag() const {
    if (!session.drag_) refuse("no joint is being dragged", {}, "begin_drag comes first");
    return *session.drag_;
  }
  void operator()(const UpdateDrag& c) const {
    std::optional<Pose> pose = drag().at(c.ray, c.view);
    if (!pose) return;
    session.state_.pose = *std::move(pose);
    session.remember(command);
  }
  // The undo step is the whole drag: it goes back to the pose at its beginning.
  void operator()(const EndDrag&) const {
    SessionState next = session.state_;
    session.state_.pose = drag().start();
    const Index joint = drag().joint();
    session.drag_.reset();
    for (HeldTarget& target : next.targets) {
      if (target.joint == joint) target.position = poseGlobals(next.rig->skeleton(), next.pose)[joint].translation();
    }
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const CancelDrag&) const {
    session.state_.pose = drag().start();
    session.drag_.reset();
    while (!std::holds_alternative<BeginDrag>(session.record_.back())) session.record_.pop_back();
    session.record_.pop_back();
  }

  void operator()(const TurnJoint& c) const {
    SessionState next = state();
    if (!(c.axis.norm() > 0)) refuse("the axis has no direction");
    editPoseOf(next, {{{c.joint, c.axis.normalized(), c.degrees}}, {}, {}});
    session.commit(command, std::move(next));
  }
  void operator()(const MoveJoint& c) const {
    SessionState next = state();
    editPoseOf(next, {{}, {{c.joint, c.offset}}, {}});
    session.commit(command, std::move(next));
  }
  void operator()(const SetIk& c) const {
    SessionState next = state();
    next.ik = c.on;
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const SetTarget& c) const {
    SessionState next = state();
    setTarget(next.targets, {requireJoint(next, c.joint), c.position});
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const ClearTarget& c) const {
    SessionState next = state();
    eraseTarget(next.targets, requireJoint(next, c.joint));
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
    const Index joint = requireJoint(next, c.joint);
    next.pose.locals[joint] = next.rig->home.locals[joint];
    eraseTarget(next.targets, joint);
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const ResetPose&) const {
    SessionState next = state();
    next.pose = next.rig->home;
    next.targets.clear();
    authored(next);
    session.commit(command, std::move(next));
  }
  void operator()(const MirrorPose& c) const {
    SessionState next = state();
    const Geometry& geometry = next.rig->geometry;
    const std::optional<MirrorMap> mirror = findMirror({geometry.positions, geometry.triangles});
    if (!mirror) throw Error(ErrorCode::kUnsupported, "the model is not its own mirror image", session.source_->name);
    const Skeleton& skeleton = next.rig->skeleton();
    const double tolerance = kMirrorTolerance * longestSide(*next.rig);
    next.pose =
        mirrorPose(skeleton, next.pose, mirror->plane, mirrorJoints(skeleton, mirror->plane, tolerance), c.from);
    holdTargets(next);
    authored(next);
    session.commit(command, std::move(next));
  }

  void operator()(const Undo&) const {
    state();
    if (session.undo_.empty()) refuse("there is nothing to undo");
    go(session.undo_, session.redo_);
  }
  void operator()(const Redo&) const {
    state();
    if (session.redo_.empty()) refuse("there is nothing to do again");
    go(session.redo_, session.undo_);
  }
  void go(std::vector<Step>& from, std::vector<Step>& to) const {
    Step step = std::move(from.back());
    from.pop_back();
    std::swap(step.before, session.state_);
    to.push_back(std::move(step));
    session.remember(command);
  }
};

Session::Session(Resolver files) : files_(std::move(files)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::run(const Command& command, Progress& progress) {
  std::visit(Runner{*this, command, progress}, command);
}

void Session::open(ByteSpan bytes, std::string_view name, Progress& progress) {
  progress.stage("read");
  start(readAsset(bytes, name, files_), OpenFile{std::string(name)}, progress);
}

void Session::start(Asset source, const Command& command, Progress& progress) {
  const std::optional<SavedSession> saved = takeSession(source);
  SessionState state = firstState(source, saved, progress);
  source_ = std::make_shared<const Asset>(std::move(source));
  state_ = std::move(state);
  undo_.clear();
  redo_.clear();
  drag_.reset();
  record_ = {command};
}

void Session::commit(const Command& command, SessionState next) {
  const bool again = std::holds_alternative<SetHandles>(command) && std::holds_alternative<SetHandles>(record_.back());
  if (!again) undo_.push_back({commandName(command), state_});
  state_ = std::move(next);
  redo_.clear();
  remember(command);

  std::set<const RiggedModel*> rigs = {state_.rig.get(), state_.authoredRig.get()};
  std::size_t kept = 0;
  for (; kept < std::min(undo_.size(), kMostSteps); ++kept) {
    rigs.insert(undo_[undo_.size() - 1 - kept].before.rig.get());
    rigs.insert(undo_[undo_.size() - 1 - kept].before.authoredRig.get());
    if (rigs.size() > kMostRigs) break;
  }
  undo_.erase(undo_.begin(), undo_.end() - static_cast<std::ptrdiff_t>(kept));
}

void Session::remember(const Command& command) {
  const bool onlyLast = std::holds_alternative<UpdateDrag>(command) || std::holds_alternative<SetHandles>(command);
  if (onlyLast && record_.back().index() == command.index()) record_.pop_back();
  record_.push_back(command);
}

void Session::requireOpen() const {
  if (!isOpen()) refuse("no model is open");
}

const SessionState& Session::state() const {
  requireOpen();
  return state_;
}

const Asset& Session::source() const {
  requireOpen();
  return *source_;
}

std::optional<Index> Session::draggedJoint() const {
  return drag_ ? std::optional<Index>(drag_->joint()) : std::nullopt;
}

std::optional<PickHit> Session::pick(const Ray& ray, double slope) const {
  requireOpen();
  if (!ray.origin.allFinite() || !ray.direction.allFinite() || !(ray.direction.norm() > 0)) {
    refuse("the ray has no direction");
  }
  std::vector<Vec3> centers;
  for (const Affine& global : poseGlobals(state_.rig->skeleton(), state_.pose)) centers.push_back(global.translation());
  if (const std::optional<PickHit> handle = pickHandle(ray, centers, state_.rig->radii, slope)) return handle;
  return pickSurface(ray, *state_.rig, state_.pose);
}

std::vector<Affine> Session::skinMatrices() const {
  requireOpen();
  std::vector<Affine> skin(state_.rig->inverseBind.size());
  skinTransforms(poseGlobals(state_.rig->skeleton(), state_.pose), state_.rig->inverseBind, skin);
  return skin;
}

Bytes Session::exportModel(ExportFormat format) const {
  requireOpen();
  const RiggedModel& rig = *state_.rig;
  if (format == ExportFormat::kGlb) {
    Asset asset = rig.asset.clone();
    writeNodePose(asset, rig.binding, state_.pose);
    return writeGlb(asset);
  }
  const ExportMesh mesh = exportMesh(rig.asset, posedGeometry(rig.asset, rig.binding, state_.pose).geometry);
  if (format == ExportFormat::kObj) return encodeObj(mesh, {});
  return format == ExportFormat::kStl ? encodeStl(mesh) : encodePly(mesh);
}

Bytes Session::saveSession() const {
  requireOpen();
  Asset asset = source_->clone();
  putSession(asset, savedOf(state_));
  return writeGlb(asset);
}

}  // namespace limber
