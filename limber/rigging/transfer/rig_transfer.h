// Rig transfer: one body's skeleton and weights on another body, by the surface.
#pragma once

#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/rigging/transfer/limb_alignment.h"
#include "limber/rigging/transfer/surface_gaps.h"
#include "limber/rigging/transfer/surface_registration.h"

namespace limber {

struct RiggedBody {
  TriMesh mesh;         // welded
  Skeleton skeleton;    // in the space of the mesh
  SkinWeights weights;  // of its vertices
};

struct RigTransferOptions {
  Index maxInfluences = 4;  // of each vertex, 1 to 8
  RegistrationOptions registration;
};

struct RigTransfer {
  std::vector<Vec3> positions;       // #J, of the source's joints in the target
  std::vector<Quat> turns;           // #J, by which each is turned (movedSkeleton makes a skeleton of both)
  SkinWeights weights;               // of the target's vertices
  TriMesh source;                    // the source's surface at rest, facing outwards
  std::vector<Vec3> registered;      // #V, where its vertices lie on the target
  std::vector<SurfacePoint> points;  // of each target vertex, the point of the registered surface that it takes after
  SurfaceGaps gaps;
};

// After Avril, Ghafourzadeh, Ramachandran, Fallahdoust, Ribet, Dionne, de Lasa, Paquette 2016, Animation Setup Transfer
// for 3D Characters, without markers: `landmarks` say where some of the source's joints lie in the target. The source
// is laid along the target's limbs by its skeleton (alignLimbs) and made as thick as they are (fitGirths), its surface
// is registered onto the target's (registerSurface), its joints follow the surface round them (followSurface), and each
// vertex of the target takes the weights of the point that it lies on (projectWeights).
//
// target  welded, with triangles
// Throws Error kBadArgument as these do.
RigTransfer transferRig(const RiggedBody& source, std::span<const JointLandmark> landmarks, const TriMesh& target,
                        const RigTransferOptions& options, Progress& progress);

}  // namespace limber
