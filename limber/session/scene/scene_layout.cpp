#include "limber/session/scene/scene_layout.h"

#include <algorithm>

#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

constexpr double kRoom = 0.25;  // between neighbours, as a fraction of the wider one

std::size_t indexOf(std::span<const SceneMember> members, const Session* session) {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const SceneMember& m) { return m.session.get() == session; });
  return static_cast<std::size_t>(found - members.begin());
}

}  // namespace

Affine jointFrame(const SessionState& state, const std::string& joint) {
  return poseGlobals(state.rig->skeleton(), state.pose)[requireJoint(state, joint)];
}

Affine toScene(std::span<const SceneMember> members, std::size_t member) {
  const SceneMember& of = members[member];
  if (!of.attachment) return of.placement.toAffine();
  const Attachment& attachment = *of.attachment;
  return toScene(members, indexOf(members, attachment.to.get())) *
         jointFrame(attachment.to->state(), attachment.joint) * attachment.offset;
}

Box boxOf(const Session& session, const Affine& transform) {
  Box box;
  for (const Vec3f& position : session.state().rig->geometry().positions) box.add(transform * position.cast<double>());
  return box;
}

Placement besideOthers(std::span<const SceneMember> members, const Session& added) {
  Box all;
  double widest = 0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Box box = boxOf(*members[m].session, toScene(members, m));
    all.add(box.min);
    all.add(box.max);
    widest = std::max(widest, box.size().x());
  }
  const Box own = boxOf(added, Affine::Identity());
  const double ground = boxOf(*members[0].session, toScene(members, 0)).min.y();
  const double room = kRoom * std::max(widest, own.size().x());
  Placement placement;
  placement.position = {all.max.x() + room - own.min.x(), ground - own.min.y(), all.center().z() - own.center().z()};
  return placement;
}

bool isCarriedBy(std::span<const SceneMember> members, std::size_t member, const Session* carrier) {
  for (;;) {
    const SceneMember& of = members[member];
    if (of.session.get() == carrier) return true;
    if (!of.attachment) return false;
    member = indexOf(members, of.attachment->to.get());
  }
}

void carryOver(Attachment& attachment, const RiggedModel& from, const RiggedModel& to, bool sameRig) {
  const std::optional<Index> known = from.skeleton().find(attachment.joint);
  if (!known || (sameRig && to.skeleton().find(attachment.joint))) return;
  const Affine before = restGlobals(from.skeleton())[*known];
  const std::vector<Affine> rest = restGlobals(to.skeleton());
  const auto distance = [&](Index joint) { return (rest[joint].translation() - before.translation()).norm(); };
  // Among joints at one position, the one of the same name.
  Index nearest = to.skeleton().find(attachment.joint).value_or(0);
  for (Index j = 0; j < rest.size(); ++j) nearest = distance(j) < distance(nearest) ? j : nearest;
  attachment.joint = to.skeleton().joints[nearest].name;
  attachment.offset = rest[nearest].inverse() * before * attachment.offset;
}

}  // namespace limber
