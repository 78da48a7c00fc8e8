#!/bin/sh
# Whether a frame costs at the end of a long recording what it cost at its
# beginning: plays a sequence forth and back until it has FRAMES frames, runs
# sf_run on it, and prints memory and seconds a frame every tenth of it.
#
# usage: tools/benchmark/long_recording.sh SEQUENCE FRAMES OUTPUT [sf_run flags]
#
# SEQUENCE has the layout of TUM with an associations.txt. OUTPUT: a new folder:
# sequence/ (links and lists), run/, memory.txt (frames done, resident kB).
set -eu
if [ $# -lt 3 ]; then
  sed -n '2,9s/^# \{0,1\}//p' "$0"
  exit 2
fi
sequence=$(cd "$1" && pwd); frames=$2; output=$3; shift 3
program=$(cd "$(dirname "$0")/../.." && pwd)/build/release/bin/sf_run
[ -f "$sequence/associations.txt" ] ||
  { echo "$sequence/associations.txt: expected a list of frames" >&2; exit 1; }
mkdir "$output"
mkdir "$output/sequence"
for entry in "$sequence"/*; do
  case ${entry##*/} in
    associations.txt | rgb.txt | depth.txt | groundtruth.txt | gt) ;;
    *) ln -s "$entry" "$output/sequence/" ;;
  esac
done
grep -v '^#' "$sequence/associations.txt" | awk -v frames="$frames" '
  BEGIN { n = 0 }
  NF { colour[n] = $2; depth[n++] = $4 }
  END {
    for (k = 0; k < frames; ++k) {
      i = k % (2 * n)
      if (i >= n) i = 2 * n - 1 - i
      printf "%.6f %s %.6f %s\n", k / 30, colour[i], k / 30, depth[i]
    }
  }' > "$output/sequence/associations.txt"

run=$output/run
"$program" --sequence="$output/sequence" --output="$run" --pictures_every=0 \
  --warped_every=0 "$@" &
id=$!
while kill -0 "$id" 2> /dev/null; do
  done=$(cat "$run/unfinished/frames.jsonl" 2> /dev/null | wc -l)
  memory=$(awk '/^VmRSS/ {print $2}' "/proc/$id/status" 2> /dev/null || true)
  # What comes after the last frame is none of a frame's cost.
  if [ -n "$memory" ] && [ "$done" -lt "$frames" ]; then
    echo "$done $memory" >> "$output/memory.txt"
  fi
  sleep 2
done
wait "$id"

awk -v frames="$frames" '
  FILENAME == ARGV[1] { memory[int(10 * $1 / frames)] = $2 / 1000; next }
  match($0, /"total":[0-9.e+-]+/) {
    part = int(10 * seen / frames)
    sum[part] += substr($0, RSTART + 8, RLENGTH - 8)
    ++count[part]
    ++seen
  }
  END {
    print "   frames  memory MB  s a frame"
    for (part = 0; part < 10; ++part) {
      if (!(part in memory)) memory[part] = memory[part - 1]
      printf "%9d %10.1f %10.4f\n", (part + 1) * frames / 10, memory[part],
             sum[part] / count[part]
    }
    if (!memory[0] || !count[0] || !count[9]) exit
    printf "last tenth over first: memory %.2f, seconds %.2f\n",
           memory[9] / memory[0], sum[9] / count[9] / (sum[0] / count[0])
  }' "$output/memory.txt" "$run/frames.jsonl"
