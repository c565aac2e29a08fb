#!/usr/bin/env bash
# Makes the documentation's pictures (docs/images), the comparison of inverse kinematics (docs/ik.md) and, where the
# shared characters are, its table of weights (docs/weights.md). Called by ./dev docs with the program built.
set -euo pipefail

limber=build/release/limber images=docs/images work=build/docs
mkdir -p $images $work

for sample in winged quadruped robot; do
  $limber sample $sample -o $work/$sample.glb --quiet
  $limber rig $work/$sample.glb --handles 20 -o $work/${sample}_rigged.glb --quiet
done
picture() { $limber preview "$work/$1" --show "$2" --size 480x400 -o "$images/$3" --quiet; }
picture winged.glb model dragon.png
picture winged_rigged.glb handles dragon_handles.png
picture winged_rigged.glb weights dragon_weights.png
picture quadruped_rigged.glb handles fox_handles.png
picture robot_rigged.glb handles robot_handles.png
$limber pose $work/winged_rigged.glb --turn handle_03.L=z:30 --turn handle_03.R=z:-30 --turn handle_07.L=z:15 \
  --turn handle_07.R=z:-15 --turn handle_02=y:25 --turn handle_06=y:25 --turn handle_09=y:-40 --turn handle_04.L=x:-35 \
  -o $work/winged_posed.glb --quiet
picture winged_posed.glb model dragon_posed.png

$limber evaluate ik --problems 100 --plot $images -o docs/ik.md --quiet

characters=${LIMBER_SHARED_DATA:-../shared/data}/rigged
if [ -d "$characters" ]; then
  $limber evaluate skinning "$characters" --references docs/data/blender_weights.tsv -o docs/weights.md --quiet
  echo "Made docs/images, docs/ik.md and docs/weights.md"
else
  echo "Made docs/images and docs/ik.md; docs/weights.md stays as it is: no characters in $characters"
fi
