#include "limber/motion/limbs/contacts/contact_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/motion/limbs/spring.h"

namespace limber {

namespace {

struct Detection {
  // 1/seconds; 6 to 15; of strength and flatness; by jerk on the shared people (25 and 12 before).
  double plantRate = 9;
  // A foot rests that is as low (hip heights; 0.02 to 0.09) and as slow (hip heights a second; 0.1 to 0.3), seen over
  // the step to a frame; set by hand.
  double low = 0.05, slow = 0.15;
  // Hip heights a second; 10 to 20, and 3 to 8 in the first frame: many recordings have a T-pose there; speeds of the
  // source's pelvis or feet that are no motion but a cut; set by hand.
  double jump = 15, firstJump = 4;

  // A foot that is planted at this speed (hip heights a second; 0.3 to 1; seen over seenSeconds to each side) keeps a
  // billionth of its weight (1e-12 to 1e-6); set by hand on the shared motions and people.
  double freeSpeed = 0.6, freeFirmness = 1e-9;
  double seenSeconds = 1.0 / 30;  // seconds; 0.02 to 0.05; a frame of the slowest recordings

  double sameMoment = 1e-6;  // seconds; up to a frame; from a frame to the edge of an edit; rounding only
};
constexpr Detection kDetection;

// 0 or 1 without a jump.
void follow(bool isOn, double seconds, double& value, double& speed) {
  springTo(isOn ? 1.0 : 0.0, kDetection.plantRate, seconds, value, speed);
  value = std::clamp(value, 0.0, 1.0);
}

}  // namespace

void ContactReader::watch(const WatchedFoot& foot) {
  const PlantDetector detector(setup_.sourceHipHeight);
  feet_.push_back({foot, detector, detector, {}, 0, 0, std::nullopt, {}});
  const std::string& name = setup_.source->joints[foot.ankle].name;
  for (const ContactEdit& edit : setup_.options.contactEdits) {
    if (edit.foot == name) feet_.back().edits.push_back(edit);
  }
}

void ContactReader::next(const BodyFrame& source, double seconds) {
  cut_ = jumps(source, seconds);
  time_ += seconds;
  for (Watched& watched : feet_) {
    if (cut_) {
      watched.ankle.reset();
      watched.toes.reset();
    }
    const Vec3& ankle = source.positions[watched.foot.ankle];
    watched.contact.rests = rests(watched, ankle, seconds);
    watched.before = ankle;
    read(watched, source, cut_ ? 0 : seconds);
  }
}

// Nobody moves that fast.
bool ContactReader::jumps(const BodyFrame& source, double seconds) {
  landmarks_.assign(1, pelvisOf(setup_.map, MapSide::kSource, source.positions));
  for (const Watched& watched : feet_) landmarks_.push_back(source.positions[watched.foot.ankle]);
  const double jump = (frames_++ == 1 ? kDetection.firstJump : kDetection.jump) * setup_.sourceHipHeight * seconds;
  bool jumped = false;
  for (std::size_t i = 0; i < landmarksBefore_.size(); ++i) {
    jumped = jumped || (landmarks_[i] - landmarksBefore_[i]).norm() > jump;
  }
  std::swap(landmarksBefore_, landmarks_);
  return jumped;
}

bool ContactReader::rests(Watched& watched, const Vec3& ankle, double seconds) const {
  const double unit = setup_.sourceHipHeight;
  if (!watched.before || ankle.y() - watched.foot.ankleGround >= kDetection.low * unit) return false;
  return (ankle - *watched.before).norm() < kDetection.slow * seconds * unit;
}

void ContactReader::read(Watched& watched, const BodyFrame& source, double seconds) const {
  const WatchedFoot& foot = watched.foot;
  const Vec3& ankle = source.positions[foot.ankle];
  bool heel = watched.ankle.next(ankle, ankle.y() - foot.ankleGround, seconds);
  bool toes = false;
  if (foot.toes) {
    const Vec3& position = source.positions[*foot.toes];
    toes = watched.toes.next(position, position.y() - foot.toesGround, seconds);
  }
  FootContact& contact = watched.contact;
  if (const std::optional<bool> edited = editAt(watched)) {
    const bool found = heel || toes;
    heel = *edited && (heel || !found);
    toes = *edited && (toes || (!found && foot.toes));
    contact.rests = contact.rests && *edited;
  }
  contact.anchor = toes ? FootAnchor::kToes : heel ? FootAnchor::kAnkle : FootAnchor::kNone;
  contact.flat = heel && toes;
  follow(contact.anchor != FootAnchor::kNone, seconds, contact.strength, watched.strengthSpeed);
  follow(contact.flat, seconds, contact.flatness, watched.flatSpeed);
}

std::optional<bool> ContactReader::editAt(const Watched& watched) const {
  std::optional<bool> planted;
  for (const ContactEdit& edit : watched.edits) {
    if (time_ > edit.from - kDetection.sameMoment && time_ < edit.to + kDetection.sameMoment) planted = edit.planted;
  }
  return planted;
}

ContactTrack::ContactTrack(const RetargetSetup& setup, std::span<const WatchedFoot> feet, const PoseSequence& source)
    : feet_(feet.size()), frameSeconds_(source.frameSeconds), hipHeight_(setup.sourceHipHeight) {
  ContactReader reader(setup);
  for (const WatchedFoot& foot : feet) reader.watch(foot);
  BodyFrame frame;
  for (std::size_t f = 0; f < source.poses.size(); ++f) {
    setup.sourceKinematics.globals(source.poses[f], frame);
    reader.next(frame, f == 0 ? 0 : source.frameSeconds);
    cuts_.push_back(reader.atCut());
    for (std::size_t i = 0; i < feet_; ++i) {
      contacts_.push_back(reader.foot(i));
      FootPosition& position = positions_.emplace_back();
      position.ankle = frame.positions[feet[i].ankle];
      if (feet[i].toes) position.toes = frame.positions[*feet[i].toes];
    }
  }
}

double ContactTrack::firmness(std::size_t frame, std::size_t foot) const {
  const FootAnchor anchor = at(frame, foot).anchor;
  if (anchor == FootAnchor::kNone) return 0;
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(kDetection.seenSeconds / frameSeconds_)));
  std::size_t before = frame, after = frame;
  while (before > 0 && frame - before < reach && !cuts_[before]) --before;
  while (after + 1 < frames() && after - frame < reach && !cuts_[after + 1]) ++after;
  if (before == after) return 1;
  const FootPosition &from = positionAt(before, foot), &to = positionAt(after, foot);
  const Vec3 displacement = anchor == FootAnchor::kToes ? to.toes - from.toes : to.ankle - from.ankle;
  const double speed =
      Vec3(displacement.x(), 0, displacement.z()).norm() / (static_cast<double>(after - before) * frameSeconds_);
  const double fraction = speed / (kDetection.freeSpeed * hipHeight_);
  return std::pow(kDetection.freeFirmness, fraction * fraction);
}

std::vector<TimeSpan> ContactTrack::spans(std::size_t foot) const {
  std::vector<TimeSpan> spans;
  bool wasPlanted = false;
  for (std::size_t f = 0; f < frames(); ++f) {
    const bool planted = at(f, foot).anchor != FootAnchor::kNone;
    const double now = static_cast<double>(f) * frameSeconds_;
    if (planted && !wasPlanted) spans.push_back({now, now});
    if (planted) spans.back().to = now;
    wasPlanted = planted;
  }
  return spans;
}

}  // namespace limber
