#!/bin/sh
# SPDX-License-Identifier: MIT
# From a machine with a shell and apt to whatever the project makes: see usage().
# shellcheck disable=SC2086 # lists of packages and commands are split into words on purpose
set -eu

usage() {
    cat <<'EOF'
usage: sh cmake/bootstrap.sh COMMAND [OPTION ...]

  run        collide 20,000 bodies; shapes, contacts and pictures go to out/
  test       one build and its tests, minutes; with NARC_TEST_PRESET=ci warnings are errors
  gate       what a change must pass besides: style, long tests, the applications, benchmarks that run, without
             dependencies, sanitizers, fuzzing, under qemu NEON and a big-endian processor, and words of 32 bits on
             WebAssembly. It goes on in the build of NARC_TEST_PRESET=ci
  platforms  the tests on every platform but this one: NEON, 32-bit x86 and ARM, s390x, RISC-V and POWER under qemu,
             WebAssembly in node, Windows under wine; and narc as a subproject of meson
  fuzz       the fuzzing programs of tests/fuzz on their seeds, and on for 60 seconds each, or as many as the option says
  soak       pairs of all families beside the reference, and all queries beside scalar, seed after seed, until it is
             interrupted, or for as many seconds as the option says
  coverage   which lines of soa, kernels and dispatch the tests run, and which they do not
  bench      the kernels and what a scene is asked, beside Box2D 3 if it is installed, libccd and GEOS; results go to out/.
             Options are Google Benchmark's and those of bench/README.md
  paper      the paper's evaluation; tables and plots go to out/. Options are those of bench/paper/README.md
  fit-study  the paper's study of goodness of fit; tables and pictures go to out/
  lammps     LAMMPS with grains that are arc shapes, over MPI: its tests, and a biaxial compression on 1 and 2 ranks, which
             goes to out/lammps/
  dem        a pile of 5,000 sand grains with the discrete element program: pictures, files for ParaView, tables and the
             angle of repose go to out/dem/, in 11 minutes of processor time. dem cases: piles of discs and long grains,
             a gas, packings, simple shear, hoppers besides. apps/dem/README.md says what they mean
  python     the Python package: a wheel and pictures of its examples in out/python/, installed into the environment
             build/python and tested
  bench-web  the example's engine in WebAssembly beside Rapier, Box2D 3, Planck, Matter and detect-collisions from npm, in node:
             out/bench-web.md. Options are those of bindings/web/bench/bench.mjs
  web        the package for JavaScript, in out/web/, and its page: built, tested in node and in Chromium. web --serve shows the
             page on 127.0.0.1
  docs       the reference of the public headers, out/api/index.html

Each command installs what is missing and builds what it needs.
Installs Debian and Ubuntu packages with apt-get, as root or through sudo, and nothing if all are there.
EOF
}

begin=$(date +%s)
say() { printf '\n== %s (after %d s)\n' "$*" $(($(date +%s) - begin)); }
fail() {
    printf 'bootstrap: %s\n' "$*" >&2
    exit 1
}

cd "$(dirname "$0")/.."
jobs=$(nproc 2>/dev/null || echo 2)
# A folder that was built by another generator keeps it.
export CMAKE_BUILD_PARALLEL_LEVEL="$jobs" CTEST_PARALLEL_LEVEL="$jobs" CMAKE_GENERATOR=Ninja

# ---------------------------------------------------------------------------- packages
library_packages="gcc libc6-dev ninja-build cmake pkg-config libsleef-dev"
fit_packages="g++ libfreetype-dev librsvg2-dev libdxflib-dev libpng-dev libcjson-dev"
build_packages="$library_packages $fit_packages libcairo2-dev libglib2.0-dev libcmocka-dev"
run_packages="$build_packages fonts-symbola"
peer_packages="g++ libbenchmark-dev libccd-dev libgeos-dev"
test_packages="$run_packages g++ binutils python3-dev python3-numpy python3-pytest python3-hypothesis python3-shapely python3-ezdxf
    python3-jsonschema dpkg-dev file meson"
gate_packages="$test_packages $peer_packages clang libomp-dev clang-format clang-tidy valgrind"
bench_packages="$library_packages $peer_packages gnuplot-nox"
study_packages="$run_packages openclipart-svg r-cran-shapes gnuplot-nox"
lammps_packages="$run_packages g++ liblammps-dev libopenmpi-dev openmpi-bin python3 python3-numpy"
wasm_packages="$library_packages binaryen clang llvm lld wasi-libc libclang-rt-dev-wasm32 nodejs"
windows_packages="$run_packages gcc-mingw-w64-x86-64-posix g++-mingw-w64-x86-64-posix libz-mingw-w64-dev dpkg-dev wine64"
python_packages="$library_packages $fit_packages python3-dev python3-venv python3-setuptools python3-wheel python3-numpy python3-pytest \
    python3-hypothesis python3-shapely python3-matplotlib mypy"
web_packages="$library_packages binaryen clang llvm lld wasi-libc libclang-rt-dev-wasm32 nodejs chromium"
dem_packages="$run_packages r-cran-shapes python3 python3-numpy python3-matplotlib"

missing_of() {
    for package; do
        case $(dpkg-query -W -f '${db:Status-Abbrev} ' "$package" 2>/dev/null) in
        *ii*) ;;
        *) printf ' %s' "$package" ;;
        esac
    done
}

# Installs those of the named packages that are missing; false if that fails.
install_packages() {
    missing=$(missing_of "$@")
    [ -n "$missing" ] || return 0
    say "installing:$missing"
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        as_root=sudo
        if ! command -v sudo >/dev/null; then
            echo "bootstrap: to install packages, run this as root or install sudo" >&2
            return 1
        fi
    fi
    # One broken source among several makes the update fail; whether that matters, the installation shows.
    # Another program may have apt's lock, as a new machine's own updates do: minutes.
    apt="env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600"
    $as_root $apt update || true
    $as_root $apt install -y --no-install-recommends $missing
}

# Whether all of them are among this machine's package sources. What is there and does not come is a failure.
optional_packages() {
    install_packages "$@" && return 0
    for package in $missing; do
        [ -n "$(apt-cache madison "$package")" ] || return 1
    done
    fail "these packages could not be installed:$missing"
}

require_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "bootstrap: not Debian or Ubuntu. Install what these packages hold, then use the CMake presets:" >&2
        printf '  %s\n' "$@" >&2
        exit 2
    fi
    install_packages "$@" || fail "these packages could not be installed:$missing"
}

# Libraries of another processor, by Debian's name of it, are unpacked in build/packages, from package lists of their own:
# the system does not change. False if no source has them.
fetch_libraries() {
    foreign=$1
    shift
    [ ! -e "build/packages/$foreign/complete" ] || return 0
    rm -rf "build/packages/$foreign" "build/packages/$foreign-apt"
    mkdir -p "build/packages/$foreign" "build/packages/$foreign-apt/lists/partial" \
        "build/packages/$foreign-apt/archives/partial"
    (
        cd "build/packages/$foreign-apt"
        foreign_apt="-q -o APT::Architecture=$foreign -o APT::Architectures=$foreign \
            -o APT::Sandbox::User=root -o Dir::State::lists=$PWD/lists -o Dir::Cache=$PWD"
        apt-get $foreign_apt update || true # a source without this processor may make this fail
        ls lists/*Release >/dev/null 2>&1 || fail "no package source answers"
        for package; do
            [ -n "$(apt-cache $foreign_apt madison "$package")" ] || exit 3
        done
        apt-get $foreign_apt download "$@" || fail "these packages could not be downloaded: $*"
        for package in *.deb; do dpkg-deb -x "$package" "../$foreign" || fail "$package cannot be unpacked"; done
        touch "../$foreign/complete"
    ) || { [ $? -eq 3 ] || exit 1; return 1; }
}

# ---------------------------------------------------------------------------- steps
# build takes a preset and targets, check a preset and a command to go in front of ctest, check_some other targets besides.
build() {
    preset=$1
    shift
    say "build/$preset"
    cmake --preset "$preset" || fail "configuring build/$preset failed"
    cmake --build --preset "$preset" --target "$@" || fail "building build/$preset failed"
}

check() {
    build "$1" all
    ${2:-} ctest --preset "$1" || fail "tests failed in build/$1"
}

# The same, where the preset's tests, or those that options of ctest choose, are few: their programs alone are built. CMake's
# lists of tests know them.
check_some() {
    say "build/$1"
    cmake --preset "$1" || fail "configuring build/$1 failed"
    cmake --build --preset "$1" --target $({ ctest --preset "$1" ${4:-} -N | sed -n 's/^ *Test *#[0-9]*: \([^ ]*\).*/\1/p'
        find "build/$1" -name CTestTestfile.cmake -exec \
            sed -n 's|^add_test(\[=\[\(.*\)\]=\].*/\(test_[a-z0-9_]*\)[.wasm]*".*|\1 \2|p' {} +
    } | awk 'NF == 1 { named[$1] } NF == 2 && $1 in named { print $2 }' | sort -u) ${3:-} || fail "building build/$1 failed"
    ${2:-} ctest --preset "$1" ${4:-} || fail "tests failed in build/$1"
}

# Tests on another processor: the preset, the compiler's package, Debian's name of the processor, libraries. Where they
# can't be had that is noted in `skipped`.
check_foreign() {
    preset=$1 tools="$2 libc6-dev-$3-cross qemu-user" processor=$3
    shift 3
    if optional_packages $tools && { [ $# -eq 0 ] || fetch_libraries "$processor" "$@"; }; then
        check_some "$preset"
    else
        skipped="$skipped; $preset SKIPPED: no compiler, qemu or libraries from this machine's package sources"
    fi
}

# NEON, and the other order of bytes.
check_processors() {
    case $(uname -m) in
    aarch64 | arm64) ;; # NEON is what all other tests ran
    *) check_foreign aarch64 gcc-aarch64-linux-gnu arm64 libsleef-dev libsleef3 libcmocka-dev libcmocka0 ;;
    esac
    check_foreign s390x gcc-s390x-linux-gnu s390x libcmocka-dev libcmocka0
}

# What has words of 32 bits, and what of bindings/web needs no npm: its modules, and the page's engine, whose bits are those of
# build/bare.
check_modules() {
    check_some "$1" "" "narc_module narc_threads narc_small narc_page" "-L portable"
    node bindings/web/tests/engine.mjs "build/$1/page.wasm" build/bare/tests/examples/example_world || fail "the page's engine is not as it should be"
}

# WebAssembly, by check or check_modules.
check_wasm() {
    if optional_packages $wasm_packages; then
        $1 wasm32
    else
        skipped="$skipped; wasm32 SKIPPED: not among this machine's packages"
    fi
}

# The command on Windows writes the same bytes as here, where poses are made by the same sines.
check_windows() {
    mkdir -p build/packages
    if ! optional_packages $windows_packages; then
        skipped="$skipped; mingw64 SKIPPED: not among this machine's packages"
    elif ! sh cmake/mingw64.sh >build/packages/mingw64.log 2>&1; then
        skipped="$skipped; mingw64 SKIPPED: its libraries could not be built, see build/packages/mingw64.log"
    else
        export WINEPREFIX="$PWD/build/wine" WINEDEBUG=-all
        wine=/usr/lib/wine/wine64
        $wine wineboot >/dev/null 2>&1 || true # tests that run at once would all set its folder up
        check mingw64
        say "build/windows"
        rm -rf build/windows
        cpack --config build/mingw64/CPackConfig.cmake -B build/windows || fail "packing build/mingw64 failed"
        (cd build/windows && cmake -E tar xf narc-*.zip)
        cmake --preset release -B build/plain -DNARC_SLEEF=OFF -DNARC_BUILD_TESTS=OFF
        cmake --build build/plain --target narc_tool
        make_scene build/plain/tools/narc out/here
        LC_ALL=C.UTF-8 make_scene "$wine $(echo build/windows/narc-*/bin/narc.exe)" out/windows
        for name in shapes.json bodies.csv contacts.csv; do
            cmp out/here/$name out/windows/$name || fail "the command on Windows writes other bytes"
        done
    fi
}

platforms() {
    require_packages $test_packages
    build release all
    ctest --preset release -R '^package_meson' || fail "tests failed in build/release"
    skipped=
    check_processors
    check_foreign i686 gcc-i686-linux-gnu i386 libcmocka-dev libcmocka0
    check_foreign riscv64 gcc-riscv64-linux-gnu riscv64
    check_foreign ppc64le gcc-powerpc64le-linux-gnu ppc64el
    check_foreign armhf gcc-arm-linux-gnueabihf armhf
    check_wasm check
    check_windows
    say "all tests passed$skipped"
}

# make_scene NARC FOLDER: the command may be several words.
make_scene() {
    narc=$1 out=$2
    font=$(dpkg -L fonts-symbola | grep -i -m 1 '\.[ot]tf$') || fail "fonts-symbola has no font file"
    mkdir -p "$out"
    say "shapes"
    $narc fit "$font" --characters '👻🏠🚀🌳' --arcs 8 --out "$out/shapes.json" --picture "$out/shapes.png"
    say "scene"
    $narc scene --shapes "$out/shapes.json" --bodies 20000 --density 0.25 --seed 1 --out "$out/bodies.csv"
    say "collide"
    $narc collide --shapes "$out/shapes.json" --bodies "$out/bodies.csv" --out "$out/contacts.csv" \
        --picture "$out/collisions.png"
}

run() {
    require_packages $run_packages
    build release narc_tool
    make_scene build/release/tools/narc out
    say "written"
    ls -l out/shapes.json out/shapes.png out/bodies.csv out/contacts.csv out/collisions.png
}

# Each row several times, in random order with all others, so that what else the machine does hits them all alike. Without
# a filter a run for each subject, since scenes of a million bodies in all libraries do not lie in memory together.
bench() {
    require_packages $bench_packages
    build bench bench_narc
    mkdir -p out
    rm -f out/bench.md out/bench-*.json out/arcs.dat out/bench-arcs.svg
    case "$*" in
    *--benchmark_filter=*) bench_rows asked "$@" ;;
    *)
        bench_rows pairs --benchmark_filter='^(overlap|contact|manifold|boxes|pairs|plain|stay|worlds)' "$@"
        bench_rows rays --benchmark_filter='^ray' "$@"
        bench_rows regions --benchmark_filter='^region' "$@"
        bench_rows points --benchmark_filter='^(nearest|distance|inside|named)' "$@"
        bench_rows outlines --benchmark_filter='^(hull|polyline)' "$@"
        bench_rows index --benchmark_filter='^(index|move|impact|ground)' "$@"
        ;;
    esac
    say "plot"
    gnuplot -e "folder='out'" bench/plots.gp
    say "written"
    ls -l out/bench*
}

bench_rows() {
    name=$1
    shift
    say "benchmarks: $name"
    build/bench/bench/bench_narc --benchmark_repetitions=9 --benchmark_enable_random_interleaving=true \
        --benchmark_min_time=0.1 --benchmark_out="out/bench-$name.json" --benchmark_out_format=json --out=out "$@"
}

paper() {
    require_packages $bench_packages
    build bench bench_paper
    mkdir -p out
    rm -f out/paper*
    say "the paper's evaluation"
    build/bench/bench/paper/bench_paper --out=out "$@"
    say "plots"
    gnuplot -e "folder='out'" bench/paper/plots.gp
    say "written"
    ls -l out/paper*
}

fit_study() {
    require_packages $study_packages
    build release fit_study parts_study
    font=$(dpkg -L fonts-symbola | grep -i -m 1 '\.[ot]tf$') || fail "fonts-symbola has no font file"
    drawings=$(dpkg -L openclipart-svg | grep -m 1 '/svg$') || fail "openclipart-svg has no folder svg"
    sand=$(dpkg -L r-cran-shapes | grep -m 1 '/sand\.rda$') || fail "r-cran-shapes has no file sand.rda"
    rm -rf out/fit-* out/grains
    mkdir -p out/grains
    say "sand grains"
    Rscript --vanilla bench/fit_study/grains.R "$sand" out/grains
    say "the paper's study of goodness of fit"
    build/release/bench/fit_study/fit_study --font="$font" --drawings="$drawings" \
        --grains=out/grains --out=out
    say "200 drawings as convex parts"
    build/release/bench/fit_study/parts_study 0.02 \
        $(find "$drawings" -name '*.svg' | LC_ALL=C sort | awk 'NR % 40 == 7' | head -200) >out/fit-parts.txt
    tail -n 4 out/fit-parts.txt
    say "plot"
    gnuplot -e "folder='out'" bench/fit_study/plots.gp
    say "written"
    ls -l out/fit-*
}

# The package of a preset's build, build/installed, on which the applications are built: projects of their own.
install_package() {
    build "$1" narc_tool narc_static narc_files_static narc_methods_static
    cmake --install "build/$1" --prefix build/installed >/dev/null || fail "installing build/$1 failed"
}

# build_app APP FOLDER OPTION...: one of apps/, in build/FOLDER; and its tests, with options of ctest.
build_app() {
    app=$1 folder=$2
    shift 2
    say "build/$folder"
    cmake -S "apps/$app" -B "build/$folder" -DCMAKE_PREFIX_PATH="$PWD/build/installed" -DNARC_WERROR=ON "$@" ||
        fail "configuring build/$folder failed"
    cmake --build "build/$folder" || fail "building build/$folder failed"
}

test_app() {
    folder=$1
    shift
    ctest --test-dir "build/$folder" --no-tests=error --output-on-failure "$@" || fail "tests failed in build/$folder"
}

# With the flags of the sanitizers' build. The long tests are plain arithmetic.
test_dem_with_sanitizers() {
    build_app dem dem-asan -DCMAKE_BUILD_TYPE=Debug \
        "-DCMAKE_C_FLAGS=$(sed -n 's/^CMAKE_C_FLAGS:[A-Z]*=//p' build/asan/CMakeCache.txt)"
    ASAN_OPTIONS=detect_stack_use_after_return=1:handle_sigill=2 test_app dem-asan -LE slow
}

# More ranks than cores are fine for tests. Options are ctest's.
test_lammps() {
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 \
        OMP_NUM_THREADS=1
    build_app lammps lammps
    test_app lammps "$@"
}

# The largest difference of numbers in two dumps, which is at most 1e-6 of a grain's diameter.
compare_dumps() {
    awk 'NR == FNR { line[FNR] = $0; next }
        { if (split(line[FNR], other) != NF) most = 1
          for (i = 1; i <= NF; i++) { d = $i - other[i]; if (d < 0) d = -d; if (d > most) most = d } }
        END { printf "largest difference: %g\n", most; exit !(FNR > 1000 && most <= 1e-6) }' "$1" "$2"
}

# The force that grains and walls exert on each other in all, beside forces of some 1000: columns 5 and 6 of the log.
check_momentum() {
    awk '/^Loop/ { rows = 0 }
        rows { for (i = 5; i <= 6; i++) { d = $i < 0 ? -$i : $i; if (d > most) most = d } seen++ }
        /^Step/ { rows = 1 }
        END { printf "largest force out of nothing: %g\n", most; exit !(seen > 1 && most <= 1e-9) }' "$1"
}

lammps() {
    require_packages $lammps_packages
    install_package release
    test_lammps
    rm -rf out/lammps
    mkdir -p out/lammps
    say "a packing of some thousand 8-arcs"
    (
        cd out/lammps
        inputs=../../apps/lammps
        program=../../build/lammps/narc_lammps
        mpirun -np 1 $program -in $inputs/prepare.in -var shapes $inputs/grains.json -log prepare.log
        for ranks in 1 2; do
            say "its biaxial compression, ranks: $ranks"
            mpirun -np $ranks $program -in $inputs/biaxial.in -var shapes $inputs/grains.json -var steps 1000 \
                -var every 500 -var out biaxial-$ranks -log biaxial-$ranks.log
        done
        say "the same on 1 rank and on 2?"
        compare_dumps biaxial-1.dump biaxial-2.dump
        check_momentum biaxial-1.log
        check_momentum biaxial-2.log
    ) || fail "the compression failed"
    say "written"
    ls -l out/lammps
}

# The outlines of sand grains, as arc shapes: out/dem/sand.json.
fit_sand() {
    sand=$(dpkg -L r-cran-shapes | grep -m 1 '/sand\.rda$') || fail "r-cran-shapes has no file sand.rda"
    mkdir -p out/dem/grains
    say "sand grains"
    Rscript --vanilla bench/fit_study/grains.R "$sand" out/dem/grains
    build/release/tools/narc fit out/dem/grains/*.csv --approximate --arcs 8 --objective distance \
        --out out/dem/sand.json --picture out/dem/sand.png
}

# The pile alone, or all cases, as many runs at a time as there are processors. The command draws the grains that a run
# has written.
dem() {
    require_packages $dem_packages
    install_package release
    build_app dem dem -DNARC_BUILD_TESTS=OFF
    case ${1:-pile} in
    pile | cases) rm -rf out/dem && mkdir -p out && fit_sand ;;
    *) fail "dem $1: it is pile or cases" ;;
    esac
    [ "${1:-pile}" = pile ] && which=sand || which=all
    say "cases ($which): $([ $which = sand ] && echo '11 minutes' || echo 'half an hour') of processor time"
    # Debian's Python has its packages.
    /usr/bin/python3 apps/dem/cases/cases.py build/dem/dem out/dem --sand out/dem/sand.json --jobs "$jobs" \
        $which | tee out/dem/results.txt
    build/release/tools/narc collide --shapes out/dem/pile/shapes.json --out out/dem/contacts.csv \
        --picture out/dem/grains.png --bodies "$(find out/dem/pile -name 'pile-0*.csv' | sort | tail -n 1)"
    ls -ld out/dem/*
}

# Of what is random a fifth of the trials, where all would take minutes more: these are for who changes a kernel.
few_trials=0.2

# One build, the one that users have, and what answers in minutes; the gate has the rest. Or another preset's.
test_build() {
    export OMP_WAIT_POLICY=passive # several tests run at once: who waits must not keep the processors from others
    slow='slow|bench'
    case $1 in
    ci)
        require_packages $gate_packages
        export NARC_TEST_TRIALS="$few_trials"
        slow='slow|bench|quick'
        ;;
    *) require_packages $test_packages ;;
    esac
    build "$1" all
    ctest --preset "$1" -LE "$slow" || fail "tests failed in build/$1"
}

check_style() {
    say "style"
    git ls-files '*.c' '*.h' '*.inl' '*.cc' '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror || fail "run clang-format"
    # The compilation database of the build with everything in it, each file once, for AVX2 if it is compiled for several
    # instruction sets, and that of apps/dem. The test of what is installed has builds of its own; what is for other
    # systems and libraries is in none here.
    mkdir -p build/tidy
    python3 -c 'import json, sys
commands = json.load(sys.stdin)
once = {command["file"]: command for command in commands}
once.update({command["file"]: command for command in commands if "_avx2.dir" in command["command"]})
json.dump(list(once.values()), sys.stdout)' <build/ci/compile_commands.json >build/tidy/compile_commands.json ||
        fail "build/ci has no compilation database"
    git ls-files 'soa/*.c' 'kernels/*.c' 'dispatch/*.c' 'methods/*.c' 'files/*.c' 'fit/*.c' 'tools/*.c' 'examples/*.c' 'bench/*.c' 'tests/*.c' 'bindings/*.c' \
        ':!tests/package' ':!tests/fuzz' ':!*_windows.c' ':!*peers/box2d.c' ':!*/wasm_*.c' ':!bindings/web' |
        xargs -P "$jobs" -n 8 clang-tidy --quiet -p build/tidy || fail "clang-tidy has something to say"
    git ls-files 'apps/*.c' | xargs -P "$jobs" -n 8 clang-tidy --quiet -p build/dem || fail "clang-tidy has something to say"
}

# What of the gate waits for a network or for messages, or goes on with one thing at a time, is done beside the rest.
gate_beside() {
    # What these libraries do for the kernels is the same on each instruction set: plain C is built. Other processors
    # test it, without these libraries too.
    cmake --preset bare -DNARC_COMPILES_avx512=OFF -DNARC_COMPILES_avx2=OFF -DNARC_COMPILES_sse41=OFF ||
        fail "configuring build/bare failed"
    check_some bare "" "narc narc_static narc_methods narc_methods_static example_world"
    skipped=
    if optional_packages $lammps_packages; then
        test_lammps -LE slow
    else
        skipped="; LAMMPS SKIPPED: not among this machine's packages"
    fi
    check_processors
    check_wasm check_modules
    say "other processors, LAMMPS and what is without libraries passed$skipped"
    echo "$skipped" >build/skipped
}

# Ends it, with all that it has started: what runs in the background does not hear Ctrl-C.
end_beside() {
    kill $(cat /proc/[0-9]*/stat 2>/dev/null | sed 's/ (.*) / /' | awk -v top="$beside" '{ parent[$1] = $3 }
        END { for (one in parent) { for (up = one; up && up != top;) up = parent[up]; if (up) print one } }') 2>/dev/null
}

gate() {
    export OMP_WAIT_POLICY=passive
    require_packages $gate_packages
    require_sanitizers # before there are two that install packages
    build ci all
    install_package ci
    (gate_beside) >build/beside.log 2>&1 &
    beside=$!
    trap end_beside EXIT
    trap 'exit 1' INT TERM HUP
    build_app dem dem -DNARC_BUILD_TESTS=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
    check_style
    test_app dem -E '^dem_case_(pile|hopper|shear)$' # `dem cases` has them at full length
    # With so few trials the kernels' are those that the first half has run.
    NARC_TEST_TRIALS="$few_trials" ctest --preset ci -L 'slow|bench' \
        -E '^(package_meson_subproject|(broad_phase|rays|casts|thin_bodies|follow|ground_casts)_all)$' || fail "tests failed in build/ci"
    check_some asan "" "narc_tool example_world $([ ! -d build/ci/bindings/python/narc ] || echo python_modules)" # new enough a Python
    test_dem_with_sanitizers
    # Thread sanitizer of older compilers wants a fixed address layout, where setting it is allowed.
    fixed=$(setarch "$(uname -m)" -R true 2>/dev/null && echo "setarch $(uname -m) -R") || fixed=
    check_some tsan "$fixed"
    wait $beside && beside_passed=1 || beside_passed=
    trap - EXIT INT TERM HUP
    cat build/beside.log
    [ "$beside_passed" ] || fail "what is done beside the rest failed"
    fuzz 4 1 "$fixed" # alone, for it counts seconds; addresses, which fuzzers learn from, alike from run to run
    say "all tests passed$(cat build/skipped)"
}

# Some releases pack clang's sanitizers apart from clang.
require_sanitizers() {
    mkdir -p build
    echo 'int main(void) { return 0; }' | clang -fsanitize=thread -x c - -o build/probe 2>/dev/null ||
        require_packages libclang-rt-dev
}

# Seconds for each, the seed of random numbers, and a command to run them by; see tests/fuzz/CMakeLists.txt.
fuzz() {
    require_packages $test_packages clang clang-tidy
    require_sanitizers
    build fuzz fuzz
    clang-tidy --quiet -p build/fuzz tests/fuzz/*.c || fail "clang-tidy has something to say"
    NARC_FUZZ_SECONDS=$1 NARC_FUZZ_SEED=$2 ${3:-} ctest --preset fuzz || fail "a fuzzing program found something: build/fuzz/tests/fuzz/*-crash-*"
}

# From other random numbers each time.
soak() {
    require_packages $test_packages
    build release test_pairs test_everything
    seed=${NARC_TEST_SEED:-$(date +%s)} end=$(($(date +%s) + ${1:-1000000000}))
    while [ "$(date +%s)" -lt "$end" ]; do
        for program in pairs everything; do
            NARC_TEST_SEED=$seed "build/release/tests/kernels/test_$program" || fail "NARC_TEST_SEED=$seed"
        done
        seed=$((seed + 1))
    done
}

# What the tests of the library run of it, with a tenth of the trials.
coverage() {
    require_packages $test_packages gcovr
    build coverage all
    find build/coverage -name '*.gcda' -delete
    ctest --preset coverage || fail "tests failed in build/coverage"
    gcovr --root . --object-directory build/coverage --filter 'soa/|kernels/|dispatch/' build/coverage
}

# In an environment that has Debian's packages and nothing from a network; installed, the wheel needs NumPy alone.
make_wheel() {
    require_packages $python_packages
    rm -rf out/python build/wheel
    mkdir -p out/python
    say "build/python"
    /usr/bin/python3 -m venv --system-site-packages build/python || fail "making build/python failed"
    pip="build/python/bin/python -m pip --disable-pip-version-check --no-input"
    $pip wheel --no-index --no-build-isolation --no-deps -w out/python bindings/python || fail "building the wheel failed"
    $pip install --no-index --no-deps --force-reinstall out/python/narc-*-cp311-abi3-*.whl || fail "installing the wheel failed"
    say "its tests"
    env -i PATH=/nowhere build/python/bin/python -m narc || fail "the package does not run without a compiler"
    build/python/bin/python -m pytest -q -p no:cacheprovider bindings/python/tests || fail "tests failed in build/python"
    (cd bindings/python && mypy --cache-dir ../../build/mypy narc) || fail "mypy has something to say"
    say "examples"
    for example in dem drawing lidar packing worlds; do
        build/python/bin/python bindings/python/examples/$example.py out/python/$example.png || fail "$example.py failed"
    done
    build/python/bin/python -m narc pages out/python/pages || fail "writing help pages failed"
    say "written"
    ls -l out/python
}

# npm_packages FOLDER WHERE: those of a lockfile, for a build, its tests or benchmarks alone.
npm_packages() {
    command -v npm >/dev/null || require_packages npm
    mkdir -p "$2"
    cmp -s "$1/package-lock.json" "$2/installed.json" && return
    cp "$1/package.json" "$1/package-lock.json" "$2"
    npm ci --prefix "$2" --no-audit --no-fund || fail "npm does not have the packages of $1"
    cp "$1/package-lock.json" "$2/installed.json"
}

# The package, packed in out/web, and the page, out/web/page.
make_web() {
    require_packages $web_packages
    build wasm32 narc_module narc_threads narc_small narc_layouts narc_page
    say "build/web"
    npm_packages bindings/web/tools build/web-tools
    rm -rf build/web out/web
    mkdir -p build/web out/web
    cp -r bindings/web/src bindings/web/tests bindings/web/page bindings/web/tsconfig.json build/web
    node --no-warnings cmake/wasi.mjs build/wasm32/narc_layouts.wasm | node bindings/web/src/layouts.mjs >build/web/src/layouts.ts ||
        fail "making the table of layouts failed"
    tsc="node build/web-tools/node_modules/typescript/bin/tsc"
    $tsc -p build/web || fail "compiling bindings/web failed"
    version=$(sed -n 's/^export const version = "\(.*\)";/\1/p' build/web/src/layouts.ts)
    sed "s/\"0.0.0\"/\"$version\"/" bindings/web/package.json >build/web/package/package.json
    cp build/wasm32/narc.wasm build/wasm32/narc_threads.wasm build/wasm32/narc_small.wasm bindings/web/README.md LICENSE build/web/package
    (cd build/web/package && npm pack --silent --pack-destination ../../../out/web) || fail "npm pack failed"
    mkdir -p out/web/page/narc
    cp build/web/page/*.html build/web/page/*.css build/web/page/*.js build/wasm32/page.wasm out/web/page
    cp build/web/package/*.js build/web/package/*.wasm out/web/page/narc
}

bench_web() {
    make_web
    npm_packages bindings/web/bench build/web-bench
    node bindings/web/bench/bench.mjs build/web-bench build/web/package out/web/page out "$@" || fail "the engines could not be compared"
    say "written: out/bench-web.md"
}

web() {
    make_web
    if [ "${1:-}" = --serve ]; then
        node bindings/web/tests/serve.mjs out/web/page
        return
    fi
    say "its tests"
    $tsc -p build/web/tests || fail "the types are not as they should be"
    node --expose-gc --test build/web/tests/module.test.mjs || fail "tests failed in build/web"
    # Poses by the same sines as there: without SLEEF.
    cmake -B build/native -DCMAKE_BUILD_TYPE=Release -DNARC_SLEEF=OFF -DNARC_OPENMP=OFF -DNARC_BUILD_FILES=OFF \
        -DNARC_BUILD_FIT=OFF -DNARC_BUILD_METHODS=OFF -DNARC_BUILD_TOOLS=OFF -DNARC_BUILD_TESTS=OFF || fail "configuring build/native failed"
    cmake --build build/native --target narc_static || fail "building build/native failed"
    cc -O2 -ffp-contract=off -Iinclude -Iexamples examples/world*.c examples/scenes.c -o build/native/world \
        build/native/libnarc.a -lm || fail "building build/native/world failed"
    node bindings/web/tests/page.mjs out/web/page build/web-tools out/web build/native/world || fail "the page is not as it should be"
    say "written"
    ls -l out/web
}

reference() {
    require_packages doxygen
    rm -rf out/api
    mkdir -p out
    doxygen docs/Doxyfile || fail "doxygen has something to say"
    say "written: out/api/index.html"
}

case ${1:-} in
run) run ;;
test) test_build "${NARC_TEST_PRESET:-release}" ;;
gate) gate ;;
platforms) platforms ;;
fuzz) fuzz "${2:-60}" 0 ;;
soak) soak "${2:-}" ;;
coverage) coverage ;;
python) make_wheel ;;
docs) reference ;;
web) web "${2:-}" ;;
bench-web)
    shift
    bench_web "$@"
    ;;
bench)
    shift
    bench "$@"
    ;;
paper)
    shift
    paper "$@"
    ;;
fit-study) fit_study ;;
lammps) lammps ;;
dem)
    shift
    dem "$@"
    ;;
*)
    usage
    case ${1:-} in -h | --help | help) exit 0 ;; *) exit 2 ;; esac
    ;;
esac
