#!/usr/bin/env bash
# Makes the documentation's pictures (docs/images), the comparison of inverse kinematics (docs/ik.md) and, where the
# shared characters and motions are, the tables of weights, template rigs and retargeting. Called by ./dev docs with the program built.
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
$limber pose $work/winged_rigged.glb --turn handle_03.L=z:30 --turn handle_03.R=z:-30 --turn handle_08.L=z:15 \
  --turn handle_08.R=z:-15 --turn handle_02=y:40 --turn handle_06=y:-40 --turn handle_04.L=x:-35 \
  -o $work/winged_posed.glb --quiet
picture winged_posed.glb model dragon_posed.png

for scene in samples/scenes/*.json; do
  name=$(basename $scene .json)
  $limber session replay $scene -o $work/$name.glb --quiet
  $limber preview $work/$name.glb --size 480x400 -o $images/scene_$name.png --quiet
done

$limber evaluate ik --problems 100 --plot $images -o docs/ik.md --quiet

for body in biped:humanoid quadruped:quadruped; do
  sample=${body%:*}
  $limber sample $sample -o $work/$sample.glb --quiet
  $limber rig $work/$sample.glb --template ${body#*:} -o $work/${sample}_template.glb --quiet
  picture ${sample}_template.glb bones ${sample}_template.png
done
# The same reach with and without balance: feet held, the hand next, the look and the neck last (docs/tasks.md).
tasks=(--root-motion move --task position:leftFoot=0.113,0.079,-0.024 --task orientation:leftFoot=y:0
  --task position:rightFoot=-0.113,0.079,-0.024 --task orientation:rightFoot=y:0
  --task position:leftHand=0.25,0.45,0.6@priority=1 --task look-at:head=0.25,0.3,0.7@priority=2
  --task coupling:neck=head:0.5@priority=3)
$limber pose $work/biped_template.glb "${tasks[@]}" -o $work/tasks_reach.glb --quiet
$limber pose $work/biped_template.glb "${tasks[@]}" --task balance=within -o $work/tasks_balance.glb --quiet
for name in reach balance; do
  $limber preview $work/tasks_$name.glb --view 70,8 --size 320x400 -o $images/tasks_$name.png --quiet
done
$limber preview $work/quadruped_template.glb --show anatomy --size 480x400 -o $images/anatomy_fox.png --quiet
# An elbow bent far, bound as roughly as can be, by each deformer.
$limber rig $work/biped.glb --template humanoid --skinning nearest-bone -o $work/biped_rough.glb --quiet
$limber pose $work/biped_rough.glb --turn leftLowerArm=y:-130 --turn leftUpperArm=z:30 -o $work/biped_bent.glb --quiet
for deformer in linear-blend dual-quaternion delta-mush direct-delta-mush; do
  $limber preview $work/biped_bent.glb --deformer $deformer --view 20,20 --size 400x400 -o $images/deform_$deformer.png --quiet
done

# What the pages of algorithms show besides.
tools/algorithm_pictures.sh $limber

# The page, where its parts are built (./dev studio) and there is a browser to draw it.
if [ -f dist/index.html ] && command -v chromium >/dev/null; then
  export LIMBER_PIXEL_DENSITY=1
  node apps/studio/tests/pictures.mjs dist $images
  # The states of augmented reality, as its tests meet them.
  node apps/studio/tests/ar_test.mjs dist $limber $work
  node apps/studio/tests/headset_test.mjs dist $limber $work
  for name in ar_trouble ways card_ar; do node apps/studio/tests/${name}_test.mjs dist $work; done
  cp $work/ar_{placing,placed,posing,two,no_surface,lost,ended}.png $work/headset_{posing,far_drag,two_hands}.png $images
  for name in ways_several:ways ways_camera_refused:refused ways_camera_placed:camera ways_camera_landscape:camera_landscape ways_print_card:card \
    card_large:card_large card_fitted:card_fitted card_posing:card_posing card_lost:card_lost; do
    cp $work/${name%:*}.png $images/ar_${name#*:}.png
  done
else
  echo "The pictures of the studio stay as they are: no dist/ (./dev studio makes it), or no chromium"
fi

# The study of all methods, which takes half an hour.
if [ -d "${LIMBER_SHARED_DATA:-../shared/data}" ]; then
  $limber study docs/data/study_all_methods.json -o $work/study --no-times --quiet
  cp $work/study/summary.md docs/study_results.md
fi

# Sheets of one repetition of the sample motions.
once() {
  $limber sample $1 -o $work/$1.bvh --quiet
  $limber convert $work/$1.bvh $work/$1_once.bvh --trim $2 --quiet
}
once jumping-jack 0:1.2
for method in limb-ik spacetime aligned copy; do
  $limber retarget $work/biped_template.glb $work/jumping-jack_once.bvh --method $method -o $work/jumping_jack.glb --quiet
  $limber preview $work/jumping_jack.glb --frames 8 --size 120x150 --view 25,10 -o $images/retarget_$method.png --quiet
done
once walk 0:1.1
$limber retarget $work/biped_template.glb $work/walk_once.bvh -o $work/walk.glb --quiet
$limber preview $work/walk.glb --frames 8 --size 160x200 --view 80,5 -o $images/retarget_walk.png --quiet
# Motions combined (docs/combining.md).
$limber sample walk -o $work/walk.bvh --quiet
$limber sample run -o $work/run.bvh --quiet
combined="$limber retarget $work/biped_template.glb $work/walk.bvh $work/run.bvh --quiet"
$combined --crossfade 0.4 -o $work/off.glb
$limber preview $work/off.glb --frames 16 --size 240x150 --view 80,5 -o $images/combine_crossfade.png --quiet
$combined --blend 0:1:5 -o $work/gaits.glb
$limber preview $work/gaits.glb --clip walk_run_0.50 --frames 16 --size 240x150 --view 80,5 -o $images/combine_blend.png --quiet

once quadruped-walk 0:0.9
$limber retarget $work/quadruped_template.glb $work/quadruped-walk_once.bvh -o $work/fox_walk.glb --quiet
$limber preview $work/fox_walk.glb --frames 8 --size 160x120 --view 80,5 -o $images/retarget_fox.png --quiet

# Characters that a motion was put on, as they stand at two moments of it.
table_of_poses() {
  local motion character moment files
  files=("${posed[@]/#/$work/posed_}")
  files=("${files[@]/%/.glb}")
  echo "| motion | at | named mean of ${#posed[@]} | best | worst | 0.4 sure and more |"
  echo "| --- | --- | ---: | ---: | ---: | ---: |"
  for motion in cmu_daz_12_01_walk cmu_daz_09_01_run cmu_daz_05_02_dance_pirouette rokoko_dance cmu1_jumping_jacks \
    makehuman_zombie_walk cmu_daz_02_05_punch fair1_wave_hello; do
    for character in "${posed[@]}"; do
      $limber retarget "$characters/$character.glb" "$motions/$motion.bvh" -o "$work/posed_$character.glb" --quiet
    done
    for moment in 0.5 1.5; do
      $limber evaluate templates "${files[@]}" --template humanoid --clip $motion --time $moment --quiet |
        awk -F'|' -v row="| $motion | $moment s |" '
          $3 ~ /humanoid/ { split($3, fit, " "); named = $(NF - 3) + 0; sum += named; sure += fit[2] >= 0.4
            if (!count++ || named < best) best = named
            if (named > worst) worst = named }
          END { printf "%s %.1f | %.1f | %.1f | %d |\n", row, sum / count, best, worst, sure }'
    done
  done
}

# Between the marks of that page the tables of how well bodies are read.
if [ -d "${LIMBER_SHARED_DATA:-../shared/data}" ]; then
  $limber evaluate anatomy docs/data/body_labels.json "${LIMBER_SHARED_DATA:-../shared/data}" -o $work/anatomy.md --quiet
  sed -i -e '/^<!-- table: made by/,/^<!-- end of table/{/^<!--/!d}' -e "/^<!-- table: made by/r $work/anatomy.md" docs/anatomy.md
fi

# And the conventions whose names are certain.
$limber info --conventions >$work/conventions.md
sed -i -e '/^<!-- conventions: made by/,/^<!-- end of conventions/{/^<!--/!d}' -e "/^<!-- conventions: made by/r $work/conventions.md" docs/anatomy.md

characters=${LIMBER_SHARED_DATA:-../shared/data}/rigged
if [ -d "$characters" ]; then
  creatures=$(dirname "$characters")/creatures
  $limber evaluate skinning "$characters" "$creatures"/tune "$creatures"/check \
    --references docs/data/blender_weights.tsv -o docs/weights.md --quiet
  table=$($limber evaluate skinning "$characters" "$creatures"/tune "$creatures"/check --skinning all --quiet)
  table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: weight methods -->\n).*(<!-- end of weight methods -->)/$1\n$ENV{table}\n$2/s' docs/methods.md
  table=$($limber evaluate templates "$characters"/*.{glb,gltf} --rigger all --quiet
    $limber evaluate templates --labels "$creatures/MANIFEST.tsv" --rigger all --quiet | tail -n +3)
  table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: riggers -->\n).*(<!-- end of riggers -->)/$1\n$ENV{table}\n$2/s' docs/methods.md
  meshes=$(dirname "$characters")/meshes
  foreign=(stool.glb chair_1.glb m2m_{dragon,bird,horse,spider,kaiju}_static.glb rawscan_hermes.ply
    {cat_low_resolution,hand_lowres,fish_low_resolution}.obj)
  table=$($limber evaluate handles "${foreign[@]/#/$meshes/}" --counts 8,12,20 --sheet $images/handles_foreign.png --quiet)
  table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: handles -->\n).*(<!-- end of handles -->)/$1\n![Handles of each model at 8, 12 and 20](images\/handles_foreign.png)\n\n$ENV{table}\n$2/s' docs/handles.md
  for model in chair_1 m2m_spider_static m2m_bird_static m2m_kaiju_static; do
    $limber rig "$meshes/$model.glb" -o $work/$model.glb --quiet
    picture $model.glb handles handles_$model.png
  done
  curved=(m2m_human_male fox_khronos m2m_bird_eagle quaternius_{spider,dolphin,trex,snake} robot_expressive)
  curved=("${curved[@]/#/$characters/}")
  $limber evaluate templates "${curved[@]/%/.glb}" --rigger curve-skeleton --sheet $images/curve_skeletons.png \
    -o $work/curved.md --quiet
  table=$($limber evaluate decomposition "$characters" "$creatures"/tune "$creatures"/check --quiet)
  table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: decomposition -->\n).*(<!-- end of decomposition -->)/$1\n$ENV{table}\n$2/s' docs/methods.md
  $limber evaluate transfer "$characters" "$creatures"/tune "$creatures"/check -o $work/transfer.md --quiet
  table="$(cat $work/transfer.md)" perl -0pi -e 's/(<!-- made by [^\n]*: transfer -->\n).*(<!-- end of transfer -->)/$1\n$ENV{table}\n$2/s' docs/methods.md
  $limber transfer "$characters"/quaternius_man_casual.glb "$characters"/m2m_human_zombie.glb --ignore-target-rig \
    -o $work/transfer.glb --quiet
  $limber pose $work/transfer.glb --turn UpperArm.L=z:40 --turn LowerArm.L=y:-50 --turn UpperLeg.R=x:-50 \
    --turn LowerLeg.R=x:70 --turn Head=y:25 -o $work/transfer_posed.glb --quiet
  $limber preview "$characters"/quaternius_man_casual.glb --show bones --rest --size 360x400 -o $images/transfer_source.png --quiet
  $limber preview "$characters"/m2m_human_zombie.glb --rest --size 360x400 -o $images/transfer_target.png --quiet
  $limber preview $work/transfer_posed.glb --size 360x400 -o $images/transfer_posed.png --quiet
  parts() { $limber preview "$(dirname "$characters")/$2" --show parts --rest --size 300x250 -o $images/parts_$1.png --quiet "${@:3}"; }
  parts man rigged/cesium_man.glb
  parts horse rigged/quaternius_horse.glb
  parts spider rigged/quaternius_spider.glb
  parts statue meshes/statue_hermes.obj
  parts hand meshes/hand_lowres.obj --count 6
  parts scorpion meshes/scorpion_low_resolution.obj
  people=(cesium_man.glb kaykit_mannequin/manny_med_mod.gltf kenney_human.glb m2m_human_{female,male,zombie}.glb
    makehuman_{cmu_mb,default,game_engine,mixamo}.glb quaternius_cyberpunk_character.glb quaternius_knightcharacter.glb
    quaternius_{man_casual,man_king,man_spacesuit,platformer_character,platformer_character_humanoidrig,woman_casual,woman_scifi,mech_george}.glb
    robot_expressive.glb)
  posed=(quaternius_{man_king,man_spacesuit,woman_casual} m2m_human_{female,zombie} makehuman_{game_engine,cmu_mb})
  animals=(fox_khronos.glb m2m_fox_{cat,dog,fox}.glb quaternius_{alpaca,cow,horse,wolf,triceratops}.glb)
  motions=$(dirname "$characters")/motions
  table=$($limber evaluate retargeting --motion "$motions"/{boxing_toes,cmu_daz_12_01_walk,cmu_mb_12_01_walk,cmu_daz_09_01_run}.bvh \
    "$motions"/{fair1_dab,pybvh_example,rokoko_dance}.bvh --most-frames 400 --quiet \
    --character "$characters"/{cesium_man,m2m_human_male,makehuman_mixamo,quaternius_man_casual}.glb)
  table="$table" perl -0pi -e 's/(<!-- made by [^\n]*: measures -->\n).*(<!-- end of measures -->)/$1\n$ENV{table}\n\n$2/s' docs/retargeting.md
  tools/judge_retargeting.sh
  kinds=$($limber evaluate templates --labels "$(dirname "$characters")/creatures/MANIFEST.tsv" --quiet)
  table="$kinds" perl -0pi -e 's/(<!-- made by [^\n]*: kinds -->\n).*(<!-- end of kinds -->)/$1\n$ENV{table}\n$2/s' docs/template-rigs.md
  $limber evaluate templates --labels "$(dirname "$characters")/creatures/MANIFEST.tsv" --split check --sheet $images/check_rigs.png \
    --each $work/check_rigs.tsv -o $work/check_rigs.md --quiet
  named=$(awk -F'\t' 'NR > 1 { printf("%s%s (%s)", between, $3, $6 ? "handles" : $4); between = ", " }' \
    $work/check_rigs.tsv | fold -s -w 118 | sed 's/ $//')
  table="$named" perl -0pi -e 's/(<!-- made by [^\n]*: check -->\n).*(<!-- end of check -->)/$1\n![Characters with their bones](images\/check_rigs.png)\n\n$ENV{table}.\n\n$2/s' docs/template-rigs.md
  sed -i '/^\*\*People, /,$d' docs/template-rigs.md
  {
    echo "**People, --template humanoid**" && echo
    $limber evaluate templates "${people[@]/#/$characters/}" --template humanoid --quiet
    echo && echo "**Animals, --template quadruped**" && echo
    $limber evaluate templates "${animals[@]/#/$characters/}" --template quadruped --quiet
    echo && echo "**People in poses, --template humanoid**" && echo
    table_of_poses
  } >> docs/template-rigs.md
  echo "Made docs/images, docs/ik.md, docs/weights.md and the tables of docs/methods.md, docs/template-rigs.md, docs/retargeting.md"
else
  echo "Made docs/images and docs/ik.md; docs/weights.md stays as it is: no characters in $characters"
fi
