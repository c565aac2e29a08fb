#include "limber/session/session.h"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include "limber/document/clip/motion_io.h"
#include "limber/document/clip/pose_file.h"
#include "limber/document/uri.h"
#include "limber/samples/samples.h"
#include "limber/session/drag/drag_commands.h"
#include "limber/session/drag/live_character.h"
#include "limber/session/drag/standing_feet.h"
#include "limber/session/edit/edit_joints.h"
#include "limber/session/edit/pose_commands.h"
#include "limber/session/edit/rig_commands.h"
#include "limber/session/edit/taken_rig.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_file.h"
#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

constexpr std::size_t kMaxRigs = 12;             // that an undo history keeps
constexpr std::size_t kMaxWeights = 32'000'000;  // influences that the rigs of an undo history hold

[[noreturn]] void refuseSecond() {
  refuse("a session holds one model", {}, "a scene holds several");
}

// #J
std::vector<bool> locksOf(const SessionState& state) {
  std::vector<bool> locked;
  for (const Joint& joint : state.rig->skeleton().joints) locked.push_back(state.locked.count(joint.name) > 0);
  return locked;
}

void letLimbsFollow(SessionState& state) {
  state.limbsFollow = true;
  state.ik = hasLimbs(*state.rig);
  holdStandingFeet(state);
}

template <class C, class... Others>
concept OneOf = (std::is_same_v<C, Others> || ...);

template <class C>
concept OfScene = OneOf<C, RemoveMember, ChooseMember, RenameMember, PlaceMember, AttachMember, DetachMember, SetClock>;

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

  template <OfScene C>
  void operator()(const C&) const {
    refuse("only a scene has members", {}, "run the command on a scene");
  }

  void operator()(const BeginDrag& c) const {
    const SessionState now = state();
    const Index joint = requireJoint(now, c.joint);
    if (c.mode == DragMode::kScale) requireScalable(now);
    DragScene scene = dragSceneOf(now, joint, c.with, c.mirrored);
    session.drag_ = std::make_unique<Drag>(std::move(scene), joint, c.mode, c.ray, c.view);
    session.record_->add(command);
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
  void operator()(const ScaleDrag& c) const {
    session.state_.pose = drag().scaled(c.scale);
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
  void operator()(const CancelDrag&) const {
    session.state_.pose = drag().start();
    session.drag_.reset();
    session.record_->cancelDrag();
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

  void operator()(const TransferRig& c) const { session.transferRig(session.fileOf(c.file), c, progress); }
  void operator()(const AddMotion& c) const { session.addMotion(session.fileOf(c.file), c); }
  void operator()(const SetTime& c) const {
    session.showMoment(c.seconds);
    session.record_->add(command);
  }

  // Those that change the document alone, each in the file of its idea.
  template <class C>
  void operator()(const C& c) const {
    SessionState next = state();
    if constexpr (requires { apply(c, next.movement, *next.rig); }) {
      apply(c, next.movement, *next.rig);
      if (next.movement.chosen) show(next);
    } else if constexpr (requires { apply(c, next, progress); }) {
      apply(c, next, progress);
    } else {
      apply(c, next);
    }
    session.commit(command, std::move(next));
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
