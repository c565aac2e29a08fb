#!/usr/bin/env bash
# notices.sh PACKAGE RELEASE_BUILD WASM_BUILD: the notices of what is compiled into a package (library, program, python or npm; the last
# takes nothing from RELEASE_BUILD). Shared libraries are not compiled in: a package that carries them carries their notices.
# What is compiled in is read off the builds, by the headers that they took. The texts are those of the Debian packages that these
# headers are of, and of the page's node_modules; the licences that they refer to follow at the end.
set -euo pipefail

package=$1 release=$2 wasm=$3
studio=$(cd "$(dirname "$0")/.." && pwd)/apps/studio

# Of paths: one of each folder, which is one package's; but all of /usr/include itself.
one_of_each_folder() { awk '{ folder = $0; sub(/\/[^\/]*$/, "", folder) } folder == "/usr/include" || !seen[folder]++'; }

# compiled_in <build> <pattern of objects>: Debian packages whose headers were taken. The headers of the C library and of the compiler ask for
# no notice. ninja names headers as seen from the build.
compiled_in() {
  ninja -C "$1" -t deps | awk -v wanted="$2" '/: #deps/ { take = $1 ~ wanted && $1 !~ /_tests\.dir/ } /^ / && take { print $1 }' | sort -u |
    one_of_each_folder | (cd "$1" && xargs readlink -f) | { grep '^/usr/' || true; } | sort -u | { xargs -r dpkg-query -S 2>/dev/null || true; } | cut -d: -f1 |
    { grep -vE '^(libc6-dev|linux-libc-dev|libstdc\+\+-[0-9]+-dev|libgcc-[0-9]+-dev|libclang.*)$' || true; } | sort -u
}

debian_texts() {
  local name
  for name in "$@"; do printf '%s/usr/share/doc/%s/copyright\n' "$name " "$name"; done
}

# What vite puts into the page: its dependencies, and what three brings along in three/examples/jsm/libs.
page_texts() {
  local name
  for name in $(node -p "Object.keys(require('$studio/package.json').dependencies).join(' ')") fflate meshoptimizer; do
    echo "$name" "$(ls "$studio/node_modules/$name"/LICENSE* | head -n 1)"
  done
  debian_texts libdraco-dev
}

engine_texts() { debian_texts emscripten $(compiled_in "$wasm" .); }

has_page() { grep -q '^LIMBER_STUDIO:BOOL=ON' "$release/CMakeCache.txt"; }

texts() {
  case $package in
    library) debian_texts $(compiled_in "$release" '^modules/') ;;
    program) debian_texts $(compiled_in "$release" '^(modules|apps)/') ;;
    python) debian_texts $(compiled_in "$release" '^(modules|apps|bindings)/') ;;
    npm) engine_texts ;;
    *) echo "notices.sh knows library, program, python and npm, not $package" >&2; exit 2 ;;
  esac
  case $package in program | python) ! has_page || { page_texts && engine_texts; } ;; esac
}

list=$(texts | sort -u)
[ -n "$list" ] || { echo "notices.sh: nothing is compiled in: was this built with ninja?" >&2; exit 1; }
rule=$(printf '=%.0s' {1..100})
echo "Parts of these are compiled in:"
cut -d' ' -f1 <<<"$list" | sed 's/^/  /'
while read -r name file; do
  [ -s "$file" ] || { echo "notices.sh: $name has no notice at $file" >&2; exit 1; }
  printf '\n%s\n%s\n%s\n\n' "$rule" "$name" "$rule"
  cat "$file"
done <<<"$list"
cut -d' ' -f2 <<<"$list" | xargs grep -hoE '/usr/share/common-licenses/[A-Za-z0-9]+(-[0-9]+(\.[0-9]+)?)?' | sort -u | while read -r file; do
  [ -f "$file" ] || continue # a sentence that names the folder alone
  printf '\n%s\n%s\n%s\n\n' "$rule" "$file" "$rule"
  cat "$file"
done
