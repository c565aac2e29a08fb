// When which foot is planted in a motion, read off the source alone: the one definition of a contact with the ground
// that retargeting has. (limber/evaluate keeps one of its own, as a judge; contact_oracle.h.)
//
// A contact is a property of the source, so it is read before anything is solved, and nothing that is solved changes
// it:
//
//     source --ContactReader, frame by frame--> FootContact --> LimbGoals, FootLock, Pelvis, levelToes
//            --ContactTrack, the whole motion--> spans of contacts, how firm --> refineSpacetime, smoothMotion
//
// The reader is causal, so that live motion and whole motions have the same contacts. Anything else to be known of a
// contact (positions on surfaces, of hands as well) belongs in here.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/character/matching/retarget_setup.h"
#include "limber/motion/limbs/contacts/plant_detector.h"
#include "limber/skeleton/clip/keys/time_span.h"

namespace limber {

// What holds the foot: nothing, its ankle, or its toes (about which it rolls).
enum class FootAnchor { kNone, kAnkle, kToes };

// A foot in one frame.
struct FootContact {
  FootAnchor anchor = FootAnchor::kNone;
  bool flat = false;    // heel and toes are planted
  bool rests = false;   // the ankle is low and all but still in this very frame, which the detector tells late
  double strength = 0;  // of the anchor, 0 to 1, comes and goes smoothly
  double flatness = 0;  // likewise

  bool isPlanted() const { return anchor != FootAnchor::kNone || rests; }
};

// A foot of the source, and the heights that its joints have when standing, metres.
struct WatchedFoot {
  Index ankle = 0;
  std::optional<Index> toes;
  double ankleGround = 0, toesGround = 0;
};

// While a foot of the source is planted.
struct FootSpans {
  Index foot = 0;                 // WatchedFoot::ankle
  std::vector<TimeSpan> planted;  // from their first frames to their last ones
};

// Contacts frame after frame, without looking ahead; what the user says (RetargetOptions::contactEdits) counts more
// than what is read.
class ContactReader {
 public:
  // Must outlive this.
  explicit ContactReader(const RetargetSetup& setup) : setup_(setup) {}

  void watch(const WatchedFoot& foot);
  // `seconds` have passed since the frame before (0: the first).
  void next(const BodyFrame& source, double seconds);
  // Whether the source jumped to the last frame: what stood before it does not count.
  bool atCut() const { return cut_; }
  // In the order in which they were watched.
  const FootContact& foot(std::size_t i) const { return feet_[i].contact; }
  std::size_t feet() const { return feet_.size(); }

 private:
  struct Watched {
    WatchedFoot foot;
    PlantDetector ankle, toes;
    FootContact contact;
    double strengthSpeed = 0, flatSpeed = 0;
    std::optional<Vec3> before;  // the ankle, in the frame before
    std::vector<ContactEdit> edits;
  };

  bool jumps(const BodyFrame& source, double seconds);
  void read(Watched& watched, const BodyFrame& source, double seconds) const;
  bool rests(Watched& watched, const Vec3& ankle, double seconds) const;
  // Whether it is planted in this frame, where the user says so.
  std::optional<bool> editAt(const Watched& watched) const;

  const RetargetSetup& setup_;
  std::vector<Watched> feet_;
  std::vector<Vec3> landmarks_, landmarksBefore_;  // the pelvis, then the ankles
  std::size_t frames_ = 0;
  double time_ = 0;  // of the frame, seconds
  bool cut_ = false;
};

// Those of a whole motion.
class ContactTrack {
 public:
  ContactTrack(const RetargetSetup& setup, std::span<const WatchedFoot> feet, const PoseSequence& source);

  std::size_t frames() const { return cuts_.size(); }
  bool isCut(std::size_t frame) const { return cuts_[frame]; }
  const FootContact& at(std::size_t frame, std::size_t foot) const { return contacts_[frame * feet_ + foot]; }
  // How firmly the contact holds the foot, 0 to 1: the less, the faster the source's own foot moves along the ground
  // while it is planted. 0 where nothing holds it.
  double firmness(std::size_t frame, std::size_t foot) const;
  // While something holds it.
  std::vector<TimeSpan> spans(std::size_t foot) const;

 private:
  struct FootPosition {
    Vec3 ankle = Vec3::Zero(), toes = Vec3::Zero();
  };
  const FootPosition& positionAt(std::size_t frame, std::size_t foot) const { return positions_[frame * feet_ + foot]; }

  std::size_t feet_;
  double frameSeconds_, hipHeight_;      // the source's
  std::vector<bool> cuts_;               // by frame
  std::vector<FootContact> contacts_;    // of each frame, of each foot
  std::vector<FootPosition> positions_;  // likewise
};

}  // namespace limber
