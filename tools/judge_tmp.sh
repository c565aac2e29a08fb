#!/usr/bin/env bash
# The judge's table of docs/retargeting.md, over the shared people and the motions of people (about two minutes on an idle machine):
#   tools/judge_retargeting.sh [OPTION...]      options of limber evaluate retargeting, such as --each FILE
# Without options the table of the page is made anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
shared=${LIMBER_SHARED_DATA:-../shared/data}

motions=("$shared"/motions/{boxing_toes,cmu1_*,cmu_daz_*,cmu_mb_*,fair1_*,makehuman_*walk,pybvh_example,pybvh_test2,rokoko_*}.bvh
  "$shared"/motions/{cmu_91_48,pab_run,pab_walk}.fbx "$shared"/motions/pab_walk.dae
  "$shared"/motions/{m2m_human_sample_anim,kaykit_general,kaykit_movementbasic}.glb)
people=("$shared"/rigged/{cesium_man,kenney_human,m2m_human_*,makehuman_*,robot_expressive}.glb
  "$shared"/rigged/quaternius_{cyberpunk_character,cyberpunk_enemy_2legs,knightcharacter,man_*,mech_*,platformer_*,woman_*}.glb
  "$shared"/rigged/kaykit_mannequin/manny_med_mod.gltf "$shared"/rigged/m2m_rigonly/rig_human.glb
  "$shared"/rigged/{pab_skeleton,quaternius_robot}.fbx)
judge=(build/release/limber evaluate retargeting --judge --motion "${motions[@]}" --character "${people[@]}"
  --method spacetime --most-frames 400 --inside-frames 2 --quiet)

if [ $# -gt 0 ]; then exec "${judge[@]}" "$@"; fi
table=$("${judge[@]}")
table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: judge -->\n).*(<!-- end of judge -->)/$1\n$ENV{table}\n\n$2/s' docs/retargeting.md
