#!/usr/bin/env bash
# Renders a scene in parts on a Slurm cluster, and merges them into one image: without learning, the same image as on a
# single machine (docs/long-renders.md).
#
#   scripts/slurm_render.sh SCENE.pbrt PARTS OUT.exr [OPTION OF lampyr render]…
#
# Submits an array of PARTS jobs, and one that merges when all have succeeded. Prints the numbers of both. Parts and their
# logs are in OUT.parts/, which must be on a file system that all nodes share, like the scene. A part that is lost (its
# node, its process, its time) is queued again and continues from its last checkpoint; the others are not affected. A
# part that fails because of the scene or the options is not tried again.
#
# --threads, --checkpoint, --shard, --output and --resume are set by the script: cores by --cpus-per-task in
# LAMPYR_SBATCH, checkpoints by LAMPYR_CHECKPOINT.
#
# LAMPYR          the binary; otherwise the one on the PATH, then the one built beside this script
# LAMPYR_SBATCH   options for both jobs, e.g. "--partition=long --time=4:00:00 --cpus-per-task=16"
# LAMPYR_TRIES    how often a part that fails is queued again (5)
# LAMPYR_CHECKPOINT  interval of a part's checkpoints (60s)
set -eu

fail() {
  echo "error: $*" >&2
  exit 2
}

# One task of the array.
run_part() {
  local lampyr=$1 scene=$2 parts=$3 folder=$4 index=$SLURM_ARRAY_TASK_ID code=0
  shift 4
  echo "part $index/$parts, start $((${SLURM_RESTART_COUNT:-0} + 1)) on $(hostname)"
  "$lampyr" render "$scene" --shard "$index/$parts" --output "$folder/$index-of-$parts.exr" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --resume --checkpoint "${LAMPYR_CHECKPOINT:-60s}" "$@" &
  local render=$!
  # Time is nearly over (--signal below): the part is continued. Slurm itself requeues the jobs that it ends.
  trap 'kill -TERM $render' USR1
  trap 'kill -TERM $render; wait $render; exit 143' TERM
  # A signal ends `wait`, but not the render.
  while :; do
    wait "$render" && code=0 || code=$?
    kill -0 "$render" 2>/dev/null || break
  done
  trap - USR1
  case $code in
    0 | 2) exit $code ;;
  esac
  if [ "${SLURM_RESTART_COUNT:-0}" -ge "${LAMPYR_TRIES:-5}" ]; then
    echo "part $index/$parts has failed ${SLURM_RESTART_COUNT:-0} times (exit code $code): given up" >&2
    exit $code
  fi
  echo "part $index/$parts ended with exit code $code: queued again" >&2
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$index"
  # Slurm ends a job that is requeued; the job must not end before that.
  sleep 300
  exit $code
}

run_merge() {
  local lampyr=$1 parts=$2 folder=$3 output=$4 names=() index
  for ((index = 1; index <= parts; ++index)); do names+=("$folder/$index-of-$parts.exr"); done
  "$lampyr" merge "${names[@]}" --output "$output"
}

case ${LAMPYR_SLURM_STEP:-} in
  part) run_part "$@" ;;
  merge) run_merge "$@"; exit ;;
esac

[ $# -ge 3 ] || fail "usage: $(basename "$0") SCENE.pbrt PARTS OUT.exr [OPTION OF lampyr render]…"
scene=$1 parts=$2 output=$3
shift 3
[ -f "$scene" ] || fail "there is no scene \"$scene\""
[[ $parts =~ ^[1-9][0-9]*$ ]] || fail "\"$parts\" is no number of parts"
[[ $output == *.exr ]] || fail "\"$output\" must end in .exr"
stops=
for option in "$@"; do
  case $option in
    --time* | --target-error*) stops=$option ;;
  esac
done
for option in "$@"; do
  case $option in
    --spp*)
      [ -z "$stops" ] || fail "$option with $stops: parts that stop before they have their samples are not merged" ;;
    --threads* | --checkpoint* | --shard* | --resume | --output* | -o*)
      fail "$option is set by this script; cores: --cpus-per-task in LAMPYR_SBATCH; checkpoints: LAMPYR_CHECKPOINT" ;;
  esac
done
command -v sbatch >/dev/null || fail "there is no sbatch here: Slurm is not installed (Debian: slurm-client)"
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
lampyr=${LAMPYR:-$(command -v lampyr || echo "$here/../build/release/lampyr")}
[ -x "$lampyr" ] || fail "there is no lampyr; set LAMPYR to the binary"
lampyr=$(realpath "$lampyr") scene=$(realpath "$scene") output=$(realpath -m "$output")
folder=${output%.exr}.parts
mkdir -p "$folder"

script=$here/$(basename "${BASH_SOURCE[0]}")
read -ra options <<<"${LAMPYR_SBATCH:-}"
array=$(LAMPYR_SLURM_STEP=part sbatch --parsable --job-name=lampyr --array="1-$parts" --requeue --open-mode=append \
  --signal=B:USR1@60 --output="$folder/%a-of-$parts.log" ${options[@]+"${options[@]}"} \
  "$script" "$lampyr" "$scene" "$parts" "$folder" "$@")
merge=$(LAMPYR_SLURM_STEP=merge sbatch --parsable --job-name=lampyr-merge --dependency="afterok:$array" \
  --kill-on-invalid-dep=yes --requeue --open-mode=append --output="$folder/merge.log" ${options[@]+"${options[@]}"} \
  "$script" "$lampyr" "$parts" "$folder" "$output")
echo "parts: job $array, merge: job $merge, logs: $folder/"
