#!/usr/bin/env bash
# Renders scene.toml and asks whether its expected image is still that of reference.exr.
#
#   check.sh            exit code 0: same; 1: different; 3: not enough samples to tell
#   check.sh --bless    makes the reference anew: 16 times the samples, another seed
#
# LAMPRAY names the program, DEVICE the device (software: Mesa's Vulkan, no GPU needed), OUT the folder
# for the picture, the map of the difference and the verdict in words.
set -euo pipefail
lampray=${LAMPRAY:-lampray}
device=${DEVICE:-software}
here=$(cd "$(dirname "$0")" && pwd)

if [ "${1:-}" = "--bless" ]; then
    "$lampray" render "$here/scene.toml" --device "$device" --samples 4096 --seed 20261122 \
        -o "$here/reference.exr"
    exit
fi

out=${OUT:-out}
mkdir -p "$out"

# A fixed seed, and not the reference's: the answer is the same every time, and the samples are others.
"$lampray" render "$here/scene.toml" --device "$device" --seed 1 -o "$out/new.exr" -o "$out/new.png"
# One false alarm in a thousand changes of the seed; differences of the mean below 1 % may pass unseen.
status=0
"$lampray" diff "$here/reference.exr" "$out/new.exr" --alpha 0.001 --margin 0.01 --map "$out/difference.png" \
    | tee "$out/verdict.txt" || status=$?
exit "$status"
