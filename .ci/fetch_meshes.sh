#!/usr/bin/env bash
# Fetches the real meshes some tests drape cloth over: .ci/fetch_meshes.sh [--required] [DIR], DIR = build/real_meshes unless given.
# They come from Debian's package libcgal-demo, which is only unpacked (installing it would pull in 246 MB) and never copied into
# the repository. Without them those tests are skipped, so being offline is told and is no error; with --required it is one if a
# body scan is missing then. DIR/odd gets all meshes of that package and those of assimp-testmodels (20 MB), many of them broken on
# purpose, for tests/validation/odd_meshes.py.
set -euo pipefail

required=()
if [ "${1:-}" = --required ]; then
    required=(man armadillo bunny00)
    shift
fi
case "${1:-}" in -*) echo "fetch_meshes.sh: no option '$1' (--required)"; exit 2 ;; esac

directory=$(realpath -m "${1:-"$(dirname "$0")/../build/real_meshes"}")
meshes=(man armadillo bunny00 refined_elephant elephant fandisk anchor_dense knot1 hand larger_sphere
        b9_mesh blobby_3cc elephant-with-holes boeing ALSTOM_TEST4 sphere966 dino cactus)

missing=()
for mesh in "${meshes[@]}"; do
    [ -s "$directory/$mesh.off" ] || missing+=("$mesh")
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"

# Unpacks a package into $scratch/NAME.
unpack() {
    command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || return 1
    [ -d "$scratch/$1" ] && return
    (cd "$scratch" && apt-get download -qq "$1" >/dev/null 2>"$scratch/log") && dpkg-deb -x "$scratch/$1"_*.deb "$scratch/$1"
}

archive=$scratch/libcgal-demo/usr/share/doc/libcgal-dev/data.tar.gz

# Why the missing meshes cannot be had; nothing where they now can be unpacked.
reason() {
    if ! unpack libcgal-demo; then
        echo "libcgal-demo cannot be downloaded and unpacked"
    elif ! [ -f "$archive" ]; then
        echo "libcgal-demo holds no data.tar.gz"
    fi
}

fetch_scans() {
    local why mesh lacking=() wanted=("${missing[@]/#/data/meshes/}")
    why=$(reason)
    if [ -z "$why" ] && tar -xzf "$archive" -C "$scratch" "${wanted[@]/%/.off}"; then
        mkdir -p "$directory"
        for mesh in "${missing[@]}"; do
            mv "$scratch/data/meshes/$mesh.off" "$directory/$mesh.off"
        done
        echo "real meshes: fetched ${#missing[@]} into $directory"
        return
    fi
    why=${why:-"libcgal-demo lacks some of: ${missing[*]}"}
    for mesh in "${required[@]}"; do
        [ -s "$directory/$mesh.off" ] || lacking+=("$mesh")
    done
    if [ ${#lacking[@]} -gt 0 ]; then
        echo "real meshes: $why; required, but not in $directory: ${lacking[*]}"
        exit 1
    fi
    echo "real meshes: $why; the tests that need them will be skipped"
}

# odd_from PACKAGE FOLDER: what it holds of meshes and files that look like some, into odd/PACKAGE as a whole or not at all.
odd_from() {
    local target=$directory/odd/$1
    [ -d "$target" ] && return
    mkdir -p "$directory/odd"
    rm -rf "$target.part"
    mkdir "$target.part"
    (cd "$2" && find . -type f \( -path './invalid/*' -o -iregex \
        '.*\.\(obj\|off\|ply\|stl\|gltf\|glb\|bin\|dae\|fbx\|3ds\|amf\|x3d\|dxf\|lwo\|ase\|x\|raw\|nff\|blend\|ac\)' \) \
        -print0 | tar --null -T - -cf - | tar -xf - -C "$target.part")
    mv "$target.part" "$target"
    echo "odd meshes: $(find "$target" -type f | wc -l) of $1 in $target"
}

fetch_odd() {
    [ -d "$directory/odd/libcgal-demo" ] && [ -d "$directory/odd/assimp-testmodels" ] && return
    local why
    why=$(reason)
    if [ -z "$why" ] && tar -xzf "$archive" -C "$scratch" data/meshes && unpack assimp-testmodels; then
        odd_from libcgal-demo "$scratch/data/meshes"
        odd_from assimp-testmodels "$scratch/assimp-testmodels/usr/share/assimp/models"
    else
        echo "odd meshes: ${why:-assimp-testmodels cannot be downloaded and unpacked}; their test will be skipped"
    fi
}

if [ ${#missing[@]} -eq 0 ]; then
    echo "real meshes: all ${#meshes[@]} present in $directory"
else
    fetch_scans
fi
fetch_odd
