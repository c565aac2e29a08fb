// What a rig is made for, whoever makes it: limber's own riggers or programs of the user's.
#pragma once

#include <vector>

#include "limber/actions/rig/auto_rig.h"
#include "limber/character/character.h"
#include "limber/geometry/surface/figure_surface.h"

namespace limber {

struct FigureToRig {
  Character character;  // of the asset, before it gets the rig
  FigureSurface figure;
  std::vector<Index> pieceOf;  // connected piece of each vertex of the figure's surface

  const Geometry& geometry() const { return character.shapedSurface(); }
};

// The stages "read geometry" and "weld". Skins of the asset that were bound in several poses are brought to one, and
// with ExistingRig::kReplace its rig goes; on an Error it is half changed. The report gets what is asked for, what was
// there, and the warnings of welding.
FigureToRig readFigureToRig(Asset& asset, const AutoRigOptions& options, AutoRigReport& report, Progress& progress);

// Ends the last stage: the times of all, and the asset's warnings before those of the stages.
void completeReport(const Asset& rigged, AutoRigReport& report, Progress& progress);

}  // namespace limber
