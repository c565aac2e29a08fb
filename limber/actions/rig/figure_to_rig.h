// What a rig is made for, whoever makes it: limber's own riggers or programs of the user's.
#pragma once

#include <optional>
#include <vector>

#include "limber/actions/rig/accessories.h"
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

// What a rigger is given of a figure.
struct RiggerInput {
  Accessories accessories;           // that are left out
  std::optional<PreparedMesh> bare;  // the figure without them; none where there are none
  RigOptions options;                // in the space of the surface, with the memory that is for it

  const PreparedMesh& surfaceOf(const FigureToRig& input) const { return bare ? *bare : input.figure.prepared; }
};

// looksForLimbs  of the rigger (RiggerMethod)
RiggerInput riggerInput(const Asset& asset, const FigureToRig& input, const RigOptions& options, bool looksForLimbs);

// Ends the last stage: the times of all, and the asset's warnings before those of the stages.
void completeReport(const Asset& rigged, AutoRigReport& report, Progress& progress);

}  // namespace limber
