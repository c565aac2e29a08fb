// Heads and trunks that a body may hold: where the search for a figure begins.
#pragma once

#include <vector>

#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/figure/figure_match.h"

namespace limber {

struct HeadBall {
  Vec3 middle = Vec3::Zero();
  double radius = 0;
  double match = 0;  // as FigureMatch::head
};

// Medial spheres that are as round as heads, the roundest first: none in the lower part of the body, none that lies
// within another, none far less round than the first.
std::vector<HeadBall> findHeads(const BodyVolume& body, const FigureMatch& match, const Vec3& up);

// How tall a person with such a head may be: short, middle, tall.
std::vector<double> staturesFor(const HeadBall& head);

// Trunks that may hang from a head, best first, `most` at most and no two alike; of each both fronts. Limbs are yet to
// be found, `total` is the trunk's.
std::vector<MatchedFigure> findTrunks(const BodyVolume& body, const FigureMatch& match, const HeadBall& head,
                                      double stature, const Vec3& up, std::size_t most);

}  // namespace limber
