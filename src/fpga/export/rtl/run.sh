#!/bin/sh
# Compiles the testbench that fits a folder of vectors and runs it.
#
#   sh run.sh [VECTOR_FOLDER] [+PLUSARG]...
#
# The folder (default: the one of this script) holds params.vh and the vectors. Runs from
# anywhere, writes only to a temporary folder. Plusargs go to the testbench: +GAP=5 +GAP_SEED=1,
# +WITHDRAW, +VCD=wave.vcd +VCD_FIRST=10 +VCD_SAMPLES=3 (list: tb_rls.v).
#
# Environment:
#   SIM=iverilog|verilator   simulator, default iverilog (11 or newer; Verilator 5.006 or newer)
#   DIV_LATENCY=n            a divider of n clocks instead of one; the words must not change
#   BLACK_BOX=1              compares only output words and clocks: for a core of your own
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
if ! command -v "$sim" > /dev/null 2>&1; then
    echo "run.sh: simulator not found: $sim" >&2
    exit 127
fi

# A value given here wins over the one in tb_defaults.vh.
set -- "+VEC_DIR=$vectors" "$@"
defines=
if [ -n "${DIV_LATENCY-}" ]; then defines="$defines -DVEC_DIV_LATENCY=$DIV_LATENCY"; fi
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
cd "$here"
sources="tb_$filter.v ${CORE:-${filter}_core.v ${filter}_ctrl.v sp_ram.v fp_sim.v}"
status=0
case "$sim" in
    *iverilog)
        # Generated words, not options: $defines and $sources are split on purpose.
        # shellcheck disable=SC2086
        "$sim" -g2012 -Wall -Wno-timescale -I "$vectors" -I . $defines -s "tb_$filter" \
            -o "$build/tb" $sources
        cd "$caller"
        vvp -n "$build/tb" "$@" || status=$? ;;
    *verilator)
        # shellcheck disable=SC2086
        if ! "$sim" --binary --timing $trace -Wno-fatal -Wno-lint -Wno-style -I"$vectors" -I. \
            -CFLAGS -ffp-contract=off \
            $defines --top-module "tb_$filter" --Mdir "$build/obj" -o tb $sources \
            > "$build/log" 2>&1; then
            cat "$build/log" >&2
            exit 1
        fi
        cd "$caller"
        "$build/obj/tb" "$@" || status=$? ;;
    *)  echo "run.sh: SIM has to be iverilog or verilator, not $sim" >&2
        exit 2 ;;
esac
# A simulator killed by an assertion ends with 134 and the like: one code for all of them.
if [ "$status" -ne 0 ]; then exit 1; fi
