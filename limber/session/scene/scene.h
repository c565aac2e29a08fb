// Several models in one scene, each a session of its own, with one history.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/actions/export/write_model.h"
#include "limber/session/session.h"

namespace limber {

// A model's own space in that of the scene: position + turn * (scale * point).
struct Placement {
  Vec3 position = Vec3::Zero();  // metres
  Vec3 turn = Vec3::Zero();      // a rotation vector, degrees
  double scale = 1;              // above 0

  Affine toAffine() const;
};
// The nearest one: shear goes, and scales along different axes become one of the same volume.
Placement placementOf(const Affine& affine);

// A member that follows a joint of another one.
struct Attachment {
  std::shared_ptr<const Session> to;
  std::string joint;
  Affine offset = Affine::Identity();  // the member's own space in that of the joint
};

struct SceneMember {
  std::string name;  // unique in the scene
  std::shared_ptr<Session> session;
  Placement placement;  // of no account while it is attached
  std::optional<Attachment> attachment;
};

struct SceneHit {
  std::size_t member = 0;
  PickHit hit;  // in the member's own space
};

// Commands go to the chosen member, and are in its own space, but for those of a scene. A scene of one member does what
// a session does, and has the same record. What is removed comes back whole when that is undone.
//
// An attachment lives through changes of the rig that it holds on to: it goes over to the joint nearest to the old one
// in the bind pose, and the member stays where it was.
class SessionScene {
 public:
  // `files`: as for a session.
  explicit SessionScene(Resolver files = {});
  // A scene of that model alone, with nothing to undo.
  explicit SessionScene(Session session);
  ~SessionScene();
  SessionScene(SessionScene&&) noexcept;
  SessionScene& operator=(SessionScene&&) noexcept;

  // Errors and cost as of Session::run; kBadArgument too for members that are not there, names that are taken, and
  // members that would hold themselves. Opening starts a new scene.
  void run(const Command& command, Progress& progress);
  // The same as OpenFile, AddFile, AddMotion and TransferRig, for files whose bytes are at hand.
  void open(ByteSpan bytes, std::string_view name, Progress& progress, bool limbsFollow = false);
  void add(ByteSpan bytes, const AddFile& command, Progress& progress);
  void addMotion(ByteSpan bytes, const AddMotion& command);
  void transferRig(ByteSpan bytes, const TransferRig& command, Progress& progress);
  // Of the chosen member, as its session's; a command of the scene ends it, too.
  void beginLive(Skeleton source);
  void showLive(const Pose& source, double seconds);
  void endLive();

  bool isOpen() const { return session().isOpen(); }
  // There is always one; its session has no model before one is opened.
  std::span<const SceneMember> members() const { return now_.members; }
  std::size_t chosen() const { return now_.chosen; }
  const Session& session() const { return *now_.members[now_.chosen].session; }
  // The member's own space in that of the scene, as its joints and those that carry it stand.
  Affine toScene(std::size_t member) const;
  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  std::string_view undoName() const { return undo_.empty() ? std::string_view() : undo_.back().command; }
  std::string_view redoName() const { return redo_.empty() ? std::string_view() : redo_.back().command; }

  // The nearest surface that a ray in the chosen member's own space meets.
  std::optional<SceneHit> pick(const Ray& ray) const;

  // As Session::exportModel for one member. For several a GLB holds all of them, below a node for each; what is
  // attached is a child of its joint's node. The other formats hold the surfaces of all.
  Bytes exportModel(ExportFormat format) const;
  // The same GLB's content in a format (".glb", ".usdz"), as the options say (encodeModel).
  EncodedModel saveModel(std::string_view extension, const WriteModelOptions& options = {}) const;
  std::span<const Command> record() const { return record_->commands(); }

 private:
  struct Arrangement {
    std::vector<SceneMember> members;
    std::size_t chosen = 0;
  };
  // Of one member, or of the arrangement alone.
  struct Step {
    std::string_view command;
    std::shared_ptr<Session> session;  // whose own history has the step; may be null
    Arrangement other;                 // before the step, or after it where it is to be done again
  };
  struct Runner;

  void start(std::shared_ptr<Session> session);
  void join(const Command& command, std::shared_ptr<Session> session);
  template <class Act>
  void onChosen(const Command& command, const Act& act);
  void commit(const Command& command, std::shared_ptr<Session> session, Arrangement before);
  void trim();
  void requireReady() const;
  std::size_t memberOf(const std::string& name) const;
  std::string freeName(const std::string& wanted) const;

  Resolver files_;
  std::shared_ptr<CommandRecord> record_;
  Arrangement now_;
  std::vector<Step> undo_, redo_;
};

}  // namespace limber
