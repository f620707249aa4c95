#!/usr/bin/env bash
# Checks the Debian packages of a build: .ci/packages.sh BUILD CONSUMER SCRATCH, called by the stage `packages` of check.sh. CONSUMER is as
# try_packages.sh wants it. As root and with debootstrap each is installed in a fresh Debian and used, from the mirror of apt's sources or
# of PERCALE_MIRROR; else, or where PERCALE_UNPACKED is set, they are unpacked and used.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$(realpath "$1") consumer=$(realpath "$2") scratch=$(realpath "$3")
parts=(development library program python together)   # the library is tried by a program that development compiles

# Who owns what, where it lies, and what Debian's own checker says. The project has no mail address, which it calls an error.
check_contents() {
    local deb names
    names=$(for deb in "$build"/*.deb; do dpkg-deb -f "$deb" Package; done | paste -s -d ' ')
    [[ "$names" =~ ^libpercale-dev\ libpercale[0-9.]+\ percale\ python3-percale$ ]] || { echo "the packages are: $names"; return 1; }
    for deb in "$build"/*.deb; do
        echo "$(dpkg-deb -f "$deb" Package Version Installed-Size | cut -d ' ' -f 2 | paste -s -d ' ') KiB installed, $(stat -c %s "$deb") bytes"
        dpkg-deb --contents "$deb" | awk '
            $2 != "root/root" || $1 !~ /^(l|[-d]rw[-x]r-[-x]r-[-x]$)/ || ($6 !~ /^\.\/usr\/(bin|include|lib|share)\// && $6 !~ /^\.\/(usr\/((bin|include|lib|share)\/)?)?$/) {
                print "wrong owner, rights or place: " $0; bad = 1 }
            END { exit bad }'
    done
    if command -v lintian >/dev/null; then
        lintian --allow-root --fail-on error --suppress-tags malformed-contact,bogus-mail-host-in-debian-changelog "$build"/*.deb
    else
        echo "(lintian is not installed: skipped)"
    fi
}

# `pip install .` in the same build, without network, into a folder.
check_pip() {
    /usr/bin/python3 -m pip install --no-index --no-build-isolation --no-deps --quiet --disable-pip-version-check --root-user-action=ignore \
        --config-settings "build-dir=$build" --target "$scratch/pip" .
    (cd "$scratch" && PYTHONPATH=$scratch/pip /usr/bin/python3 -c '
import percale, sys
assert percale.__file__.startswith(sys.argv[1]), percale.__file__
print(percale.run(sys.argv[2], overrides={"duration": 0.25}))' "$scratch/pip" "$OLDPWD/data/scenes/hang.toml")
}

# Percale's sources as a part of somebody else's tree.
check_subdirectory() {
    local engine_only folder
    for engine_only in ON OFF; do
        folder=$scratch/subdirectory-$engine_only
        cmake -S "$consumer/subdirectory" -B "$folder" -DPERCALE_SOURCE="$PWD" -DENGINE_ONLY="$engine_only" -DCMAKE_CXX_FLAGS=-O1
        cmake --build "$folder"
        ctest --test-dir "$folder" --no-tests=error --output-on-failure
    done
}

try_unpacked() {
    local deb part
    for deb in "$build"/*.deb; do
        # What it depends on is installed here; of Percale's own packages the others are unpacked, too.
        dpkg-checkbuilddeps -d "$(dpkg-deb -f "$deb" Depends | sed -E 's/libpercale[0-9.]+ \([^)]*\),? ?//')" /dev/null
        dpkg-deb -x "$deb" "$scratch/root"
    done
    for part in "${parts[@]}"; do .ci/try_packages.sh "$part" "$scratch/root" "$consumer" "$scratch/work"; done
    write_sizes "$scratch/work"
}

# in_chroot COMMAND...
in_chroot() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 chroot "$scratch/chroot" "$@"
}

# Prints where packages come from.
find_mirror() {
    local mirror=${PERCALE_MIRROR:-} release
    release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
    if [ -z "$mirror" ]; then
        mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' 'Label: Debian' "Codename: $release" | sed -n 1p)
    fi
    [ -n "$mirror" ] || {
        echo "packages.sh: apt's sources name no mirror of Debian ${release:-(of unknown release)}, or apt-get update has not read it;" \
            "set PERCALE_MIRROR to the URL of one, or PERCALE_UNPACKED=1 to go without" >&2
        return 1
    }
    echo "$mirror"
}

# fresh_chroot: the bare Debian, and what is tried in /try, which is handed from one to the next.
fresh_chroot() {
    [ ! -e "$scratch/chroot/try" ] || mv "$scratch/chroot/try" "$scratch/try"
    rm -rf "$scratch/chroot"
    cp -a "$scratch/bare" "$scratch/chroot"
    mv "$scratch/try" "$scratch/chroot/try"
}

# make_bare MIRROR
make_bare() {
    debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$scratch/bare" "$1" >"$scratch/debootstrap.log" ||
        { tail -20 "$scratch/debootstrap.log"; return 1; }
    mkdir "$scratch/try"
    cp -r "$build"/*.deb .ci/try_packages.sh "$scratch/try"
    cp -r "$consumer" "$scratch/try/consumer"
}

# Each package is tried in a Debian of its own, with what it depends on and nothing else that it might lean on; then all together.
try_in_chroot() {
    local deb name
    make_bare "$1"
    fresh_chroot
    for deb in "$build"/*.deb; do
        name=$(dpkg-deb -f "$deb" Package)
        needed_space "./$(basename "$deb") $([ "$name" != libpercale-dev ] || basename "$(echo "$build"/libpercale[0-9]*.deb)" | sed 's|^|./|')" \
            >"$scratch/needed-$name.txt"
    done
    install_packages development './libpercale*.deb g++ cmake make pkg-config'
    install_packages library './libpercale[0-9]*.deb'
    install_packages program './percale_*.deb'
    install_packages python './python3-percale_*.deb'
    install_packages together './*.deb g++ cmake make'
    write_sizes "$scratch/chroot/try/work"
    # shellcheck disable=SC2046
    in_chroot apt-get -qq purge -y $(for deb in "$build"/*.deb; do dpkg-deb -f "$deb" Package; done) >"$scratch/purge.log" 2>&1
    in_chroot find / -xdev \( -path /try -o -path /tmp \) -prune -o -iname '*percale*' -print | tee "$scratch/left_behind.txt"
    [ ! -s "$scratch/left_behind.txt" ] || { echo "the packages left these files behind"; return 1; }
}

# needed_space PACKAGES: what apt says that they and all they depend on take on the disk, while nothing of it is installed.
needed_space() {
    in_chroot sh -c "cd /try && apt-get install --assume-no --no-install-recommends $1" 2>/dev/null |
        sed -n 's/^After this operation, \(.*\) of additional disk space.*/\1/p' || true
}

# write_sizes WORK: sizes.md in SCRATCH; data/bench/cost/sizes.md is a copy of one.
write_sizes() {
    local deb name
    {
        printf '`.ci/check.sh packages`: Debian packages (amd64, g++ %s). Installed: the files alone. On a bare Debian: with all that it depends on.\n\n' \
            "$(g++ -dumpfullversion)"
        echo '| package | .deb, kB | installed, kB | on a bare Debian | depends on |'
        echo '|---|---|---|---|---|'
        for deb in "$build"/*.deb; do
            name=$(dpkg-deb -f "$deb" Package)
            echo "| \`$name\` | $(($(stat -c %s "$deb") / 1000))" \
                "| $(dpkg-deb --fsys-tarfile "$deb" | tar -tv | awk '{ sum += $3 } END { printf "%d", sum / 1000 }')" \
                "| $(cat "$scratch/needed-$name.txt" 2>/dev/null || echo -)" \
                "| $(dpkg-deb -f "$deb" Depends | sed -E 's/ \([^)]*\)//g; s/^python3, //') |"
        done
        printf '\n| file, stripped; programs are linked with static libraries | kB |\n|---|---|\n'
        awk -F '|' '{ printf "| %s | %d |\n", $1, $2 / 1000 }' "$1/sizes.txt"
    } >"$scratch/sizes.md"
    cat "$scratch/sizes.md"
}

# install_packages PART PACKAGES: in a fresh chroot, and uses them.
install_packages() {
    fresh_chroot
    in_chroot sh -c "cd /try && apt-get -qq install -y --no-install-recommends $2" >"$scratch/install-$1.log" 2>&1 ||
        { tail -20 "$scratch/install-$1.log"; return 1; }
    echo "== $1, in a Debian with $(in_chroot dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' '*percale*' | sed -n 's/^ii //p' | paste -s -d ' ')"
    in_chroot /try/try_packages.sh "$1" "" /try/consumer /try/work
}

for program in dpkg-deb dpkg-checkbuilddeps; do
    command -v "$program" >/dev/null || { echo "packages.sh: $program is missing (Debian: dpkg-dev)"; exit 1; }
done
/usr/bin/python3 -m pip --version >/dev/null 2>&1 || { echo "packages.sh: pip is missing (Debian: python3-pip)"; exit 1; }
mirror=
if [ "$(id -u)" -eq 0 ] && [ -z "${PERCALE_UNPACKED:-}" ] && command -v debootstrap >/dev/null; then mirror=$(find_mirror); fi
check_contents
check_pip
check_subdirectory
if [ -n "$mirror" ]; then try_in_chroot "$mirror"; else try_unpacked; fi
