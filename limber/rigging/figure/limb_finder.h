// Where the limbs of a figure may lie, whose trunk is known.
#pragma once

#include <vector>

#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/figure/figure_match.h"

namespace limber {

// Knows, for each medial sphere of a body and a stature, the forearms and shanks that would lead from there to another:
// limbs are put together from these and the upper bones that lead from a trunk to them.
class LimbFinder {
 public:
  // Cost: the bones between all pairs of spheres as far apart as a forearm or shank is long.
  LimbFinder(const BodyVolume& body, const FigureMatch& match, double stature);

  double stature() const { return stature_; }

  struct Effort {
    std::size_t middles;  // elbows or knees to start from
    std::size_t most;     // poses of the limb
    bool turnFeet;        // in or out, too
  };
  struct Candidate {
    FigureLimb bones;
    double match = 0;  // as FigureMatch::limb
  };
  // The best poses of a limb, best first, no two of them alike.
  std::vector<Candidate> find(const Figure& figure, int limb, const Effort& effort) const;

 private:
  struct Lower {
    Vec3 direction;
    double scale, match;
  };
  struct Upper {
    std::size_t sphere;
    FigureLimb bones;
    double match;
  };
  std::vector<Lower> lowersAt(const MedialSphere& sphere, bool leg) const;
  std::vector<Upper> uppersOf(const Figure& figure, int limb, std::size_t most) const;
  Vec3 bestFoot(const Figure& figure, int limb, bool turned) const;

  const BodyVolume& body_;
  const FigureMatch& match_;
  double stature_;
  std::vector<std::vector<Lower>> lowers_[2];  // arms, legs; by sphere
};

}  // namespace limber
