// How well handles suit a model, measured from the model alone.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "limber/report/table.h"

namespace limber {

// inside          fraction of the handles that lie within the surface (JointPlacement)
// idle            handles that no vertex follows by a tenth
// coveredEnds     of the ends of limbs, those whose vertices follow one handle most that is neither the root nor that
//                 of another end
// strayParents    handles whose region touches no part of their parent's region. A region is the vertices that follow a
//                 handle more than any other; pieces of the surface touch where they are nearest (pieceLinks)
// unequalEnds     ends that are not covered although an equal one is: as long and as thick, within a tenth
// overAir         fraction of all weight, by area, that is cut off from a handle's region (WeightQuality::islands)
// movedBeside     of the area, what follows a handle or its children by a tenth and more, but is neither of their
//                 regions nor of one that touches these; mean over the handles but the root. A leg that another drags
struct HandleQuality {
  Index handles = 0, idle = 0, ends = 0, coveredEnds = 0, unequalEnds = 0, strayParents = 0;
  double inside = 0, overAir = 0, movedBeside = 0;
};

struct LimbEndOnModel {
  Vec3 position = Vec3::Zero();
  double reach = 0, depth = 0;  // as of a LimbTip
};

// The ends of the model's limbs by the longest paths through its inside (limbTips), of those that are longer than what
// they leave is thick: another method than that which positions handles. None where nothing lies inside. In the model's
// space. Cost: that of measureBody.
std::vector<LimbEndOnModel> limbEndsOf(const TriMesh& mesh);

// model  welded (weldedModel)
// ends   limbEndsOf its mesh
// Cost: that of measureJointPlacement and measureWeights.
HandleQuality measureHandles(const SkinnedModel& model, std::span<const LimbEndOnModel> ends);

struct HandleTableRow {
  std::string file;  // without folder and extension
  HandleQuality quality;
};

// Gives the asset so many handles, instead of any rig that it has.
using HandleRigger = std::function<void(Asset& asset, Index count)>;
// Is shown the asset of each row with its handles.
using HandlesSeen = std::function<void(const Asset&)>;

// A row for each file and count, in this order. Files that cannot be read or rigged are counted in `skipped`
// ("unreadable"); of a file with fewer vertices than a count its further counts are left out ("few-vertices").
std::vector<HandleTableRow> evaluateHandles(std::span<const std::filesystem::path> files, std::span<const Index> counts,
                                            const HandleRigger& rig, const HandlesSeen& seen, Progress& progress,
                                            Warnings& skipped);

// A line for each row, and one of sums and means.
Table handleTable(std::span<const HandleTableRow> rows);

}  // namespace limber
