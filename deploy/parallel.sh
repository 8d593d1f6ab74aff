#!/usr/bin/env bash
# A sweep on every core of this machine, or of several, by GNU parallel:
#   deploy/parallel.sh request.json sweep.ndjson
#   HOSTS=node1,node2,: deploy/parallel.sh request.json sweep.ndjson     (":" is this machine)
# Run it again after anything went wrong: finished points are kept.
set -euo pipefail
REQUEST=${1:-request.json}             # what POST /v1/sweep takes
OUTPUT=${2:-sweep.ndjson}
PARTS=${PARTS:-$OUTPUT.parts}          # a folder for the shards' files
VINES=${VINES:-vines}                  # the program
SHARDS=${SHARDS:-$((4 * $(nproc)))}    # some more than all cores have, so that none is idle for long at the end
HOSTS=${HOSTS:-}                       # by ssh; they need the program, and this folder at the same path

mkdir -p "$PARTS"
# A shard that fails stops the others from being started; the exit code is then not 0 and nothing is merged.
seq 0 $((SHARDS - 1)) | parallel --quote --halt soon,fail=1 ${HOSTS:+--sshlogin "$HOSTS" --workdir "$PWD"} \
    "$VINES" sweep "$REQUEST" --shard "{}/$SHARDS" --threads 1 --resume --output "$PARTS/part-{}.ndjson"
"$VINES" merge "$PARTS"/part-*.ndjson --output "$OUTPUT"
