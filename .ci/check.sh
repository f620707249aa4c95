#!/usr/bin/env bash
# All that a change must pass, in order; stops at the first stage that fails: .ci/check.sh [STAGE...]
# Stages: format layers gcc engine_only clang sanitizers fuzz scenes consumer readme. Builds are kept under build/ci-*.
set -uo pipefail
cd "$(dirname "$0")/.."
root=$PWD

stages=(format layers gcc engine_only clang sanitizers fuzz scenes consumer readme)
jobs=${PERCALE_JOBS:-2}
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs CTEST_PARALLEL_LEVEL=$jobs CTEST_OUTPUT_ON_FAILURE=1
export PERCALE_REAL_MESHES=${PERCALE_REAL_MESHES:-$root/build/real_meshes}
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0='*'   # a checkout owned by somebody else, as in containers
if [ -n "${CCACHE_DIR:-}" ] && command -v ccache >/dev/null; then   # worth it where a cache is kept
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$root
fi

# Files that git tracks or would track; without git or a repository all but builds. NUL-separated.
project_files() {
    if [ -e .git ] && command -v git >/dev/null; then
        git ls-files -z -co --exclude-standard | while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done
    else
        find . \( -path './build*' -o -path ./.git -o -name __pycache__ \) -prune -o -type f -printf '%P\0'
    fi
}

# configure_and_build FOLDER [CMAKE ARGUMENT...]; all, or what the caller's variable build_target names.
configure_and_build() {
    local folder=$1 generator=()
    shift
    if command -v ninja >/dev/null; then generator=(-G Ninja); fi
    cmake -B "$folder" "${generator[@]}" -DPERCALE_REAL_MESHES="$PERCALE_REAL_MESHES" "$@" >"$folder.log" 2>&1 || { cat "$folder.log"; return 1; }
    cmake --build "$folder" --target "${build_target:-all}"
}

# run_tests FOLDER [CTEST ARGUMENT...]; a build without tests is a failure.
run_tests() {
    local folder=$1
    shift
    ctest --test-dir "$folder" --no-tests=error "$@" | tee "$folder.ctest.log"
}

# The shell or C++ text of the README's fenced block behind the line <!-- ci:NAME -->.
readme_block() {
    awk -v mark="<!-- ci:$1 -->" '$0 == mark { wanted = 1; next } wanted && /^```/ { if (inside) exit; inside = 1; next } inside' README.md
}

stage_format() {
    clang-format --version
    project_files | grep -z -E '\.(cpp|h|inl)$' | xargs -0 clang-format --dry-run -Werror --ferror-limit=1 ||
        { echo "these files are not formatted: clang-format -i FILE"; return 1; }
}

stage_layers() {
    python3 .ci/layers.py
    python3 .ci/layers_test.py
    python3 .ci/perf_gate_test.py
}

stage_gcc() {
    configure_and_build build/ci-gcc -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Release -DPERCALE_WERROR=ON
    run_tests build/ci-gcc
}

# The engine must build where FCL, Bullet and assimp are missing; CMake is told not to find them.
stage_engine_only() {
    local hidden=() package
    for package in fcl ccd octomap Bullet assimp tomlplusplus nlohmann_json CLI11; do
        hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
    done
    configure_and_build build/ci-engine-only --preset engine-only -DCMAKE_CXX_COMPILER=clang++ "${hidden[@]}"
    run_tests build/ci-engine-only
}

stage_clang() {
    configure_and_build build/ci-clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DPERCALE_WERROR=ON
    run_tests build/ci-clang -LE long
}

stage_sanitizers() {
    configure_and_build build/ci-asan --preset asan -DCMAKE_CXX_COMPILER=g++
    UBSAN_OPTIONS=print_stacktrace=1 run_tests build/ci-asan -LE long
}

# Targets of tests/fuzz for half a minute, from the corpus and what it finds; what fails is left in build/ci-fuzz-found.
stage_fuzz() {
    local seconds=${PERCALE_FUZZ_SECONDS:-30} found=$root/build/ci-fuzz-found build_target=fuzz name
    configure_and_build build/ci-fuzz -DCMAKE_CXX_COMPILER=clang++ -DPERCALE_FUZZ=ON -DPERCALE_WERROR=ON -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only"
    rm -rf "$found"
    for name in scene obj off checkpoint; do   # not ply: assimp's reader spoils its own heap now and then (tests/README.md)
        mkdir -p "$found/$name"
        echo "fuzz $name:"
        build/ci-fuzz/percale_fuzz_$name -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=8192 \
            -artifact_prefix="$found/$name-" -print_final_stats=1 "$found/$name" "tests/fuzz/corpus/$name" >"$found/$name.log" 2>&1 ||
            { tail -60 "$found/$name.log"; return 1; }
        grep -a -E '^(Done|stat::number_of_executed_units|stat::peak_rss)' "$found/$name.log"
    done
}

stage_scenes() {
    [ -x build/ci-gcc/percale ] || { echo "build/ci-gcc/percale is missing: run the stage gcc first"; return 1; }
    build/ci-gcc/percale check data/scenes/*.toml
}

# Installs into a fresh prefix and builds somebody else's program against it, by CMake and by pkg-config.
stage_consumer() {
    local prefix=$root/build/ci-install scratch=$root/build/ci-consumer pc_path
    [ -d build/ci-gcc ] || { echo "build/ci-gcc is missing: run the stage gcc first"; return 1; }
    rm -rf "$prefix" "$scratch" "$scratch-source"
    cmake --install build/ci-gcc --prefix "$prefix" >build/ci-install.log
    cp -r .ci/consumer "$scratch-source"
    readme_block embed >"$scratch-source/readme_example.cpp"
    [ -s "$scratch-source/readme_example.cpp" ] || { echo "README.md has no block behind <!-- ci:embed -->"; return 1; }
    cmake -S "$scratch-source" -B "$scratch" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release -DREADME_EXAMPLE=readme_example.cpp
    cmake --build "$scratch"
    ctest --test-dir "$scratch" --no-tests=error
    pc_path=$(dirname "$(find "$prefix" -name percale.pc)")
    # xargs, because pkg-config escapes a space in a path with a backslash.
    PKG_CONFIG_PATH=$pc_path pkg-config --cflags --libs percale |
        xargs g++ -std=c++20 "$scratch-source/hang.cpp" -I "$scratch-source" -o "$scratch/hang_by_pkg_config"
    "$scratch/hang_by_pkg_config"
    "$prefix/bin/percale" --version
}

# The README's two commands, as a newcomer would type them, in a copy of the checkout in a path with a space. Packages are there already.
stage_readme() {
    local copy="$root/build/ci-readme/a path with a space" name
    rm -rf "$root/build/ci-readme"
    mkdir -p "$copy"
    project_files | tar --null -T - -cf - | tar -xf - -C "$copy"
    for name in drape test; do
        readme_block "$name" >"$copy/../$name.sh"
        [ -s "$copy/../$name.sh" ] || { echo "README.md has no block behind <!-- ci:$name -->"; return 1; }
        echo "README, $name:"
        cat "$copy/../$name.sh"
        (
            cd "$copy"
            unset PERCALE_REAL_MESHES
            sudo() { "$@"; }
            apt-get() { echo "(skipped: apt-get $1)"; }
            set -e
            # shellcheck source=/dev/null
            . "../$name.sh"
        )
    done
    find "$copy" -name report.json -not -path '*/data/*' -not -path '*/Testing/*' -printf '%h\0' >"$copy/../runs"
    [ -s "$copy/../runs" ] || { echo "the README's first command left no report.json"; return 1; }
    xargs -0 -n 1 "$copy/build/percale" certify <"$copy/../runs"
}

selected=("$@")
[ ${#selected[@]} -gt 0 ] || selected=("${stages[@]}")
for stage in "${selected[@]}"; do
    case " ${stages[*]} " in *" $stage "*) ;; *) echo "check.sh: no stage '$stage' (${stages[*]})"; exit 2 ;; esac
done

mkdir -p build
times=()
for stage in "${selected[@]}"; do
    echo "== $stage"
    started=$SECONDS
    (set -e; "stage_$stage") </dev/null
    status=$?
    times+=("$stage $((SECONDS - started)) s")
    if [ $status -ne 0 ]; then
        echo "check.sh: stage $stage FAILED after $((SECONDS - started)) s (exit code $status)"
        exit 1
    fi
    echo "== $stage passed in $((SECONDS - started)) s"
done
echo "check.sh: all stages passed: $(printf '%s, ' "${times[@]}" | sed 's/, $//')"
# The closing lines of the whole test suite come last.
case " ${selected[*]} " in *" gcc "*) echo "whole test suite (stage gcc):" && sed -n '/% tests passed/,$p' build/ci-gcc.ctest.log ;; esac
