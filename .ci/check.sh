#!/usr/bin/env bash
# All that a change must pass, in order; stops at the first stage that fails, at night after all: .ci/check.sh [STAGE...]
# By day, without arguments: format layers release python perf consumer engine_only alone sanitizers fuzz. `night` stands for the stages
# one_by_one soak sanitizers_night races fuzz_night, which take longer than a change can wait for; only on demand: packages.
# Each compiler builds what it tests once, in batches: g++ all, as the README says; clang++ engine, collision, their tests, the program and
# the fuzz targets, under sanitizers.
# That no source leans on its batch is seen by alone, which reads what changed, and by one_by_one, which builds everything.
# A stage says how long it compiled (within cmake) and ran, and what took longest. Builds are kept under build/ci-*.
set -uo pipefail
cd "$(dirname "$0")/.."
root=$PWD

stages=(format layers release python perf consumer engine_only alone sanitizers fuzz)
night=(one_by_one soak sanitizers_night races fuzz_night)
on_demand=(packages)
release_copy="$root/build/ci-release/a path with a space"
jobs=${PERCALE_JOBS:-2}
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs CTEST_PARALLEL_LEVEL=$jobs CTEST_OUTPUT_ON_FAILURE=1
export PERCALE_REAL_MESHES=${PERCALE_REAL_MESHES:-$root/build/real_meshes}
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0='*'   # a checkout owned by somebody else, as in containers
export CMAKE_CXX_COMPILER_LAUNCHER=$root/.ci/timed_compiler CCACHE_BASEDIR=$root
export PERCALE_COMPILE_TIMES=$root/build/ci-times/compile   # a line a compilation
waited=$root/build/ci-times/waited                          # a line a command

# compiling COMMAND...: its seconds count as compiling, as all do within cmake, which configures, compiles and installs.
compiling() {
    local started=$EPOCHREALTIME status=0
    "$@" || status=$?
    echo "$started $EPOCHREALTIME" >>"$waited"
    return $status
}
cmake() { compiling command cmake "$@"; }

# compiled: whole seconds of it in this stage.
compiled() {
    awk '{ sum += $2 - $1 } END { printf "%d", sum }' "$waited"
}

# slowest TITLE: the ten greatest of the lines SECONDS NAME on standard input, on one line.
slowest() {
    sort -rn | awk -v title="$1" 'NR <= 10 { seconds = $1; $1 = ""; text = text sprintf("%s%s %.0f", NR > 1 ? "," : "", $0, seconds) }
        END { if (NR > 0) print "   " title ":" text }'
}

# report_slowest: of the stage that ran since the file of times was emptied; not what CMake tries out.
report_slowest() {
    grep -v -E 'CMakeScratch|/Modules/|CompilerId' "$PERCALE_COMPILE_TIMES" | sed -E "s|^([0-9.]+) ([0-9.]+) .*/([^/]+/[^/]+/[^/]+)$|\\1 \\2 \\3|" | sed 's|CMakeFiles/||; s|\.dir/Unity||' |
        awk '{ seconds = $1 + $2; $1 = $2 = ""; print seconds, $0 }' | slowest "slowest to compile, CPU s"
    # ctest's own file: name, runs, seconds; without a run, as of a test that failed, the last is a property instead.
    find build/ci-* -path build/ci-faults -prune -o -name CTestCostData.txt -exec awk '/^---/ { exit } $(NF - 1) > 0 { s = $NF; $NF = $(NF - 1) = ""; print s, $0 }' {} \; |
        slowest "slowest to run, s"
}

# Files that git tracks or would track; without git or a repository all but builds. NUL-separated.
project_files() {
    if [ -e .git ] && command -v git >/dev/null; then
        git ls-files -z -co --exclude-standard | while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done
    else
        find . \( -path './build*' -o -path ./.git -o -name __pycache__ \) -prune -o -type f -printf '%P\0'
    fi
}

# passed_cases FILE...: how many cases Catch2 says there that passed.
passed_cases() {
    sed -n -E 's/^All tests passed .* in ([0-9]+) test cases?.*/\1/p; s/^test cases: +([0-9]+) \| +\1 passed.*/\1/p' "$@" |
        awk '{ sum += $1 } END { print sum + 0 }'
}

# known_cases SPEC PROGRAM...: how many cases of test programs it matches. The exit code of a listing is their number.
known_cases() {
    local spec=$1 program
    shift
    for program in "$@"; do "$program" -# --list-test-names-only "$spec" || true; done | wc -l
}

# configure FOLDER [CMAKE ARGUMENT...]
configure() {
    local folder=$1 generator=()
    shift
    if command -v ninja >/dev/null; then generator=(-G Ninja); fi
    cmake -B "$folder" "${generator[@]}" -DPERCALE_REAL_MESHES="$PERCALE_REAL_MESHES" "$@" >"$folder.log" 2>&1 || { cat "$folder.log"; return 1; }
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
    project_files | { grep -z -E '\.py$' || true; } | xargs -0 python3 -c 'import ast, sys; [ast.parse(open(f).read(), f) for f in sys.argv[1:]]'
    python3 .ci/layers.py
    python3 .ci/layers_test.py
    python3 .ci/perf_gate_test.py
    python3 .ci/quick_test.py
    python3 .ci/read_alone_test.py
    python3 .ci/plant_faults.py --check
}

# The README's two commands, as a newcomer would type them, in a copy of the checkout in a path with a space: the release build by g++
# and the whole test suite. Packages are there already; warnings are errors; the body scans lie where fetch_meshes.sh puts them.
stage_release() {
    local name
    rm -rf "$root/build/ci-release"
    mkdir -p "$release_copy/build"
    project_files | tar --null -T - -cf - | tar -xf - -C "$release_copy"
    ln -s "$PERCALE_REAL_MESHES" "$release_copy/build/real_meshes"
    for name in drape test; do
        readme_block "$name" >"$release_copy/../$name.sh"
        [ -s "$release_copy/../$name.sh" ] || { echo "README.md has no block behind <!-- ci:$name -->"; return 1; }
        echo "README, $name:"
        cat "$release_copy/../$name.sh"
        (
            cd "$release_copy"
            export CXX=g++ CXXFLAGS="-Werror --param=ggc-min-heapsize=1048576"   # KB: garbage is collected later, a tenth less time
            apt-get() { echo "(skipped: apt-get $1)"; }
            set -e
            # shellcheck source=/dev/null
            . "../$name.sh"
        ) | tee "$release_copy/../$name.log"
        echo "README, $name: done at $((SECONDS - started)) s"
    done
    find "$release_copy" -name report.json -not -path '*/data/*' -not -path '*/Testing/*' -printf '%h\0' >"$release_copy/../runs"
    [ -s "$release_copy/../runs" ] || { echo "the README's first command left no report.json"; return 1; }
    xargs -0 -n 1 "$release_copy/build/percale" certify <"$release_copy/../runs"
    local ran known
    ran=$(passed_cases "$release_copy/build/Testing/Temporary/LastTest.log")
    known=$(known_cases '~[.]' "$release_copy"/build/percale_*_tests)
    echo "$ran of $known cases passed"
    grep -h -o 'not everything was tested: .*' "$release_copy/build/Testing/Temporary/LastTest.log" | sort | uniq -c || true
    [ "$known" -gt 0 ] || return 1
    [ "$ran" -eq "$known" ] || return 1
    echo "without body scans:"
    for name in collision validation; do
        PERCALE_REAL_MESHES=$root/build/ci-release/none "$release_copy/build/percale_${name}_tests" '*scan*' --warn NoTests \
            >"$release_copy/../without_scans.log" || { cat "$release_copy/../without_scans.log"; return 1; }
        grep 'not everything was tested' "$release_copy/../without_scans.log"
    done
}

# The engine must build where FCL, Bullet and assimp are missing; CMake is told not to find them. Its tests run in the stages release and
# sanitizers; here a towel hangs.
stage_engine_only() {
    local hidden=() package
    for package in fcl ccd octomap Bullet assimp tomlplusplus nlohmann_json CLI11; do
        hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
    done
    configure build/ci-engine-only --preset engine-only -DCMAKE_CXX_COMPILER=clang++ -DPERCALE_TESTS=OFF "${hidden[@]}"
    cmake --build build/ci-engine-only
    rm -rf build/ci-engine-only/installed
    cmake --install build/ci-engine-only --prefix build/ci-engine-only/installed >>build/ci-engine-only.log
    cmake -S .ci/consumer -B build/ci-engine-only/consumer -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DENGINE_ONLY=ON \
        -DCMAKE_PREFIX_PATH="$root/build/ci-engine-only/installed" "${hidden[@]}" >>build/ci-engine-only.log
    cmake --build build/ci-engine-only/consumer
    ctest --test-dir build/ci-engine-only/consumer --no-tests=error
}

# The commit from which changes are counted: PERCALE_BASE, if there is such a commit; else where the default branch was left; on that
# branch itself the last one that is a day older than the newest. Nothing where there is no such history.
changes_since() {
    local base
    if [ -n "${PERCALE_BASE:-}" ] && git rev-parse -q --verify "$PERCALE_BASE^{commit}" >/dev/null 2>&1; then echo "$PERCALE_BASE"; return; fi
    git rev-parse -q --verify HEAD >/dev/null 2>&1 || return 0
    base=$(git merge-base HEAD refs/remotes/origin/HEAD 2>/dev/null || git merge-base HEAD refs/remotes/origin/main 2>/dev/null ||
        git merge-base HEAD refs/heads/main 2>/dev/null || true)
    if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
        base=$(git rev-list -1 --before="$(($(git log -1 --format=%ct) - 86400))" HEAD)
    fi
    echo "$base"
}

# Sources that changed, and those that include what changed, each read by clang++ without the others of its batch; nothing is compiled.
# Where one reads Eigen, mostly through percale/mesh.h, Eigen has been read before.
stage_alone() {
    local base
    base=$(changes_since)
    configure build/ci-alone -DCMAKE_CXX_COMPILER=clang++ -DPERCALE_WERROR=ON -DPERCALE_UNITY=OFF -DPERCALE_PYTHON=ON \
        -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
    python3 .ci/read_alone.py "$root" build/ci-alone "$base" >build/ci-alone/commands
    echo "$(tr -d -c '\0' <build/ci-alone/commands | wc -c) sources are read${base:+, of those that changed since $base or whose headers did}"
    compiling xargs -0 -r -P "$jobs" -n 1 bash -c <build/ci-alone/commands
}

# build_sanitizers TARGET...: clang++, address and undefined-behaviour sanitizers.
build_sanitizers() {
    configure build/ci-sanitizers -DCMAKE_CXX_COMPILER=clang++ -DPERCALE_FUZZ=ON -DPERCALE_WERROR=ON \
        -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only"
    cmake --build build/ci-sanitizers --target "$@"
}

# Test files whose cases are whole runs: minutes each under sanitizers.
whole_runs=(real_mesh_test bullet_world_test mannequin_test mannequin_motion_test poncho_test shipped_meshes_test rest_scene_test
            start_repair_run_test)

# run_file BUILD LAYER NAME: the cases of the test files of that name, without laws and cases that take seconds, in one process.
run_file() {
    local log=$1/cases/$2.$3.log started=$EPOCHREALTIME
    "$1/percale_$2_tests" -# "[#$3]~[law]~[slow]~[.]" >"$log" 2>&1 || { echo "$2, $3:"; tail -80 "$log"; return 1; }
    awk -v a="$started" -v b="$EPOCHREALTIME" -v name="$2: $3" 'BEGIN { printf "%.2f %s\n", b - a, name }' >>"$1/cases/times"
}

# The test files of a layer's program, by name; those of properties/ are asked for in both programs that have some.
test_files() {
    find "tests/$1" tests/properties -name '*_test.cpp' -printf '%f\n' | sed 's/\.cpp$//' | sort -u |
        grep -v -x -F "$(printf '%s\n' "${whole_runs[@]}")" | sed "s/^/$1 /"
}

# run_files BUILD LAYER...: a process for each test file; that no case was left out is checked by their number.
run_files() {
    local build=$1 layer wanted ran programs=()
    shift
    export UBSAN_OPTIONS=print_stacktrace=1
    rm -rf "$build/cases"
    mkdir -p "$build/cases"
    export -f run_file
    for layer in "$@"; do test_files "$layer"; done | xargs -P "$jobs" -n 2 bash -c 'run_file "$0" "$1" "$2"' "$build"
    for layer in "$@"; do programs+=("$build/percale_${layer}_tests"); done
    wanted=$(known_cases "~[law]~[slow]~[.]$(printf '~[#%s]' "${whole_runs[@]}")" "${programs[@]}")
    ran=$(passed_cases "$build"/cases/*.log)
    slowest "slowest to run, s" <"$build/cases/times"
    echo "$ran of $wanted cases passed"
    [ "$wanted" -gt 0 ] && [ "$ran" -eq "$wanted" ]
}

# Scenes that go through what the program has: springs and hinges, bodies rigid and bending, cloth on cloth, sewing, pressure, wind.
begun_scenes=(hang six_particles strip_with_hinges tablecloth_on_sphere sheet_folding_on_floor beach_ball skirt poncho_wave flag
              two_sheets_on_spikes)

# begin_scene BUILD THREADS NAME: the beginning of a scene, with all that the program writes of a run, and its certificate. What is expected
# of the whole run is left out.
begin_scene() {
    local folder=$1/runs/$3
    "$1/percale" run "data/scenes/$3.toml" -o "$folder" --threads "$2" --set duration=0.1 --set expect={} --frames obj,glb,pc2 --quiet \
        >"$folder.log" 2>&1 && "$1/percale" certify "$folder" >>"$folder.log" 2>&1 || { echo "scene $3:"; tail -40 "$folder.log"; return 1; }
}

# begin_scenes BUILD THREADS JOBS
begin_scenes() {
    rm -rf "$1/runs"
    mkdir -p "$1/runs"
    export -f begin_scene
    printf '%s\n' "${begun_scenes[@]}" | xargs -P "$3" -n 1 bash -c 'begin_scene "$0" "$1" "$2"' "$1" "$2"
}

# Without whole runs, laws and cases tagged [slow] (seconds in a release build), which repeat what unit tests reach.
stage_sanitizers() {
    build_sanitizers percale_engine_tests percale_collision_tests percale fuzz
    run_files build/ci-sanitizers engine collision
    begin_scenes build/ci-sanitizers 1 "$jobs"
}

stage_sanitizers_night() {
    build_sanitizers percale_scenes_tests
    run_files build/ci-sanitizers scenes
}

# What threads share, under the thread sanitizer: tests of threads, and ten scenes on four of them.
stage_races() {
    local layer
    configure build/ci-races --preset tsan -DCMAKE_CXX_COMPILER=clang++
    cmake --build build/ci-races --target percale_engine_tests percale_collision_tests percale
    for layer in engine collision; do
        build/ci-races/percale_${layer}_tests '~[law]~[.]*thread*,~[law]~[.]*worker*' --warn NoTests
    done
    begin_scenes build/ci-races 4 1
}

# fuzz_one NAME: from the corpus and what it finds; what fails is left in build/ci-fuzz-found. Code runs about three times slower under sanitizers.
fuzz_one() {
    local name=$1 found=$root/build/ci-fuzz-found
    mkdir -p "$found/$name"
    "build/ci-sanitizers/percale_fuzz_$name" -seed=1 -max_total_time="${PERCALE_FUZZ_SECONDS:-30}" -timeout=30 -rss_limit_mb=2048 -max_len=8192 \
        -artifact_prefix="$found/$name-" -print_final_stats=1 "$found/$name" "tests/fuzz/corpus/$name" >"$found/$name.log" 2>&1 ||
        { tail -60 "$found/$name.log"; return 1; }
    echo "fuzz $name: $(grep -a -E '^(Done|stat::number_of_executed_units|stat::peak_rss)' "$found/$name.log" | paste -s -d ' ')"
}

# Targets of tests/fuzz for half a minute each, as many at once as there are jobs.
stage_fuzz() {
    build_sanitizers fuzz
    rm -rf "$root/build/ci-fuzz-found"
    export -f fuzz_one
    export root
    printf '%s\n' tests/fuzz/*_target.cpp | sed 's|.*/\(.*\)_target.cpp|\1|' | xargs -P "$jobs" -n 1 bash -c 'fuzz_one "$1"' fuzz_one
}

# The Python module in the same build, and its tests.
stage_python() {
    [ -x "$release_copy/build/percale" ] || { echo "$release_copy/build/percale is missing: run the stage release first"; return 1; }
    cmake -S "$release_copy" -B "$release_copy/build" -DPERCALE_PYTHON=ON >"$root/build/ci-python.log" 2>&1 || { cat "$root/build/ci-python.log"; return 1; }
    cmake --build "$release_copy/build" --target percale percale_python
    ctest --test-dir "$release_copy/build" --no-tests=error -L python
}

# Instructions of the steps of small scenes against .ci/instructions.json.
stage_perf() {
    [ -x "$release_copy/build/percale" ] || { echo "$release_copy/build/percale is missing: run the stage release first"; return 1; }
    python3 .ci/perf_gate.py --program "$release_copy/build/percale"
}

# Everything by clang++ without sanitizers, file by file, programs that measure, too; tests and laws.
stage_one_by_one() {
    configure build/ci-one-by-one -DCMAKE_CXX_COMPILER=clang++ -DPERCALE_WERROR=ON -DPERCALE_UNITY=OFF -DPERCALE_PYTHON=ON -DCMAKE_BUILD_TYPE=Release
    cmake --build build/ci-one-by-one --target all benches
    # What skipped work costs in instructions is proven by day, of the batches that users get: here calls between files are not inlined.
    ctest --test-dir build/ci-one-by-one --no-tests=error -E "cost proofs"
}

# Hidden tests: a million steps; every shipped scene whole with every tree.
stage_soak() {
    [ -x build/ci-one-by-one/percale_validation_tests ] || { echo "build/ci-one-by-one is missing: run the stage one_by_one first"; return 1; }
    build/ci-one-by-one/percale_validation_tests '[.soak],[.night]' --warn NoTests
}

stage_fuzz_night() {
    PERCALE_FUZZ_SECONDS=${PERCALE_FUZZ_SECONDS:-300} stage_fuzz
}

# copy_consumer FOLDER: with the README's example.
copy_consumer() {
    cp -r .ci/consumer "$1"
    readme_block embed >"$1/readme_example.cpp"
    [ -s "$1/readme_example.cpp" ] || { echo "README.md has no block behind <!-- ci:embed -->"; return 1; }
}

# Installs into a fresh prefix and builds somebody else's program against it, by CMake and by pkg-config.
stage_consumer() {
    local prefix=$root/build/ci-install scratch=$root/build/ci-consumer pc_path
    [ -d "$release_copy/build" ] || { echo "$release_copy/build is missing: run the stage release first"; return 1; }
    rm -rf "$prefix" "$scratch" "$scratch-source"
    cmake --install "$release_copy/build" --prefix "$prefix" >build/ci-install.log
    copy_consumer "$scratch-source"
    cmake -S "$scratch-source" -B "$scratch" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release -DREADME_EXAMPLE=readme_example.cpp
    cmake --build "$scratch"
    ctest --test-dir "$scratch" --no-tests=error
    pc_path=$(dirname "$(find "$prefix" -name percale.pc)")
    # xargs, because pkg-config escapes a space in a path with a backslash.
    PKG_CONFIG_PATH=$pc_path pkg-config --cflags --libs percale |
        xargs g++ -std=c++20 "$scratch-source/hang.cpp" -I "$scratch-source" -o "$scratch/hang_by_pkg_config"
    "$scratch/hang_by_pkg_config"
    # In C alone, which asks for no other package.
    cmake -S "$scratch-source/c" -B "$scratch/c" -DCMAKE_PREFIX_PATH="$prefix"
    cmake --build "$scratch/c"
    ctest --test-dir "$scratch/c" --no-tests=error
    PKG_CONFIG_PATH=$pc_path pkg-config --cflags --libs percale-c |
        xargs cc -std=c99 "$scratch-source/c/weigh.c" -o "$scratch/weigh_by_pkg_config" -Wl,-rpath,"$(dirname "$pc_path")" -lm
    "$scratch/weigh_by_pkg_config"
    "$prefix/bin/percale" --version
    # Percale's sources in a host's own tree: what the host has not asked for it has not got. The stage packages builds it, too.
    cmake -S "$scratch-source/subdirectory" -B "$scratch/subdirectory" -DPERCALE_SOURCE="$root" >>build/ci-install.log
    cmake -S "$scratch-source/subdirectory" -B "$scratch/subdirectory-engine" -DPERCALE_SOURCE="$root" -DENGINE_ONLY=ON >>build/ci-install.log
}

# The Debian packages, by a build of their own: contents, pip, Percale as another project's folder, and use of each package.
stage_packages() {
    local scratch=$root/build/ci-packages-try
    configure build/ci-packages --preset packages
    rm -f build/ci-packages/*.deb
    cmake --build build/ci-packages --target package
    rm -rf "$scratch"
    mkdir "$scratch"
    copy_consumer "$scratch/consumer"
    .ci/packages.sh build/ci-packages "$scratch/consumer" "$scratch"
}

selected=()
for stage in "${@:-day}"; do
    case $stage in
        day) selected+=("${stages[@]}") ;;
        night) selected+=("${night[@]}") ;;
        *) selected+=("$stage") ;;
    esac
done
for stage in "${selected[@]}"; do
    case " ${stages[*]} ${night[*]} ${on_demand[*]} " in
        *" $stage "*) ;;
        *) echo "check.sh: no stage '$stage' (day: ${stages[*]}; night: ${night[*]}; ${on_demand[*]})"; exit 2 ;;
    esac
done

mkdir -p build/ci-times
times=() failed=()
for stage in "${selected[@]}"; do
    echo "== $stage"
    started=$SECONDS
    truncate -s 0 "$PERCALE_COMPILE_TIMES" "$waited"
    find build/ci-* -path build/ci-faults -prune -o -name CTestCostData.txt -exec rm {} +
    (set -e; "stage_$stage") </dev/null
    status=$?
    passed="$((SECONDS - started)) s: $(compiled) s compiling, $((SECONDS - started - $(compiled))) s running"
    times+=("$stage $passed")
    report_slowest
    if [ $status -eq 0 ]; then
        echo "== $stage passed in $passed"
        continue
    fi
    echo "check.sh: stage $stage FAILED after $passed (exit code $status)"
    case " ${night[*]} " in *" $stage "*) failed+=("$stage") ;; *) exit 1 ;; esac   # by night the others are as much worth
done
if [ ${#failed[@]} -gt 0 ]; then
    echo "check.sh: FAILED: ${failed[*]}, of ${selected[*]}"
    printf '   %s\n' "${times[@]}"
    exit 1
fi
echo "check.sh: all stages passed in $SECONDS s"
printf '   %s\n' "${times[@]}"
# The closing lines of the whole test suite come last.
case " ${selected[*]} " in *" release "*) echo "whole test suite (stage release):" && sed -n '/% tests passed/,$p' "$release_copy/../test.log" ;; esac
