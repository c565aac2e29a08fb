// What a program gave back, matched with the model that it was given.
#pragma once

#include <optional>

#include "limber/adapters/adapter.h"
#include "limber/adapters/handed_model.h"
#include "limber/adapters/program_run.h"
#include "limber/core/error.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// weights  #V vertices of the model; none where the file has none, or the adapter passes them over
struct ReturnedRig {
  Skeleton skeleton;  // in the working space, without rest scales
  std::optional<SkinWeights> weights;
  Warnings warnings;
};

// rignet-text: vertices are those handed over, in their order; joints must lie in or beside the model, and near the
// vertices that they move as the axes are.
// glb, fbx: the surface in the file must be the model's own, in any order of vertices, with vertices doubled or the
// triangles fewer. Each vertex takes the weights of the one at its position, else of the nearest point of that surface.
// Its box must be the model's; with Adapter::mayRescale it is first moved and scaled to it.
//
// Vertices for which the file gives no weights take those of what is nearest (warning "unbound-vertices").
//
// working  welded, centred, longest side 1
// slots    influences kept of each vertex
// Throws Error kBadData that says what is wrong: garbage, no skin, another surface, axes swapped, another size.
// Cost: O(#V log #F).
ReturnedRig readReturnedRig(const ProgramOutput& output, const Adapter& adapter, const TriMesh& working,
                            const HandedModel& handed, Index slots);

}  // namespace limber
