#!/usr/bin/env bash
# Fetches the real meshes some tests drape cloth over: .ci/fetch_meshes.sh [--required] [DIR], DIR = build/real_meshes unless given.
# They come from Debian's package libcgal-demo, which is only unpacked (installing it would pull in 246 MB) and never copied into
# the repository. Without them those tests are skipped, so being offline is told and is no error; with --required it is one if a
# body scan is missing then.
set -euo pipefail

required=()
if [ "${1:-}" = --required ]; then
    required=(man armadillo bunny00)
    shift
fi
case "${1:-}" in -*) echo "fetch_meshes.sh: no option '$1' (--required)"; exit 2 ;; esac

directory=${1:-"$(cd "$(dirname "$0")/.." && pwd)/build/real_meshes"}
meshes=(man armadillo bunny00 refined_elephant elephant fandisk anchor_dense knot1 hand larger_sphere
        b9_mesh blobby_3cc elephant-with-holes boeing ALSTOM_TEST4 sphere966 dino cactus)

missing=()
for mesh in "${meshes[@]}"; do
    [ -s "$directory/$mesh.off" ] || missing+=("$mesh")
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "real meshes: all ${#meshes[@]} present in $directory"
    exit 0
fi

# Ends the script: meshes are missing for a reason.
skip() {
    local mesh lacking=()
    for mesh in "${required[@]}"; do
        [ -s "$directory/$mesh.off" ] || lacking+=("$mesh")
    done
    if [ ${#lacking[@]} -gt 0 ]; then
        echo "real meshes: $1; required, but not in $directory: ${lacking[*]}"
        exit 1
    fi
    echo "real meshes: $1; the tests that need them will be skipped"
    exit 0
}
command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || skip "not a Debian system"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"
(cd "$scratch" && apt-get download -qq libcgal-demo >/dev/null 2>"$scratch/log") || skip "libcgal-demo cannot be downloaded"
dpkg-deb -x "$scratch"/libcgal-demo_*.deb "$scratch/package"
archive=$scratch/package/usr/share/doc/libcgal-dev/data.tar.gz
[ -f "$archive" ] || skip "libcgal-demo holds no data.tar.gz"

wanted=("${missing[@]/#/data/meshes/}")
tar -xzf "$archive" -C "$scratch" "${wanted[@]/%/.off}" || skip "libcgal-demo lacks some of: ${missing[*]}"
mkdir -p "$directory"
for mesh in "${missing[@]}"; do
    mv "$scratch/data/meshes/$mesh.off" "$directory/$mesh.off"
done
echo "real meshes: fetched ${#missing[@]} into $directory"
