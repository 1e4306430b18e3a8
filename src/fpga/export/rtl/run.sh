#!/bin/sh
# Runs the self-checking testbench of this folder; ends non-zero at the first difference.
#   sh run.sh              Icarus Verilog (11 or newer)
#   sh run.sh verilator    Verilator (5.006 or newer)
# Further arguments go to the simulation, for example +WAVES for simulated.vcd.
set -eu
dir=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
if [ -f "$dir/tb_rls.v" ]; then kind=rls; else kind=lms; fi
sources="$dir/tb_$kind.v $dir/${kind}_core.v $dir/${kind}_ctrl.v $dir/ram_sp.v $dir/fp_sim.v"
simulator=icarus
if [ "${1:-}" = verilator ]; then
    simulator=verilator
    shift
fi
build="$dir/build"
mkdir -p "$build"
case $simulator in
icarus)
    # shellcheck disable=SC2086
    iverilog -g2012 -I "$dir" -s "tb_$kind" -o "$build/tb.vvp" $sources
    exec vvp -n "$build/tb.vvp" "+VEC_DIR=$dir" "$@"
    ;;
verilator)
    # The C++ compiler must not contract a*b+c into one rounding.
    # shellcheck disable=SC2086
    verilator --binary --timing -O3 -Wno-fatal -Wno-lint -Wno-style -I"$dir" \
        -CFLAGS -ffp-contract=off --top-module "tb_$kind" --Mdir "$build/verilated" \
        $sources >"$build/verilator.log" 2>&1 || { cat "$build/verilator.log"; exit 1; }
    exec "$build/verilated/Vtb_$kind" "+VEC_DIR=$dir" "$@"
    ;;
esac
