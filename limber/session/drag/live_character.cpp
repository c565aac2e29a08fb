#include "limber/session/drag/live_character.h"

#include <algorithm>

#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/rest_form.h"
#include "limber/motion/limbs/body/skin_tube.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/session/refuse.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

namespace {

constexpr std::size_t kMaxLiveFrames = 36'000;  // ten minutes at 60 a second

}  // namespace

LiveCharacter::LiveCharacter(std::shared_ptr<const RiggedModel> rig, Skeleton source)
    : rig_(std::move(rig)),
      source_(std::move(source)),
      map_(matchSkeletons(source_, rig_->character.reading())),
      plainSource_(source_),
      plainTarget_(rig_->skeleton()),
      turn_(turnToStand(rig_->character.reading())) {}

void LiveCharacter::begin(const Pose& source) {
  frame_.poses = {source};
  const PoseSequence plain = plainSource_.plain(frame_);
  if (const std::optional<Pose> pose = poseWithForm(source_, frame_.poses)) {
    map_ = matchSkeletons(source_, rig_->character.reading(), false, &*pose);
  }
  RetargetOptions options;
  options.characterOnGround = true;
  options.skin = makeBodySkin(rig_->skeleton(), rig_->geometry().positions, rig_->weights);
  setup_.emplace(plainSource_.skeleton(), plainTarget_.skeleton(), map_, options, &plain);
  retargeter_ = findRetargetMethod("limb-ik").make(*setup_);
}

const Pose& LiveCharacter::next(const Pose& source, double seconds) {
  if (source.locals.size() != source_.joints.size()) refuse("the frame has another number of joints");
  constexpr double kShortest = 1e-3, kLongest = 0.5;  // seconds between frames; a sender that pauses comes back
  const double since = moments_.empty() ? 0 : std::clamp(seconds - last_, kShortest, kLongest);
  last_ = seconds;
  if (!retargeter_) begin(source);
  if (poses_.size() == kMaxLiveFrames) {
    moments_.erase(moments_.begin(), moments_.begin() + kMaxLiveFrames / 2);
    poses_.erase(poses_.begin(), poses_.begin() + kMaxLiveFrames / 2);
  }
  moments_.push_back(moments_.empty() ? 0 : moments_.back() + since);
  poses_.push_back(source);

  frame_.poses = {source};
  frame_ = plainSource_.plain(std::move(frame_));
  target_ = restPose(plainTarget_.skeleton());  // what no bone moves rests
  retargeter_->next(frame_.poses[0], since, target_);
  PoseSequence made;
  made.poses = {target_};
  shown_ = std::move(plainTarget_.original(std::move(made)).poses[0]);
  for (std::size_t j = 0; j < shown_.locals.size(); ++j) {
    if (rig_->skeleton().joints[j].parent) continue;
    shown_.locals[j].translation = turn_ * shown_.locals[j].translation;
    shown_.locals[j].rotation = turn_ * shown_.locals[j].rotation;
  }
  return shown_;
}

Motion LiveCharacter::recorded() const {
  Motion motion;
  motion.name = "live";
  motion.skeleton = source_;
  std::vector<double> seconds;
  for (const double moment : moments_) seconds.push_back(moment - moments_.front());
  Clip& clip = motion.clips.emplace_back(clipOfKeys(source_, poses_, seconds));
  clip.name = motion.name;
  motion.framesPerSecond = measuredFrameRate(clip).value_or(motion.framesPerSecond);
  return motion;
}

}  // namespace limber
