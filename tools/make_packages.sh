#!/usr/bin/env bash
# make_packages.sh BUILD_FOLDER OUTPUT_FOLDER: .deb of the program and of the library, a .tar.gz of the program, a wheel for
# Debian 12's Python, a package for npm and the add-on for Blender. The .tar.gz and the wheel carry their shared libraries with
# their notices, and all but the add-on (which is limber's alone) those of what is compiled in (notices.sh). Everything is built already. Called by ./dev package.
set -euo pipefail
umask 022

build=$(cd "$1" && pwd)
mkdir -p "$2"
output=$(cd "$2" && pwd)
limber=$build/limber manual=$build/manual/program
version=$($limber --version | cut -d' ' -f2)
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 0)}

# manual_page <limber command...>: from what --help says.
manual_page() {
  local name=${*// /-} summary
  name=${name// /-}
  summary=$("$limber" "${@:2}" --help | sed -n 1p)
  PATH=$build:$PATH help2man --no-info --version-string="$version" --name="$summary" "$*" |
    sed "s/^$* \\\\-/${name//-/\\\\-} \\\\-/" | gzip -9n >"$manual/man/man1/$name.1.gz"
}

commands_of() { "$limber" "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p'; }

# notices <folder> <package of notices.sh>: as Debian's policy has them.
notices() {
  mkdir -p "$1"
  tools/notices.sh "$2" "$build" build/wasm >"$1/NOTICES"
  cat >"$1/copyright" <<TEXT
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: limber

Files: *
Copyright: 2026 the authors of limber
License: Apache-2.0
 The whole text is in /usr/share/common-licenses/Apache-2.0 on Debian systems.
Comment: Parts of other projects are compiled in; their notices are in the file
 NOTICES beside this one.
TEXT
  gzip -9n <CHANGELOG.md >"$1/changelog.gz"
  gzip -9n >"$1/changelog.Debian.gz" <<TEXT
limber ($version-1) bookworm; urgency=medium

  * Built from limber $version: see changelog.gz.

 -- limber maintainers <maintainers@limber.invalid>  $(date -R -u -d "@$SOURCE_DATE_EPOCH")
TEXT
}

rm -rf "$build/manual"
mkdir -p "$manual"/{man/man1,bash-completion/completions,zsh/vendor-completions,fish/vendor_completions.d}
notices "$manual/doc/limber" program
mkdir -p "$manual/doc/limber/docs"
cp docs/*.md docs/*.json "$manual/doc/limber/docs" # the pages that --help names
cp -r docs/algorithms "$manual/doc/limber/docs"
notices "$build/manual/development/doc/liblimber-dev" library
manual_page limber
for command in $(commands_of); do
  manual_page limber "$command"
  for part in $(commands_of "$command"); do manual_page limber "$command" "$part"; done
done
"$limber" completion bash >"$manual/bash-completion/completions/limber"
"$limber" completion zsh >"$manual/zsh/vendor-completions/_limber"
"$limber" completion fish >"$manual/fish/vendor_completions.d/limber.fish"

work=$build/packages
rm -rf "$work"
cpack --config "$build/CPackConfig.cmake" -G 'DEB;TGZ' -B "$work" >"$build/cpack.log" 2>&1 || { tail -n 20 "$build/cpack.log" >&2; exit 1; }
rm -f "$output"/*.deb "$output"/*.tar.gz
cp "$work"/*.deb "$output"

# Every shared library but the C library's own, found from the program's folder; and who made each.
portable=limber-$version-linux-$(uname -m)
root=$work/$portable
rm -rf "$root"
mkdir "$root"
tar -xzf "$work/$portable.tar.gz" -C "$root" --strip-components=1
cp LICENSE "$root/share/doc/limber/LICENSE"
# carry_libraries <program> <folder for libraries> <folder for notices>
carry_libraries() {
  local library package
  mkdir -p "$2" "$3"
  ldd "$1" | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' | sort | while read -r library; do
    case $(basename "$library") in libc.so* | libm.so* | libdl.so* | libpthread.so* | librt.so* | ld-linux*) continue ;; esac
    cp -L "$library" "$2"
    patchelf --set-rpath '$ORIGIN' "$2/$(basename "$library")"
    package=$(dpkg-query -S "$(readlink -f "$library")" 2>/dev/null || dpkg-query -S "*/$(basename "$(readlink -f "$library")")")
    package=$(sed "1!d;s/:.*//" <<<"$package")
    cp -L "/usr/share/doc/$package/copyright" "$3/$package.txt"
  done
}

carry_libraries "$limber" "$root/lib" "$root/share/doc/limber/libraries"
patchelf --set-rpath '$ORIGIN/../lib' "$root/bin/limber"
tar -C "$work" --mode=u+rw,go=rX --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -cf - "$portable" | gzip -9n >"$output/$portable.tar.gz"
# The module, the program for python -m limber, and what both need.
module=$(echo "$build"/python/limber/_limber.*.so)
wheel=$work/wheel tag=cp$(basename "$module" | sed -E 's/.*cpython-([0-9]+)-.*/\1/')
rm -rf "$wheel"
mkdir -p "$wheel/limber/bin" "$wheel/limber-$version.dist-info"
cp bindings/python/limber/*.py* bindings/python/limber/py.typed "$wheel/limber"
cp "$module" "$wheel/limber"
cp "$root/bin/limber" "$wheel/limber/bin"
carry_libraries "$module" "$wheel/limber/lib" "$wheel/limber-$version.dist-info/libraries"
carry_libraries "$limber" "$wheel/limber/lib" "$wheel/limber-$version.dist-info/libraries"
strip "$wheel"/limber/_limber.*.so
patchelf --set-rpath '$ORIGIN/lib' "$wheel"/limber/_limber.*.so
cp LICENSE "$wheel/limber-$version.dist-info"
tools/notices.sh python "$build" build/wasm >"$wheel/limber-$version.dist-info/NOTICES"
cat >"$wheel/limber-$version.dist-info/METADATA" <<TEXT
Metadata-Version: 2.1
Name: limber
Version: $version
Summary: Rigs, skins, poses and retargets 3D models
License: Apache-2.0
Requires-Python: >=3.11,<3.12
Requires-Dist: numpy
TEXT
cat >"$wheel/limber-$version.dist-info/WHEEL" <<TEXT
Wheel-Version: 1.0
Generator: limber
Root-Is-Purelib: false
Tag: $tag-$tag-linux_$(uname -m)
TEXT
rm -f "$output"/*.whl
/usr/bin/python3 -m wheel pack "$wheel" -d "$output" >/dev/null

# The add-on for Blender.
rm -rf "$work/blender" "$output"/*.zip
mkdir -p "$work/blender/limber"
cp apps/blender/limber/*.py apps/blender/limber/*.toml LICENSE "$work/blender/limber"
/usr/bin/python3 - "$output/limber-blender-$version.zip" "$work/blender" <<'PYTHON'
import os, pathlib, sys, time, zipfile
moment = time.gmtime(max(315532800, int(os.environ["SOURCE_DATE_EPOCH"])))[:6]
with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as archive:
    for path in sorted(pathlib.Path(sys.argv[2]).rglob("*")):
        if path.is_file():
            entry = zipfile.ZipInfo(str(path.relative_to(sys.argv[2])), moment)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, path.read_bytes(), zipfile.ZIP_DEFLATED)
PYTHON

# The npm package, where the engine is built as WebAssembly.
rm -f "$output"/*.tgz
[ ! -f build/wasm/limber_engine.wasm ] || bindings/npm/make.sh build/wasm "$limber" "$output"

ls -l "$output" | awk 'NR > 1 { printf "%6.1f MB  %s\n", $5 / 1e6, $NF }'
