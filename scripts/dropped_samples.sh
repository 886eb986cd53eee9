#!/usr/bin/env bash
# Renders every scene of scenes/ by every integrator, small and with many samples, and prints the numbers of dropped
# samples (not finite, or negative) and of rejected rays. Fails unless all are 0.
#
#   scripts/dropped_samples.sh [SAMPLES [WIDTHxHEIGHT]]     (4096, 32x18: an hour on two cores)
#
# LAMPYR: the binary; otherwise the one built beside this script.
set -eu
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
lampyr=${LAMPYR:-$root/build/release/lampyr}
samples=${1:-4096}
size=${2:-32x18}
stats=$(mktemp -d)
trap 'rm -rf "$stats"' EXIT
failed=0
for scene in "$root"/scenes/*.pbrt; do
  for integrator in path light bdpt sppm vcm; do
    # With too many dropped samples the render fails, after it has written its statistics.
    rm -f "$stats/stats.json"
    if ! "$lampyr" render "$scene" --integrator "$integrator" --spp "$samples" --resolution "$size" --quiet \
      --output "$stats/out.exr" --stats "$stats/stats.json" 2>"$stats/errors"; then
      echo "$(basename "$scene" .pbrt) $integrator: $(tail -n 1 "$stats/errors")"
      failed=1
    fi
    [ -f "$stats/stats.json" ] || continue
    dropped=$(sed -n 's/.*"droppedSamples": \([0-9]*\).*/\1/p' "$stats/stats.json")
    rejected=$(sed -n 's/.*"rejectedRays": \([0-9]*\).*/\1/p' "$stats/stats.json")
    echo "$(basename "$scene" .pbrt) $integrator: $dropped dropped, $rejected rays rejected"
    [ "$dropped" = 0 ] && [ "$rejected" = 0 ] || failed=1
  done
done
exit $failed
