#include "limber/session/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "limber/document/read.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/scene_io.h"
#include "limber/session/scene/scene_layout.h"

namespace limber {

namespace {

constexpr double kRadians = std::numbers::pi / 180;

void requirePlacement(const PlaceMember& c) {
  if (!c.position.allFinite() || !c.turn.allFinite()) refuse("a member's place is not finite");
  if (!(c.scale > 0) || !std::isfinite(c.scale)) refuse("a member's scale is not above 0");
}

// The moment of a clip that plays again and again; its end is shown once.
double momentOf(const Clip& clip, double seconds) {
  const double duration = clip.duration();
  return seconds <= duration || duration <= 0 ? std::clamp(seconds, 0.0, std::max(0.0, duration))
                                              : std::fmod(seconds, duration);
}

}  // namespace

Affine Placement::toAffine() const {
  Affine affine = Affine::Identity();
  affine.translate(position);
  const double degrees = turn.norm();
  if (degrees > 0) affine.rotate(Eigen::AngleAxisd(kRadians * degrees, turn / degrees));
  affine.scale(scale);
  return affine;
}

Placement placementOf(const Affine& affine) {
  const Transform transform = decompose(affine);
  const Eigen::AngleAxisd turn(transform.rotation);
  return {transform.translation, turn.angle() / kRadians * turn.axis(), std::cbrt(std::abs(transform.scale.prod()))};
}

// Carries out one command.
struct SessionScene::Runner {
  SessionScene& scene;
  const Command& command;
  Progress& progress;

  std::shared_ptr<Session> opened() const {
    auto session = std::make_shared<Session>(scene.files_, scene.record_);
    session->run(command, progress);
    return session;
  }
  void operator()(const OpenSample&) const { scene.start(opened()); }
  void operator()(const OpenFile&) const { scene.start(opened()); }
  void operator()(const AddSample&) const { added(); }
  void operator()(const AddFile&) const { added(); }
  void added() const {
    scene.requireReady();
    scene.join(command, opened());
  }

  void operator()(const RemoveMember& c) const {
    rearrange([&](Arrangement& now) {
      const std::size_t gone = scene.memberOf(c.member);
      if (now.members.size() == 1) refuse(ErrorKind::kLastMember, "the last model of a scene cannot be removed");
      letGoOf(now, gone);
      now.members.erase(now.members.begin() + static_cast<std::ptrdiff_t>(gone));
      if (now.chosen > gone || now.chosen == now.members.size()) --now.chosen;
    });
  }
  // What the member carries stays where it is.
  static void letGoOf(Arrangement& now, std::size_t carrier) {
    std::map<std::size_t, Placement> free;
    for (std::size_t m = 0; m < now.members.size(); ++m) {
      const std::optional<Attachment>& attachment = now.members[m].attachment;
      if (attachment && attachment->to == now.members[carrier].session) {
        free[m] = placementOf(limber::toScene(now.members, m));
      }
    }
    for (const auto& [m, placement] : free) {
      now.members[m].attachment.reset();
      now.members[m].placement = placement;
    }
  }
  void operator()(const ChooseMember& c) const {
    scene.requireReady();
    scene.now_.chosen = scene.memberOf(c.member);
    scene.record_->add(command);
  }
  void operator()(const RenameMember& c) const {
    rearrange([&](Arrangement& now) {
      SceneMember& member = now.members[scene.memberOf(c.member)];
      const auto taken = [&](const SceneMember& other) { return other.name == c.name && &other != &member; };
      if (c.name.empty()) refuseNoName("member");
      if (std::any_of(now.members.begin(), now.members.end(), taken)) {
        refuseNameTaken("member", c.name);
      }
      member.name = c.name;
    });
  }
  void operator()(const PlaceMember& c) const {
    rearrange([&](Arrangement& now) {
      requirePlacement(c);
      const std::size_t m = scene.memberOf(c.member);
      const Placement placement{c.position, c.turn, c.scale};
      SceneMember& member = now.members[m];
      if (!member.attachment) {
        member.placement = placement;
        return;
      }
      const Affine joint = scene.toScene(m) * member.attachment->offset.inverse();
      member.attachment->offset = joint.inverse() * placement.toAffine();
    });
  }
  void operator()(const AttachMember& c) const {
    rearrange([&](Arrangement& now) {
      const std::size_t m = scene.memberOf(c.member), to = scene.memberOf(c.to);
      SceneMember& member = now.members[m];
      if (isCarriedBy(now.members, to, member.session.get())) {
        refuse(ErrorKind::kHoldsItself, fmt::format("'{}' would hold itself", c.member), {{"name", c.member}});
      }
      const Affine joint = scene.toScene(to) * jointFrame(now.members[to].session->state(), c.joint);
      Affine transform = scene.toScene(m);
      if (c.snap)
        transform.pretranslate(joint.translation() - transform * boxOf(*member.session, Affine::Identity()).center());
      member.attachment = Attachment{now.members[to].session, c.joint, joint.inverse() * transform};
    });
  }
  void operator()(const DetachMember& c) const {
    rearrange([&](Arrangement& now) {
      const std::size_t m = scene.memberOf(c.member);
      if (!now.members[m].attachment) refuse(fmt::format("'{}' is attached to nothing", c.member));
      now.members[m].placement = placementOf(scene.toScene(m));
      now.members[m].attachment.reset();
    });
  }
  template <class Change>
  void rearrange(const Change& change) const {
    scene.requireReady();
    Arrangement next = scene.now_;
    change(next);
    Arrangement before = std::exchange(scene.now_, std::move(next));
    scene.record_->add(command);
    scene.commit(command, nullptr, std::move(before));
  }

  void operator()(const SetClock& c) const {
    scene.requireReady();
    if (!std::isfinite(c.seconds) || c.seconds < 0) refuse("the clock cannot show that");
    for (const SceneMember& member : scene.now_.members) {
      if (const Clip* clip = member.session->state().movement.clip()) {
        member.session->showMoment(momentOf(*clip, c.seconds));
      }
    }
    scene.record_->add(command);
  }

  void operator()(const Undo&) const {
    scene.requireReady();
    if (scene.undo_.empty()) refuse(ErrorKind::kNothingToUndo, "there is nothing to undo");
    go(scene.undo_, scene.redo_);
  }
  void operator()(const Redo&) const {
    scene.requireReady();
    if (scene.redo_.empty()) refuse(ErrorKind::kNothingToRedo, "there is nothing to do again");
    go(scene.redo_, scene.undo_);
  }
  // Whose step it was is the chosen one, so that one sees what has changed.
  void go(std::vector<Step>& from, std::vector<Step>& to) const {
    if (const std::shared_ptr<Session>& session = from.back().session) {
      session->run(command, progress);
    } else {
      scene.record_->add(command);
    }
    Step step = std::move(from.back());
    from.pop_back();
    std::swap(step.other, scene.now_);
    const auto& members = scene.now_.members;
    const auto whose = std::find_if(members.begin(), members.end(),
                                    [&](const SceneMember& member) { return member.session == step.session; });
    if (whose != members.end()) scene.now_.chosen = static_cast<std::size_t>(whose - members.begin());
    to.push_back(std::move(step));
  }

  template <class OfSession>
  void operator()(const OfSession&) const {
    scene.onChosen(command, [&](Session& session) { session.run(command, progress); });
  }
};

SessionScene::SessionScene(Resolver files) : files_(std::move(files)), record_(std::make_shared<CommandRecord>()) {
  now_.members.push_back({{}, std::make_shared<Session>(files_, record_), {}, {}});
}
SessionScene::SessionScene(Session session) : record_(std::make_shared<CommandRecord>()) {
  start(std::make_shared<Session>(std::move(session)));
}
SessionScene::~SessionScene() = default;
SessionScene::SessionScene(SessionScene&&) noexcept = default;
SessionScene& SessionScene::operator=(SessionScene&&) noexcept = default;

void SessionScene::beginLive(Skeleton source) {
  now_.members[now_.chosen].session->beginLive(std::move(source));
}
void SessionScene::showLive(const Pose& source, double seconds) {
  now_.members[now_.chosen].session->showLive(source, seconds);
}
void SessionScene::endLive() {
  now_.members[now_.chosen].session->endLive();
}

void SessionScene::run(const Command& command, Progress& progress) {
  endLive();
  std::visit(Runner{*this, command, progress}, command);
}

void SessionScene::open(ByteSpan bytes, std::string_view name, Progress& progress, bool limbsFollow) {
  auto session = std::make_shared<Session>(files_, record_);
  session->open(bytes, name, progress, limbsFollow);
  start(std::move(session));
}

void SessionScene::add(ByteSpan bytes, const AddFile& command, Progress& progress) {
  endLive();
  requireReady();
  auto session = std::make_shared<Session>(files_, record_);
  session->add(bytes, command, progress);
  join(command, std::move(session));
}

void SessionScene::addMotion(ByteSpan bytes, const AddMotion& command) {
  onChosen(command, [&](Session& session) { session.addMotion(bytes, command); });
}

void SessionScene::transferRig(ByteSpan bytes, const TransferRig& command, Progress& progress) {
  onChosen(command, [&](Session& session) { session.transferRig(bytes, command, progress); });
}

Affine SessionScene::toScene(std::size_t member) const {
  return limber::toScene(now_.members, member);
}

std::optional<SceneHit> SessionScene::pick(const Ray& ray) const {
  const Affine fromChosen = toScene(now_.chosen);
  std::optional<SceneHit> nearest;
  double least = 0;  // metres of the scene
  for (std::size_t m = 0; m < now_.members.size(); ++m) {
    const Affine toOwn = toScene(m).inverse() * fromChosen;
    const Ray own{toOwn * ray.origin, toOwn.linear() * ray.direction};
    const SessionState& state = now_.members[m].session->state();
    const std::optional<PickHit> hit = pickSurface(own, *state.rig, state.pose, findDeformer(state.deformer));
    if (!hit) continue;
    const double distance = (toScene(m) * hit->position - fromChosen * ray.origin).norm();
    if (nearest && distance >= least) continue;
    nearest = SceneHit{m, *hit};
    least = distance;
  }
  return nearest;
}

EncodedModel SessionScene::saveModel(std::string_view extension, const WriteModelOptions& options) const {
  const bool isOne = now_.members.size() == 1;
  const std::string stem = isOne ? std::filesystem::path(session().source().name).stem().string() : "scene";
  return encodeModel(readAsset(exportModel(ExportFormat::kGlb), stem + ".glb"), extension, options);
}

Bytes SessionScene::exportModel(ExportFormat format) const {
  return now_.members.size() == 1 ? session().exportModel(format) : exportScene(now_.members, format);
}

void SessionScene::start(std::shared_ptr<Session> session) {
  const std::string name = session->isOpen() ? std::filesystem::path(session->source().name).stem().string() : "";
  now_ = {{{name, std::move(session), {}, {}}}, 0};
  undo_.clear();
  redo_.clear();
}

void SessionScene::join(const Command& command, std::shared_ptr<Session> session) {
  Arrangement before = now_;
  SceneMember member;
  member.name = freeName(std::filesystem::path(session->source().name).stem().string());
  member.placement = besideOthers(now_.members, *session);
  member.session = std::move(session);
  now_.members.push_back(std::move(member));
  now_.chosen = now_.members.size() - 1;
  commit(command, nullptr, std::move(before));
}

// What the chosen member carries goes along with another rig.
template <class Act>
void SessionScene::onChosen(const Command& command, const Act& act) {
  const std::shared_ptr<Session> session = now_.members[now_.chosen].session;
  const std::shared_ptr<const RiggedModel> rig = session->isOpen() ? session->state().rig : nullptr;
  const std::size_t made = session->stepsMade();
  act(*session);
  Arrangement before = session->stepsMade() == made ? Arrangement() : now_;
  if (rig && session->state().rig != rig) {
    const bool sameRig = std::holds_alternative<SetRestPose>(command);
    for (SceneMember& member : now_.members) {
      if (member.attachment && member.attachment->to == session) {
        carryOver(*member.attachment, *rig, *session->state().rig, sameRig);
      }
    }
  }
  if (session->stepsMade() != made) commit(command, session, std::move(before));
}

void SessionScene::commit(const Command& command, std::shared_ptr<Session> session, Arrangement before) {
  undo_.push_back({commandName(command), std::move(session), std::move(before)});
  redo_.clear();
  trim();
}

// Steps of a session that it no longer knows go, with all before them.
void SessionScene::trim() {
  std::map<const Session*, std::size_t> counts;
  std::size_t kept = 0;
  while (kept < std::min(undo_.size(), kMaxSteps)) {
    const Session* of = undo_[undo_.size() - 1 - kept].session.get();
    if (of && ++counts[of] > of->undoCount()) break;
    ++kept;
  }
  undo_.erase(undo_.begin(), undo_.end() - static_cast<std::ptrdiff_t>(kept));
}

void SessionScene::requireReady() const {
  if (!isOpen()) refuse(ErrorKind::kNoModel, "no model is open", {}, {}, "open_sample or open_file comes first");
  if (session().draggedJoint()) refuseDragged();
}

std::size_t SessionScene::memberOf(const std::string& name) const {
  const auto found = std::find_if(now_.members.begin(), now_.members.end(),
                                  [&](const SceneMember& member) { return member.name == name; });
  if (found == now_.members.end()) refuse(fmt::format("no member is called '{}'", name));
  return static_cast<std::size_t>(found - now_.members.begin());
}

std::string SessionScene::freeName(const std::string& wanted) const {
  const auto taken = [&](const std::string& name) {
    return std::any_of(now_.members.begin(), now_.members.end(),
                       [&](const SceneMember& member) { return member.name == name; });
  };
  std::string name = wanted;
  for (int number = 2; taken(name); ++number) name = fmt::format("{} {}", wanted, number);
  return name;
}

}  // namespace limber
