#!/usr/bin/env bash
# Uses what the Debian packages hold: .ci/try_packages.sh PART ROOT CONSUMER WORK. Parts: development, library, program, python, each
# without the others' files, and together. The library is used by a program that the part development left in WORK.
# ROOT is empty where the packages are installed, or the folder that they were unpacked in. CONSUMER is a copy of .ci/consumer with the
# README's example as readme_example.cpp; WORK a folder for what is made. Nothing here may look into Percale's tree.
set -euo pipefail
part=$1 root=$2 consumer=$3 work=$4
share=$root/usr/share/percale
program=$root/usr/bin/percale
mkdir -p "$work"

# Scenes that read a mesh, a clip and patterns; every other scene is planned, for which all its files are read.
try_program() {
    local scene
    "$program" --version
    "$program" check "$share"/scenes/{hang,tablecloth_on_sphere,skirt}.toml
    for scene in "$share"/scenes/*.toml; do
        "$program" plan "$scene" >"$work/plan.txt" || { cat "$work/plan.txt"; return 1; }
    done
    "$program" run "$share/scenes/tablecloth_on_sphere.toml" -o "$work/run" --set duration=0.5 >"$work/run.txt"
    "$program" certify "$work/run"
    "$program" report "$work/run"
    "$program" picture "$work/run" -o "$work/run.png"
    # A page and a picture with something in them.
    [ "$(stat -c %s "$work/run/report.html")" -gt 500000 ] && [ "$(stat -c %s "$work/run.png")" -gt 5000 ]
}

try_development() {
    local prefix=() pc_path library
    if [ -n "$root" ]; then prefix=("-DCMAKE_PREFIX_PATH=$root/usr"); fi
    cmake -S "$consumer" -B "$work/consumer" -DCMAKE_BUILD_TYPE=Release -DREADME_EXAMPLE=readme_example.cpp -DWITHOUT_PROGRAM=ON "${prefix[@]}"
    cmake --build "$work/consumer"
    ctest --test-dir "$work/consumer" --no-tests=error --output-on-failure
    cmake -S "$consumer/c" -B "$work/c" "${prefix[@]}"
    cmake --build "$work/c"
    ctest --test-dir "$work/c" --no-tests=error --output-on-failure
    # By pkg-config, for which installed packages need no path. xargs, because pkg-config escapes a space in a path with a backslash.
    pc_path=$(dirname "$(find "$root/usr/lib" -name percale.pc)")
    library=$(dirname "$pc_path")
    if [ -n "$root" ]; then export PKG_CONFIG_PATH=$pc_path; fi
    pkg-config --cflags --libs percale | xargs g++ -std=c++20 -O2 "$consumer/hang.cpp" -I "$consumer" -o "$work/hang"
    "$work/hang"
    pkg-config --cflags --libs percale-c | xargs cc -std=c99 "$consumer/c/weigh.c" -o "$work/weigh" -lm
    if [ -n "$root" ]; then export LD_LIBRARY_PATH=$library; fi
    "$work/weigh"
    pkg-config --cflags --libs percale-c | xargs cc -std=c99 "$share/examples/drape.c" -o "$work/drape" -lm
    "$work/drape" | tail -3
    # What a program weighs, stripped.
    strip -o "$work/hang.stripped" "$work/consumer/hang"
    strip -o "$work/example.stripped" "$work/consumer/readme_example"
    {
        echo "libpercale.so|$(stat -L -c %s "$library/libpercale.so")"
        echo ".ci/consumer/hang.cpp on percale::engine|$(stat -c %s "$work/hang.stripped")"
        echo "the README's example on percale::fcl|$(stat -c %s "$work/example.stripped")"
    } | tee "$work/sizes.txt"
}

# Where neither a compiler nor anything that came with it is installed.
try_library() {
    if [ -n "$root" ]; then LD_LIBRARY_PATH=$(dirname "$(find "$root/usr/lib" -name 'libpercale.so.*' | sed -n 1p)"); export LD_LIBRARY_PATH; fi
    "$work/weigh"
}

# With the program, which libpercale-dev recommends, scene files are tests of a project.
try_together() {
    local prefix=()
    if [ -n "$root" ]; then prefix=("-DCMAKE_PREFIX_PATH=$root/usr"); fi
    cmake -S "$consumer" -B "$work/together" "${prefix[@]}"
    ctest --test-dir "$work/together" --no-tests=error --output-on-failure -R '^scene_'
}

try_python() {
    if [ -n "$root" ]; then export PYTHONPATH=$root/usr/lib/python3/dist-packages; fi
    cd "$work"
    /usr/bin/python3 - "$consumer/scene.toml" <<'PYTHON'
import sys
import percale
result = percale.run(sys.argv[1], overrides={'duration': 0.25})
print(f'percale {percale.__version__} in {percale.__path__[0]}; {result}')
PYTHON
    /usr/bin/python3 "$share/examples/drape.py"
    /usr/bin/python3 "$share/examples/gripper.py"
}

case $part in
    development | library | program | python | together) "try_$part" ;;
    *) echo "try_packages.sh: no part '$part' (development library program python together)"; exit 2 ;;
esac
