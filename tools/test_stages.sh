# The stages of ./dev test, in the order in which a mistake shows soonest. Sourced by ./dev, which has configure and
# compile. A stage that fails ends the run; the last line printed sums up all stages.

total_passed=0 total_failed=0 total_skipped=0
output=build/test

add_counts() {
  total_passed=$((total_passed + $1))
  total_failed=$((total_failed + $2))
  total_skipped=$((total_skipped + $3))
}

summary() { echo "$total_passed passed, $total_failed failed, $total_skipped skipped"; }

# stage <title> <function> [argument...]: runs it, prints how long it took; where it fails, sums up and exits. Where the
# stages are listed it prints the title alone, as stages_at_once does.
stage() {
  local title=$1 started=$SECONDS
  shift
  if [ -n "$listing" ]; then echo "$title"; return; fi
  echo "== $title"
  if ! "$@"; then
    [ $total_failed -gt 0 ] || total_failed=1
    echo "== $title FAILED after $((SECONDS - started)) s"
    summary
    exit 1
  fi
  echo "   $((SECONDS - started)) s"
}

# minutes_left_for <minutes> <what>: whether stages that take so long on two processors with nothing compiled before may
# still begin within LIMBER_TEST_MINUTES, where that is set; else they are skipped, and the run says so.
minutes_left_for() {
  [ -n "${LIMBER_TEST_MINUTES:-}" ] && [ -z "$listing" ] || return 0
  [ $((SECONDS / 60 + $1)) -gt "$LIMBER_TEST_MINUTES" ] || return 0
  echo "== $2: skipped, $((SECONDS / 60)) of $LIMBER_TEST_MINUTES minutes are used and they take up to $1"
  add_counts 0 0 1
  return 1
}

# stages_at_once: of its input, a line each: a function without arguments, then the title of its stage. For stages that
# keep one processor busy and write into folders of their own: as many at a time as there are processors, told in their
# order. Where one fails all others come to their end before it sums up and exits.
stages_at_once() {
  local logs=$PWD/$output/stages failed= name title counts
  if [ -n "$listing" ]; then cut -d ' ' -f 2-; return; fi
  local -A titles=() names=()
  rm -rf "$logs"
  mkdir -p "$logs"
  while read -r name title; do
    names[${#names[@]}]=$name titles[$name]=$title
    [ "$(jobs -r | wc -l)" -lt "$jobs" ] || wait -n || true
    stage_apart "$name" "$logs" &
  done
  wait
  local i
  for ((i = 0; i < ${#names[@]}; ++i)); do
    name=${names[$i]}
    echo "== ${titles[$name]}"
    cat "$logs/$name.log"
    read -r -a counts <"$logs/$name.counts"
    add_counts "${counts[@]:0:3}"
    if [ "${counts[3]}" = 0 ]; then
      echo "   ${counts[4]} s"
    else
      failed=yes
      echo "== ${titles[$name]} FAILED after ${counts[4]} s"
    fi
  done
  [ -n "$failed" ] || return 0
  [ $total_failed -gt 0 ] || total_failed=1
  summary
  exit 1
}

# stage_apart <function> <folder>: what it prints, and its counts, status and seconds, in files named after it.
stage_apart() {
  local status=0 started=$SECONDS
  total_passed=0 total_failed=0 total_skipped=0
  "$1" >"$2/$1.log" 2>&1 </dev/null || status=$?
  echo "$total_passed $total_failed $total_skipped $status $((SECONDS - started))" >"$2/$1.counts"
}

# One check of our own, counted as one test.
check() {
  local what=$1
  shift
  if "$@"; then
    add_counts 1 0 0
  else
    echo "FAILED: $what"
    add_counts 0 1 0
    return 1
  fi
}

# add_counts_of <log>: those of its last line, "N passed, N failed"; fails where it has none.
add_counts_of() {
  [[ $(tail -n 1 "$1") =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]] || return 1
  add_counts "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" 0
}

# Adds the counts of a script, and shows what else it said if it failed.
counted() {
  counted_by logged "$@"
}

# The same for one that drives a whole browser or window, which meets what is not ours: a click that was lost, a machine that
# stood still for seconds. It may fail once, and the run says so.
counted_or_again() {
  counted_by logged_or_again "$@"
}

# counted_by <logged|logged_or_again> <command>...
counted_by() {
  local log=$output/counted_$BASHPID.log status=0
  rm -f "$log.unsteady"
  "$1" "$log" "${@:2}" || status=$?
  if add_counts_of "$log"; then
    echo "   $(tail -n 1 "$log")"
  elif [ $status -eq 0 ]; then
    status=1
  fi
  say_unsteady "$log"
  [ $status -eq 0 ] || head -n 60 "$log"
  return $status
}

# logged <log> <command>...
logged() {
  "${@:2}" >"$1" 2>&1 </dev/null
}

# What it said when it failed is kept as <log>.unsteady.
logged_or_again() {
  logged "$@" && return 0
  mv "$1" "$1.unsteady"
  logged "$@"
}

# say_unsteady <log>: what failed at first.
say_unsteady() {
  [ ! -f "$1.unsteady" ] || { grep -m 3 '^FAILED' "$1.unsteady" || tail -n 3 "$1.unsteady"; } | sed 's/^/   UNSTEADY, failed at first: /'
}

# counted_at_once: as counted_or_again, the commands of its input, a line each, as many at a time as there are processors; the
# first that fails again lets no other begin. One that takes ten minutes hangs, and fails. Says which took longest.
counted_at_once() {
  local logs=$PWD/$output/at_once status=0 log name commands
  rm -rf "$logs" "${logs}_seconds"
  mkdir -p "$logs" "${logs}_seconds"
  commands=$(cat)
  export -f logged logged_or_again
  # xargs begins no other command once one ends with 255.
  nl -w 2 -n rz -s ' ' <<<"$commands" | xargs -P "$jobs" -L 1 bash -c '
    log=$1/$2; shift 2; logged_or_again "$log" timeout 600 "$@" || exit 255
    echo "$SECONDS s ${*:1:2}" >"${log/at_once/at_once_seconds}"' - "$logs" 2>/dev/null || status=1
  echo "   $(cat "${logs}_seconds"/* 2>/dev/null | sort -rn | head -n 4 | sed 's|[^ ]*/||' | paste -sd , | sed 's/,/, /g')"
  for log in "$logs"/??; do
    name=${log##*/} name=$(sed -n "${name#0}p" <<<"$commands" | cut -d ' ' -f 1-2)
    say_unsteady "$log" | sed "s|^|   $name:|"
    if add_counts_of "$log" && [[ $(tail -n 1 "$log") == *' 0 failed' ]]; then continue; fi
    status=1
    echo "$name FAILED"
    head -n 60 "$log"
  done
  return $status
}

# run_programs <preset> <regex of tests left out> <program>[:<parts>]...: each test program once, or at once in so many
# parts, for what its tests share is made once then; a process for each test takes two to three times as long.
run_programs() {
  local preset=$1 left_out=$2 status=0 log
  shift 2
  local logs=$PWD/$output/programs skipped_before=$total_skipped
  rm -rf "$logs"
  mkdir -p "$logs" "$output/files_$preset"
  export LIMBER_TEST_OUTPUT=$PWD/$output/files_$preset
  export -f run_program
  for program in "$@"; do
    local parts=${program#*:} part
    [ "$parts" != "$program" ] || parts=1
    for ((part = 0; part < parts; ++part)); do echo "build/$preset/${program%:*} $part $parts"; done
  done | xargs -P "$jobs" -L 1 bash -c 'run_program "$@"' - "$logs" "$left_out" || status=1
  for log in "$logs"/*.log; do
    local ran skipped failed
    ran=$(sed -nE 's/^\[=+\] ([0-9]+) tests? from .* ran\..*/\1/p' "$log")
    skipped=$(sed -nE 's/^\[  SKIPPED \] ([0-9]+) tests?, listed.*/\1/p' "$log")
    failed=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, listed.*/\1/p' "$log")
    [ -n "$ran" ] || ran=1 failed=1 # it crashed
    add_counts $((ran - ${skipped:-0} - ${failed:-0})) "${failed:-0}" "${skipped:-0}"
    [ "${failed:-0}" = 0 ] || grep -vE '^\[ RUN|^\[       OK' "$log" | tail -n 60
  done
  if [ $total_skipped -gt "$skipped_before" ]; then
    grep -hoE 'the shared models are not there.*' "$logs"/*.log | sort | uniq -c | sed 's/^ */   skipped: /' || true
  fi
  return $status
}

# run_program <folder of logs> <regex of tests left out> <program> <part> <parts>
run_program() {
  local tests
  tests=$("$3" --gtest_list_tests | awk '/^[^ ]/ { suite = $1 } /^  / { sub(/^ */, suite); print }' | grep -vP "$2" |
    sed 's/ *#.*//' | paste -sd: -)
  GTEST_SHARD_INDEX=$4 GTEST_TOTAL_SHARDS=$5 timeout 1500 "$3" --gtest_filter="$tests" </dev/null >"$1/$(basename "$3")_$4.log" 2>&1
}

# unit_tests <preset> [regex of tests left out]: the largest programs first, for they most likely take longest.
unit_tests() {
  run_programs "$1" "${2:-^$}" $(cd "build/$1" && ls -S limber_*_tests | grep -v model_tests)
}

# model_tests <preset> [regex of tests left out]
model_tests() {
  run_programs "$1" "${2:-^$}" "limber_model_tests:$jobs"
}

shared_data() {
  local folder=${LIMBER_SHARED_DATA:-../shared/data}
  [ -d "$folder" ] && (cd "$folder" && pwd)
}

broken_files() {
  local folder
  folder=$(shared_data)/broken || folder=
  [ -n "$folder" ] || { echo "   the shared faulty files are not there: damaged samples only"; add_counts 0 0 1; }
  counted tests/broken_files.sh build/release/limber "$output/broken" $folder
}

validate_written_files() {
  install_node_packages . && counted node tools/validate.mjs "$output"
}

# Motions whose roots rest at the origin: there all programs agree on what a BVH means.
common_motions() {
  local folder name
  folder=$(shared_data)/motions && [ -d "$folder" ] || return 1
  for name in cmu_mb_12_01_walk cmu_daz_02_01_walk cmu1_jumping_jacks fair1_wave_hello pybvh_example pybvh_test2 boxing_toes; do
    echo "$folder/$name.bvh"
  done
}

# Characters of several makers, with a motion that limber put on them: their paths, one a line.
characters_in_motion() {
  local folder name characters=()
  folder=$(shared_data) || return 1
  mkdir -p "$output/retargeted"
  for name in cesium_man.glb makehuman_mixamo.glb m2m_human_male.glb quaternius_man_casual.glb robot_expressive.glb \
    kaykit_mannequin/manny_med_mod.gltf; do
    characters+=("$output/retargeted/$(basename "${name%.*}").glb")
    build/release/limber retarget "$folder/rigged/$name" "$folder/motions/fair1_wave_hello.bvh" --quiet -o "${characters[-1]}" || return 1
    echo "$folder/rigged/$name" >"${characters[-1]}.source" # what the validator finds there already is not ours
  done
  printf '%s\n' "${characters[@]}"
}

motions_in_three() {
  local motions characters
  motions=$(common_motions) || { echo "   skipped: the shared motions are not there"; add_counts 0 0 1; return 0; }
  characters=$(characters_in_motion) || return 1
  install_node_packages . &&
    counted node tests/three_positions.mjs build/release/limber "$output/three" $motions $characters
}

crowds_in_three() {
  install_node_packages . && counted node tests/crowd_test.mjs build/release/limber "$output/crowd"
}

# The project's own models, one unrigged, one of pieces, one that flies with a rig of its own; shared ones where they are:
# their paths, one a line.
models_in_motion() {
  local folder=$1 model
  mkdir -p "$folder"
  for model in biped robot flying; do
    build/release/limber sample "$model" --quiet -o "$folder/$model.glb" || return 1
    echo "$folder/$model.glb"
  done
  build/release/limber sample walk --quiet -o "$folder/walk.bvh" &&
    build/release/limber animate "$folder/biped.glb" "$folder/walk.bvh" --quiet -o "$folder/walking.glb" || return 1
  echo "$folder/walking.glb"
  for model in ../shared/data/rigged/{cesium_man,fox_khronos,robot_expressive,quaternius_man_casual}.glb; do
    [ ! -f "$model" ] || echo "$model"
  done
}

surfaces_in_three() {
  local folder=$output/surfaces models
  models=$(models_in_motion "$folder") || return 1
  install_node_packages . && counted node tests/three_surfaces.mjs build/release/limber "$folder" $models
}

# Leaves the files, and where three.js shows them, for Blender. A skeleton alone is one of them.
fbx_in_three() {
  local folder=$output/fbx models
  models=$(models_in_motion "$folder") || return 1
  build/release/limber convert "$folder/walk.bvh" "$folder/skeleton.glb" --quiet || return 1
  install_node_packages . &&
    LIMBER_CORNERS=1 counted node tests/three_fbx.mjs build/release/limber "$folder" $models "$folder/skeleton.glb"
}

# What fbx_in_three left; a skeleton alone has no surface.
fbx_in_blender() {
  need blender python3-numpy || return 1
  rm -f "$output/fbx/skeleton.fbx"
  counted blender_script tests/blender_fbx.py "$output"/fbx/*.fbx
}

# Shared models, where they are, as limber reads them and as three.js does.
fbx_read() {
  local files
  mapfile -t files < <(find ../shared/data/{creatures,rigged,meshes} -iname '*.fbx' 2>/dev/null | sort)
  [ ${#files[@]} -gt 0 ] || { echo "   skipped: the shared models are not there"; add_counts 0 0 1; return 0; }
  install_node_packages . && counted node tests/fbx_read.mjs build/release/limber "$output/fbx_read" "${files[@]}"
}

# The project's own person with a clip, and shared ones where they are: as VRM 1.0 with motions, and by way of VRM 0.x.
avatars_in_three() {
  local folder=$output/avatars models=() model walking
  mkdir -p "$folder"
  walking=$folder/walking.glb
  build/release/limber sample biped --quiet -o "$folder/biped.glb" &&
    build/release/limber sample walk --quiet -o "$folder/walk.bvh" &&
    build/release/limber animate "$folder/biped.glb" "$folder/walk.bvh" --quiet -o "$walking" || return 1
  for model in $(sed -n 's/.*"\([^"]*\.glb\)".*/\1/p' tests/shared_people.h); do
    [ ! -f "../shared/data/rigged/$model" ] || models+=("../shared/data/rigged/$model")
  done
  install_node_packages . && counted node tests/three_vrm.mjs build/release/limber "$folder" "$walking" "${models[@]}" &&
    counted node tests/three_vrm0.mjs build/release/limber "$folder" "$walking" "${models[@]:0:4}"
}

motions_in_blender() {
  local motions motion characters glbs=()
  motions=$(common_motions) || { echo "   skipped: the shared motions are not there"; add_counts 0 0 1; return 0; }
  need blender python3-numpy || return 1
  mkdir -p "$output/blender"
  for motion in $motions; do
    glbs+=("$output/blender/$(basename "$motion" .bvh).glb")
    build/release/limber convert "$motion" "${glbs[-1]}" --quiet || return 1
  done
  characters=$(characters_in_motion) || return 1
  counted blender_script tests/blender_positions.py "${glbs[@]}" $characters
}

# Blender says goodbye after the script's last line.
blender_script() {
  local script=$1
  shift
  blender --background --factory-startup --python "$script" -- "$@" </dev/null | grep -v '^\(Blender\|Data are loaded\|glTF import\|FBX version\|$\)'
  return "${PIPESTATUS[0]}"
}

# cmake --install to a folder of its own, then programs that know nothing but find_package(limber).
install_and_use() {
  local prefix=$PWD/$output/prefix log=$output/examples.log
  rm -rf "$prefix" "$output/examples"
  {
    cmake --install build/release --prefix "$prefix" &&
      cmake -S examples -B "$output/examples" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release &&
      cmake --build "$output/examples"
  } >"$log" 2>&1 || { tail -n 40 "$log"; return 1; }
  check "the installed program runs" "$prefix/bin/limber" --version >/dev/null || return 1
  counted examples/run.sh "$output/examples" build/release/limber "$output/example_files"
}

# For all stages everything; else the program and the tests that are run.
build_release() {
  local more=OFF targets=(limber limber_unit_tests)
  [ -z "$quick" ] || targets+=(limber_model_tests)
  [ -z "$all" ] || more=ON targets=()
  configure release -DLIMBER_TESTS=ON -DLIMBER_BENCH=$more -DLIMBER_STUDIO=OFF -DLIMBER_PYTHON=$more && compile release "${targets[@]}"
}

wasm_smoke() {
  build/release/limber sample biped --quiet -o "$output/biped.glb" &&
    counted node tests/wasm_smoke.mjs build/wasm build/release/limber "$output/biped.glb" "$output/wasm"
}

result_hashes() {
  local status=0
  counted node tests/result_hashes.mjs build/release/limber "$output/results" build/wasm || status=1
  [ $status -ne 0 ] || grep '^   ' "$output/counted_$BASHPID.log"
  return $status
}

# Whether there is a browser for the page; else the stage is skipped.
has_chromium() {
  need "${packages_browser[@]}" >/dev/null 2>&1 || true
  command -v chromium >/dev/null && return 0
  echo "   no chromium here: the page is built, and not tried"
  add_counts 0 0 1
  return 1
}

studio_in_browser() {
  has_chromium || return 0
  # By the clock, so with nothing beside it.
  counted_or_again node apps/studio/tests/kill_test.mjs dist $output/studio || return 1
  counted_at_once < <(browser_tests)
}

# A model opened, rigged, dragged, put in motion, exported; on a phone, in augmented reality. CONTRIBUTING.md names them.
studio_main_tests() {
  has_chromium || return 0
  counted_at_once < <(browser_tests | grep -E '/(studio|rigs|pose|sequence|save|ar)_test\.mjs ')
}

# Their commands, one a line.
browser_tests() {
  local faulty
  faulty=$(shared_data)/broken || faulty=
  cat <<TESTS
node apps/studio/tests/studio_test.mjs dist build/release/limber $output/studio $faulty
node apps/studio/tests/beside_test.mjs dist $output/studio
node apps/studio/tests/keep_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/dope_test.mjs dist $output/studio
node apps/studio/tests/feet_test.mjs dist $output/studio
node apps/studio/tests/sequence_test.mjs dist $output/studio
node apps/studio/tests/crowd_view_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/pose_test.mjs dist $output/studio
node apps/studio/tests/tools_test.mjs dist $output/studio
node apps/studio/tests/paint_test.mjs dist $output/studio
node apps/studio/tests/deform_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/shelf_test.mjs dist $output/studio
node apps/studio/tests/rigs_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/words_test.mjs dist $output/studio
node apps/studio/tests/scene_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/first_minute_test.mjs dist $output/studio
node apps/studio/tests/second_minute_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/narrow_test.mjs dist $output/studio
node apps/studio/tests/poses_test.mjs dist $output/studio
node apps/studio/tests/ar_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/ar_trouble_test.mjs dist $output/studio
node apps/studio/tests/ways_test.mjs dist $output/studio
node apps/studio/tests/save_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/headset_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/install_test.mjs dist build/release/limber $output/studio
node apps/studio/tests/card_test.mjs
node apps/studio/tests/report_rows_test.mjs
node apps/studio/tests/ballot_test.mjs build/release/limber $output/studio
node apps/studio/tests/card_ar_test.mjs dist $output/studio
TESTS
}

studio_in_program() {
  need "${packages_studio[@]}" && build_program_with_studio &&
    counted_or_again node apps/studio/tests/program_test.mjs build/release/limber dist || return 1
  command -v chromium >/dev/null || { echo "   no chromium here: limber studio --host and --live are not tried"; add_counts 0 0 1; return 0; }
  counted_or_again node apps/studio/tests/host_test.mjs build/release/limber dist "$output/studio" &&
    counted_or_again node apps/studio/tests/live_test.mjs build/release/limber "$output/studio"
}

# The module as it is built, against the program; and the tour of it.
python_module() {
  cp bindings/python/limber/*.py* bindings/python/limber/py.typed build/release/python/limber &&
    PYTHONPATH=build/release/python LIMBER_PROGRAM=build/release/limber counted bindings/python/tests/run.sh "$output/python"
}

# Training takes hours: its steps are tried on a few bodies.
training() {
  need "${packages_learn[@]}" && counted /usr/bin/python3 tools/learn/run_tests.py
}

# What is made for others to install.
make_packages() {
  need "${packages_installers[@]}" && tools/make_packages.sh build/release build/packages &&
    counted tests/package_notices.sh build/packages build/release "$output/notices"
}

# The packages on a system that has nothing: skipped where none can be made.
packages_on_bare_debian() {
  need "${packages_bare[@]}" >/dev/null 2>&1 || true
  if ! command -v mmdebstrap >/dev/null || [ "$(id -u)" != 0 ]; then
    echo "   no mmdebstrap here, or not root: the packages are made, and not tried"
    add_counts 0 0 1
    return 0
  fi
  local status=0
  counted tests/bare_debian.sh build/packages "$output/bare" || status=$?
  [ $status = 77 ] || return $status
  echo "   no bare system can be made here: the packages are made, and not tried"
  add_counts 0 0 1
}

npm_package() {
  need "${packages_browser[@]}" >/dev/null 2>&1 || true
  command -v chromium >/dev/null || { echo "   no chromium here: the npm package is not tried"; add_counts 0 0 1; return 0; }
  counted_or_again node bindings/npm/tests/package_test.mjs build/packages/limber-*.tgz build/release/limber "$output/npm"
}

# The add-on in Blender, without a window and in one: skipped where there is no Blender to be had.
blender_addon() {
  need "${packages_blender[@]}" >/dev/null 2>&1 || true
  if ! command -v blender >/dev/null || ! command -v xvfb-run >/dev/null; then
    echo "   no Blender here: the add-on is not tried"
    add_counts 0 0 1
    return 0
  fi
  counted_or_again apps/blender/tests/run.sh build/packages/limber-blender-*.zip build/release/limber "$output/blender_addon" build/packages/limber-[0-9]*.tgz
}

# Every command of the manual and of --help as it is written; says which are left out, and why.
manual_commands() {
  counted node tests/manual_commands.mjs build/release/limber "$output/manual" &&
    sed 's/^/   not run: /' "$output/manual/not_run.txt"
}

# 300 models; damaged ones among them where the shared ones are there.
batch_of_many() {
  local folder
  folder=$(shared_data)/broken || folder=
  counted node tests/batch_test.mjs build/release/limber "$output/batch" $folder && grep '^|' "$output/counted_$BASHPID.log"
}

batch_by_engines() {
  need "${packages_cluster[@]}" >/dev/null 2>&1 || true
  if ! command -v slurmctld >/dev/null && ! command -v parallel >/dev/null; then
    echo "   neither Slurm nor GNU parallel here: batches by engines are not tried"
    add_counts 0 0 1
    return 0
  fi
  counted tests/batch_engines.sh build/release/limber "$output/engines"
}

kubernetes_job() {
  install_node_packages . && install_node_packages apps/studio &&
    counted node tests/kubernetes_job.mjs apps/studio/node_modules/.bin/tsc "$output/kubernetes"
}

documentation_site() {
  need "${packages_site[@]}" && check "a page of the site is wrong" site/make.sh >/dev/null
}

build_sanitize() {
  configure sanitize && compile sanitize
}

sanitizer_options() {
  export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
  export UBSAN_OPTIONS=print_stacktrace=1
}

# fuzz_each_target <seconds>: one check for each target.
fuzz_each_target() {
  local seconds=$1 target name
  for target in build/sanitize/fuzz_*; do
    [ -x "$target" ] && [ ! -d "$target" ] || continue
    name=$(basename "$target")
    mkdir -p "build/fuzz/$name" "build/fuzz/$name.seeds"
    if [ -d "tests/fuzz/seeds/$name" ]; then
      cp "tests/fuzz/seeds/$name"/* "build/fuzz/$name.seeds"
    else
      fuzz_seeds "build/fuzz/$name.seeds"
    fi
    check "$name (see build/fuzz/$name.log; the input is beside it)" fuzz_one "$target" "$seconds" || return 1
  done
}

fuzz_one() {
  local name
  name=$(basename "$1")
  "$1" "build/fuzz/$name" "build/fuzz/$name.seeds" -max_total_time="$2" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
    -artifact_prefix="build/fuzz/$name-" -print_final_stats=1 </dev/null >"build/fuzz/$name.log" 2>&1 ||
    { tail -n 40 "build/fuzz/$name.log"; return 1; }
  echo "   $name: $(grep -oE 'number_of_executed_units: [0-9]+' "build/fuzz/$name.log" | grep -oE '[0-9]+') inputs"
}

# Small files of every kind to start the mutations from: the samples, bare and rigged.
fuzz_seeds() {
  local name
  [ -x build/sanitize/limber ] || return 0
  for name in stool biped; do
    build/sanitize/limber sample $name --quiet -o "$1/$name.glb"
    build/sanitize/limber rig "$1/$name.glb" --handles 3 --quiet -o "$1/$name.gltf"
  done
}

. tools/studio.sh

run_tests() {
  local quick= all= sanitize= blender= listing=
  for option in "$@"; do
    case $option in
      --quick) quick=yes ;;
      --all) all=yes ;;
      --sanitize) sanitize=yes ;;
      --blender) blender=yes ;;
      --list) listing=yes ;;
      *) echo "test knows --quick, --all, --sanitize, --blender and --list, not $option" >&2; exit 2 ;;
    esac
  done
  if [ -n "$listing" ]; then all_stages; return; fi
  rm -rf $output
  mkdir -p $output
  all_stages
  if [ -z "$sanitize$all" ]; then
    echo "== Not run, ./dev test --all has it:"
    listing=yes all_stages >$output/stages_run
    all=yes quick= listing=yes all_stages | grep -vxFf $output/stages_run | sed 's/^/   /'
  fi
  summary
}

all_stages() {
  if [ -n "$sanitize" ]; then sanitize_stages; else release_stages; fi
  if [ -n "$blender" ]; then stage "motions in Blender" motions_in_blender; fi
  if [ -n "$sanitize$quick" ]; then return; fi
  if [ -n "$all" ]; then remaining_stages; else change_stages; fi
}

release_stages() {
  local packages=("${packages_tests[@]}")
  [ -n "$quick" ] || packages+=("${packages_wasm[@]}" "${packages_node[@]}")
  [ -z "$all" ] || packages+=("${packages_bench[@]}" "${packages_sanitize[@]}" "${packages_python[@]}" "${packages_learn[@]}")
  stage "packages" need $(printf '%s\n' "${packages[@]}" | LC_ALL=C sort -u)
  stage "release build, g++ with warnings as errors" build_release
  stage "types of one name" check "two types of one name (tests/type_names.sh)" tests/type_names.sh
  stage "unit tests" unit_tests release
  if [ -n "$quick" ]; then stage "the project's own samples" model_tests release '^(?!.*Samples)'; fi
}

# What every change needs beside that.
change_stages() {
  stage "WebAssembly build" build_wasm
  stages_at_once <<'STAGES'
wasm_smoke WebAssembly in Node against the native program
result_hashes main results by their hashes, natively and as WebAssembly
STAGES
  stage "studio: types, bundle" build_studio
  stage "studio in a browser: main tests" studio_main_tests
  stage "glTF validator over every file written" validate_written_files
}

# slow_tests <folder of logs>: a regex of the tests that took long there, but for the quickest of each suite where that
# took no more than ten times as long. Sanitizers make ten times of all of it: ./dev test --sanitize runs them all.
slow_tests() {
  local long_milliseconds=400
  sed -nE 's/^\[       OK \] ([^ ]+) \(([0-9]+) ms\)/\2 \1/p' "$1"/*.log | sort -n |
    awk -v long=$long_milliseconds '{ split($2, name, "."); if ($1 > long && (seen[name[1]] || $1 > 10 * long)) print $2; seen[name[1]] = 1 }' |
    sed 's/\./\\./g' | paste -sd '|' | sed 's/^/^(/; s/$/)$/'
}

remaining_stages() {
  local slow=
  [ -n "$listing" ] || slow=$(slow_tests $output/programs)
  stage "every model, every count of handles" model_tests release
  stage "faulty files, through the program" broken_files
  stage "commands of the manual and of --help, as they are written" manual_commands
  stage "batches, killed and gone on with" batch_of_many
  stage "batches by Slurm and GNU parallel" batch_by_engines
  stage "Kubernetes file against its schema" kubernetes_job
  stage "WebAssembly build" build_wasm
  stages_at_once <<'STAGES'
wasm_smoke WebAssembly in Node against the native program
result_hashes main results by their hashes, natively and as WebAssembly
python_module module for Python
training training of the networks that read shapes
surfaces_in_three USD in three.js
avatars_in_three VRM in three-vrm
fbx_in_three FBX in three.js
fbx_read FBX read as three.js reads it
motions_in_three motions in three.js
crowds_in_three crowds in three.js
STAGES
  if [ -n "$blender" ]; then stage "FBX in Blender" fbx_in_blender; fi
  stage "studio: types, bundle" build_studio
  stage "studio in a browser: mouse, touch, keyboard, bad files" studio_in_browser
  stage "studio in the program" studio_in_program
  stage "glTF validator over every file written" validate_written_files
  stage "installed package, and the examples built against it" install_and_use
  stage "packages for others to install" make_packages
  stages_at_once <<'STAGES'
packages_on_bare_debian packages, installed on a Debian with nothing on it
npm_package npm package
documentation_site documentation as a site
STAGES
  if minutes_left_for 5 "the add-on in Blender"; then stage "add-on in Blender" blender_addon; fi
  if minutes_left_for 40 "the tests under sanitizers and the fuzz targets"; then sanitized_stages "$slow"; fi
}

# What is tried under sanitizers beside all else; ./dev test --sanitize has all of it.
sanitized_stages() {
  stage "sanitizer build, clang++ with warnings as errors" build_sanitize
  sanitizer_options
  stage "unit tests under sanitizers" unit_tests sanitize "$1"
  # All other models, and templates, take minutes there.
  LIMBER_MATRIX_HANDLES=10 LIMBER_MATRIX_FRAMES=60 stage "the project's own samples at 10 handles under sanitizers" \
    model_tests sanitize '^(?!.*Samples)|Template|MatchedByTheirForm'
  # Within a bound no more than a look; else for minutes.
  local seconds=${LIMBER_TEST_MINUTES:+5}
  stage "fuzz targets, ${seconds:-120} s each" fuzz_each_target "${seconds:-120}"
}

sanitize_stages() {
  stage "packages" need "${packages_sanitize[@]}"
  stage "sanitizer build, clang++ with warnings as errors" build_sanitize
  sanitizer_options
  stage "unit tests under sanitizers" unit_tests sanitize
  stage "every model, every count of handles, under sanitizers" model_tests sanitize
}
