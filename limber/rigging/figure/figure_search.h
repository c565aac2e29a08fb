// A person found in a body, in whatever pose it is.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/figure/figure_match.h"

namespace limber {

struct FigureSearch {
  Vec3 up = Vec3::UnitY();
  std::optional<Vec3> front;    // where it faces, roughly; none: any direction
  std::vector<FigurePin> pins;  // the figure comes near them as far as a body can
};

// Persons of an adult's proportions who stand, sit, crouch or lean, alone or on and among other objects, as statues and
// scans have them. Analysis by synthesis: balls that may be heads; for each the trunks that may be attached to it; for
// the best of these the limbs that match best and do not overlap; the best of all are improved by small random steps
// and the search for limbs from there, several times. Limbs keep out of a plinth (plinthTop).
//
// The total of a match is 8 and more where there is such a person, and below 6 in animals, furniture and busts. None
// where nothing is as round as a head.
// Cost: about a third of a second on two cores, whatever the size of the mesh. Throws Error kCancelled.
std::optional<MatchedFigure> findFigure(const BodyVolume& body, const FigureSearch& search, Progress& progress);

}  // namespace limber
