#!/usr/bin/env bash
# Runs a sweep on all cores of this machine, or of several, with GNU parallel:
#   deploy/parallel.sh request.json sweep.ndjson
#   HOSTS=node1,node2,: deploy/parallel.sh request.json sweep.ndjson     (":" is this machine)
# After a failure run it again: finished points are kept.
set -euo pipefail
REQUEST=${1:-request.json}             # request body of POST /v1/sweep
OUTPUT=${2:-sweep.ndjson}
PARTS=${PARTS:-$OUTPUT.parts}          # folder for the shards' files
VINES=${VINES:-vines}                  # the program
SHARDS=${SHARDS:-$((4 * $(nproc)))}    # several per core, so that the cores are busy until the end
HOSTS=${HOSTS:-}                       # reached by ssh; they need the program, and this folder at
                                       # the same path

mkdir -p "$PARTS"
# After a failed shard no other one is started; the exit code is then not 0 and nothing is merged.
seq 0 $((SHARDS - 1)) | parallel --quote --halt soon,fail=1 ${HOSTS:+--sshlogin "$HOSTS" --workdir "$PWD"} \
    "$VINES" sweep "$REQUEST" --shard "{}/$SHARDS" --threads 1 --resume --output "$PARTS/part-{}.ndjson"
"$VINES" merge "$PARTS"/part-*.ndjson --output "$OUTPUT"
