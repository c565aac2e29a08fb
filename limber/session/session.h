// The interactive document: a model, its handles, its pose, and everything that a user can do to them.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/document/read.h"
#include "limber/session/command.h"
#include "limber/session/command_record.h"
#include "limber/session/drag/drag.h"
#include "limber/session/drag/pick.h"
#include "limber/session/edit/movement.h"
#include "limber/session/edit/paint_weights.h"
#include "limber/session/rigged_model.h"
#include "limber/skeleton/ik/limits/limits.h"

namespace limber {

class LiveCharacter;

// Of ApplyTasks.
struct TaskOutcome {
  std::string task, outcome;  // as the command has it; taskOutcome()
  bool met = false;
};

// What the user works on, at one time. Copies share everything large, so that each undo step is one.
struct SessionState {
  std::shared_ptr<const Asset> base;  // what rigs are made from: as opened, or with another rest pose
  std::shared_ptr<RigMemory> memory;  // of the base
  std::shared_ptr<const RiggedModel> rig;
  std::string rigger, skinning;                          // how it was made; kept for a model with a rig of its own
  std::vector<JointPin> pins;                            // of rigs from a template, in world space
  std::string templateName = RigOptions().templateName;  // with pins that whose joints they are
  Pose pose;
  // The pose as it was last set by hand, on the rig that it was set on: other numbers of handles start from it, so that
  // going there and back again loses nothing.
  std::shared_ptr<const RiggedModel> authoredRig;
  Pose authoredPose;
  bool ik = false;
  bool limbsFollow = false;  // planted feet are pinned while inverse kinematics is on, on each rig of the model anew
  std::string solver{kLimbSolver};                  // of ikMethods()
  std::string deformer{kLinearBlendDeformer.name};  // of deformers()
  std::vector<PinnedTarget> targets;
  std::string limitsText;  // empty: none
  std::shared_ptr<const JointLimits> limits;
  std::set<std::string> locked;    // joints whose weights painting leaves as they are
  std::vector<TaskOutcome> tasks;  // of the tasks that made this pose
  Movement movement;
};

// How a model is opened that no session was saved with.
struct Opening {
  bool limbsFollow = false;
  bool asProp = false;  // a single joint where the file has no rig
};

inline constexpr std::size_t kMaxSteps = 200;  // that an undo history keeps

enum class ExportFormat { kGlb, kObj, kStl, kPly, kUsdz };

// Only the last of several updates of a drag, counts of handles or moments of a clip in a row is recorded; such counts
// are one undo step, and moments none. A command that fails, or is cancelled through `progress`, leaves everything as
// it was.
class Session {
 public:
  // `files` opens what OpenFile names, and what it refers to. Sessions of one scene share their record.
  explicit Session(Resolver files = {}, std::shared_ptr<CommandRecord> record = std::make_shared<CommandRecord>());
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  // Throws Error kBadArgument for what makes no sense now: a joint that is not there, a drag that has not begun,
  // nothing to undo, no model opened, a command of a scene; but AddSample and AddFile open what a session without a
  // model is to hold. Opening starts a new history.
  void run(const Command& command, Progress& progress);
  // The same as OpenFile, for a file whose bytes are at hand. A model without a rig gets one with the best suggested
  // number of handles; one that saveSession() wrote comes back as it was.
  void open(ByteSpan bytes, std::string_view name, Progress& progress, bool limbsFollow = false);
  // Likewise the same as AddFile.
  void add(ByteSpan bytes, const AddFile& command, Progress& progress);
  // The same as AddMotion, for a file whose bytes are at hand. Throws as readMotion does.
  void addMotion(ByteSpan bytes, const AddMotion& command);
  // The same as TransferRig. Throws as rigOfOther does.
  void transferRig(ByteSpan bytes, const TransferRig& command, Progress& progress);

  // Another session with the same document, and nothing to undo: to try something beside this one. Shares everything
  // large. Throws Error kBadArgument during a drag.
  Session fork() const;

  bool isOpen() const { return state_.rig != nullptr; }
  // These throw Error kBadArgument while nothing is open.
  const SessionState& state() const;
  const Asset& source() const;  // SessionState::base
  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  std::string_view undoName() const { return undo_.empty() ? std::string_view() : undo_.back().command; }
  std::string_view redoName() const { return redo_.empty() ? std::string_view() : redo_.back().command; }
  std::optional<Index> draggedJoint() const;
  // How many steps there are to undo, and how many there ever were: that tells whether a command was one.
  std::size_t undoCount() const { return undo_.size(); }
  std::size_t stepsMade() const { return stepsMade_; }

  // SetTime, without an entry in the record.
  void showMoment(double seconds);

  // A motion that comes frame by frame (live_character.h): the pose follows it, nothing is recorded, and there is
  // nothing to undo. endLive() puts the pose back, as every command does first. showLive() throws Error kBadArgument
  // where nothing is live, beginLive() during a drag and as matchSkeletons does.
  void beginLive(Skeleton source);
  void showLive(const Pose& source, double seconds);
  void endLive();
  // What has come of it. Throws likewise.
  Motion recordedLive() const;

  // What the ray meets: a handle (see pickHandle) or else the surface.
  std::optional<PickHit> pick(const Ray& ray, double slope) const;
  // The surface alone, for a brush. Quick while rig and pose stay: the tree of the surface is kept.
  std::optional<SurfaceHit> pickSurface(const Ray& ray) const;
  // The weights that this stroke would leave; nothing changes. Quick while it is the last one asked about with further
  // dabs. Throws as running it does.
  SkinWeights previewPaint(const PaintWeights& stroke) const;
  // #J, from where a point is bound to where its joint takes it.
  std::vector<Affine> skinMatrices() const;

  // GLB: the rigged model with its clips, its joints standing in the pose; other programs blend its weights linearly,
  // whatever the deformer, as glTF knows nothing else. The others: the posed surface alone as the deformer bends it, an
  // OBJ without its materials, a USDZ with them.
  Bytes exportModel(ExportFormat format) const;
  // See session_file.h. Motions are not part of it, the clips made of them are.
  Bytes saveSession() const;
  // The pose that is shown, as the text of a pose file: for ApplyPose, here or on another model.
  std::string savePose(std::string_view name) const;
  // What was done since a model was opened; run on a new session with the same files it gives the same bytes.
  std::span<const Command> record() const { return record_->commands(); }

 private:
  struct Step {
    std::string_view command;
    SessionState before;
  };
  struct Runner;

  void setState(SessionState next);
  void commit(const Command& command, SessionState next);
  bool goesOnWithLast(const Command& command) const;
  void start(Asset source, const Command& command, Opening how, Progress& progress);
  void requireOpen() const;
  const LiveCharacter& requireLive() const;
  Bytes fileOf(const std::string& name) const;

  Resolver files_;
  SessionState state_;
  std::vector<Step> undo_, redo_;
  std::unique_ptr<Drag> drag_;
  std::unique_ptr<LiveCharacter> live_;
  Pose beforeLive_;
  std::unique_ptr<Brush> brush_;  // what it keeps is only for speed
  std::shared_ptr<CommandRecord> record_;
  std::size_t stepsMade_ = 0;
};

}  // namespace limber
