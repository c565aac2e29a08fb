# What each command of ./dev needs from the system, and how it gets there. Sourced by ./dev.

packages_release=(cmake ninja-build g++ libeigen3-dev libfast-float-dev libcli11-dev libfmt-dev nlohmann-json3-dev libassimp-dev
  libmeshoptimizer-dev libdraco-dev libpng-dev libjpeg-dev libtbb-dev libssl-dev pkg-config)
packages_tests=("${packages_release[@]}" libgtest-dev libgmock-dev libembree-dev zlib1g-dev)
packages_bench=("${packages_tests[@]}" libbenchmark-dev nodejs)
packages_sanitize=("${packages_tests[@]}" clang libclang-rt-14-dev lld)
packages_wasm=(cmake ninja-build libeigen3-dev libfast-float-dev libfmt-dev nlohmann-json3-dev emscripten nodejs zstd)
packages_node=(nodejs npm)
packages_studio=(libcpp-httplib-dev libqrencode-dev) # for the page in the program
packages_python=(pybind11-dev python3-dev python3-numpy)
packages_installers=(dpkg-dev file help2man patchelf python3-wheel) # for ./dev package
packages_blender=(blender python3-numpy xvfb xauth) # for the add-on's tests
packages_bare=(mmdebstrap) # for a Debian with nothing on it
packages_browser=(chromium fonts-dejavu-core)
packages_learn=(python3 python3-torch python3-numpy python3-scipy python3-pil libopenblas0-pthread) # for ./dev learn
packages_cluster=(slurmctld slurmd slurm-client munge parallel) # for batches by engines
packages_site=(cmake doxygen mkdocs mkdocs-material)
packages_format=(clang-format)
packages_lint=("${packages_release[@]}" clang clang-tidy)

# The program that shows that a package's work is done even where dpkg has not heard of the package (a Node from
# elsewhere, a system without dpkg). Libraries have none: CMake says which of them it does not find.
program_of() {
  case "$1" in
    cmake | emscripten | clang | clang-format | clang-tidy | npm) echo "${1/emscripten/emcc}" ;;
    g++) echo g++ ;;
    ninja-build) echo ninja ;;
    nodejs) echo node ;;
  esac
}

is_installed() {
  local program
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ] && return 0
  program=$(program_of "$1")
  case "$1" in nodejs | npm) command -v "$program" >/dev/null ;; *) return 1 ;; esac
}

apt_run() {
  local as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 "$@" </dev/null
}

# need <package>...: installs with apt what is missing of them; without apt says what is missing and goes on.
need() {
  local package missing=()
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    name_missing "$@"
    return
  fi
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    echo "limber needs these packages, and there is no sudo to install them with: ${missing[*]}" >&2
    return 1
  fi
  echo "Installing with apt: ${missing[*]}"
  # A fresh machine has no package lists, and old lists name versions that are gone: then update, and once more.
  if apt-cache show "${missing[@]}" >/dev/null 2>&1 && apt_quietly install --no-install-recommends "${missing[@]}"; then
    return 0
  fi
  apt_quietly update && apt_quietly install --no-install-recommends "${missing[@]}" ||
    { echo "apt could not install: ${missing[*]}" >&2; tail -n 20 "$apt_log" >&2; return 1; }
}

# One at a time, for stages that run at once.
apt_log=build/apt.log
apt_quietly() {
  mkdir -p build
  { flock 9 && apt_run "$@" >"$apt_log" 2>&1 9>&-; } 9>build/apt.lock
}

# On a system without apt: the programs that are not there, and the Debian names of everything, for its own packager.
name_missing() {
  local package program missing=()
  for package in "$@"; do
    program=$(program_of "$package")
    [ -z "$program" ] || command -v "$program" >/dev/null || missing+=("$program")
  done
  [ -n "${named_missing:-}" ] || echo "No apt here. In Debian's names limber needs: $*"
  named_missing=yes
  [ ${#missing[@]} -eq 0 ] || echo "Programs not found: ${missing[*]}"
}
