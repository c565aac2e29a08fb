#!/usr/bin/env bash
# Makes the pictures that only the pages of docs/algorithms show, in some seconds and from limber's own samples. Called by
# tools/make_docs.sh; by itself: tools/algorithm_pictures.sh [PROGRAM]
set -euo pipefail

limber=${1:-build/release/limber} images=docs/images work=build/docs
mkdir -p $images $work

# The same dragon with few and with many handles.
$limber sample winged -o $work/dragon.glb --quiet
for count in 6 20 50; do
  $limber rig $work/dragon.glb --handles $count -o $work/dragon_$count.glb --quiet
  $limber preview $work/dragon_$count.glb --show handles --size 320x260 -o $images/algorithm_handles_$count.png --quiet
done

# The weight of one thigh by three methods.
$limber sample biped -o $work/person.glb --quiet
$limber rig $work/person.glb --template humanoid -o $work/person_rigged.glb --quiet
for method in bone-heat geodesic-voxel bounded-biharmonic; do
  $limber rig $work/person_rigged.glb --keep-skeleton --skinning $method -o $work/person_$method.glb --quiet
  $limber preview $work/person_$method.glb --show weights --joint leftUpperLeg --view front --size 300x375 \
    -o $images/algorithm_weights_$method.png --quiet
done

# One reach of the hand with the whole spine, by three solvers.
for solver in ccd fabrik dls; do
  $limber pose $work/person_rigged.glb --reach leftHand=-0.15,0.55,0.55 --base leftHand=hips --solver $solver \
    -o $work/reach_$solver.glb --quiet
  $limber preview $work/reach_$solver.glb --view 60,8 --size 300x375 -o $images/algorithm_solver_$solver.png --quiet
done

# The bones that are found in a step of a walk.
$limber sample walk -o $work/walk_whole.bvh --quiet
$limber convert $work/walk_whole.bvh $work/step.bvh --trim 0:1.1 --quiet
$limber retarget $work/person_rigged.glb $work/step.bvh -o $work/stepping.glb --quiet
$limber rig --from-animation $work/stepping.glb --fps 15 --bones 20 -o $work/step_bones.glb --quiet
$limber preview $work/step_bones.glb --show weights --size 300x375 -o $images/algorithm_decomposition.png --quiet
