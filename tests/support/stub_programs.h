#ifndef SPLITFUSION_TESTS_SUPPORT_STUB_PROGRAMS_H_
#define SPLITFUSION_TESTS_SUPPORT_STUB_PROGRAMS_H_

#include <filesystem>
#include <string>

#include "support/temporary_folder.h"

namespace splitfusion {

/// Shell script that takes the flags of sf_run and writes what it writes, with
/// figures that its options decide. It refuses a flag `bogus`. Names of
/// sequences say more: `bad` fails, `mute` does so without a word, `resumed`
/// says that it went on from a checkpoint, `slow` takes a moment, `endless`
/// runs until SIGINT or, like `busy`, `greedy` and `still`, until it is killed.
inline constexpr const char* kStubRun = R"(#!/bin/sh
object=0.005; background=0.01; parts=; keep=; ask=; resumed=
escaped() { printf '%s' "$1" | sed 's/"/\\"/g'; }
for argument in "$@"; do
  value=${argument#*=}; key=${argument%%=*}; key=${key#--}
  case "$argument" in
    --keep_same) keep=1 ;;
    --overwrite | --threads=*) ;;
    --print_identity) ask=1 ;;
    --sequence=*) sequence=$value ;;
    --output=*) output=$value ;;
    --object_voxel=*) object=$value ;;
    --background_voxel=*) background=$value ;;
    --flagfile=*) parts="$parts, \"flags\": \"$(cat "$value")\"" ;;
    --bogus=*) echo "stub: unknown flag bogus" >&2; exit 2 ;;
    *) parts="$parts, \"$key\": \"$(escaped "$value")\"" ;;
  esac
done
parts="{\"input.frames\": \"${sequence##*/}\", \"object_voxel\": \"$object\", \"background_voxel\": \"$background\"$parts}"
if [ -n "$ask" ]; then
  echo "{\"identity\": \"x\", \"identity_parts\": $parts, \"outputs\": {}}"
  exit 0
fi
mkdir -p "$output"
if [ -n "$keep" ] && grep -qF "\"identity_parts\": $parts," "$output/run.json" 2>/dev/null &&
   grep -q '"status": "complete"' "$output/run.json"; then
  echo "kept"; exit 0
fi
echo "$$" >> "$sequence/starts.txt"
case "$sequence" in
  *bad) echo "warning" >&2; echo "bad/rgb.txt: cannot be opened" >&2; exit 2 ;;
  *mute) exit 4 ;;
  *crash) kill -SEGV $$ ;;
  *slow) sleep 0.1 ;;
  *resumed) resumed=4 ;;
  *endless) trap 'echo "interrupted after 4 frames" >&2; exit 1' INT
            touch "$output/started"; while :; do sleep 0.05; done ;;
  *still) touch "$output/started"; exec sleep 100 ;;
  *busy) while :; do :; done ;;
  *greedy) exec tail /dev/zero ;;
esac
number=$(printf '%s' "$sequence $parts" | sed 's/.*\/data//' | cksum | cut -c1-4)
rm -f "$output/evaluation.json"
echo "{\"frames\": 10, \"lost_frames\": 1, \"peak_memory_bytes\": 1000000,
  \"seconds_per_frame\": {\"median\": 0.5}}" > "$output/summary.json"
echo "$number" > "$output/number.txt"
cat > "$output/.run.json" <<END
{"format_version": 1, "tool": "sf_run", "id": "$(date +%s%N)$$",
 "status": "complete", "error": "", "resumed_at": [$resumed], "identity": "x",
 "identity_parts": $parts,
 "outputs": {}, "files": []}
END
mv "$output/.run.json" "$output/run.json"
)";

/// The same for sf_evaluate; it fails where the ground truth says "broken".
inline constexpr const char* kStubEvaluate = R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in
    --run=*) run=${argument#*=} ;;
    --ground_truth=*) truth=${argument#*=} ;;
    --check_only) exit 0 ;;
    --nope=*) echo "stub: unknown flag nope" >&2; exit 2 ;;
  esac
done
grep -q broken "$truth/groundtruth.txt" && { echo "no pose" >&2; exit 2; }
echo x >> "$truth/evaluations.txt"
number=$(cat "$run/number.txt")
echo "{\"headline\": {\"ate_m\": 0.$number, \"f_score_seen\": 0.5, \"rpe_m\": null}}" \
  > "$run/evaluation.json"
)";

/// Writes a script that can be run; returns its path.
inline std::string WriteScript(const TemporaryFolder& folder,
                               const std::string& name,
                               const std::string& text) {
  const std::string path = folder.Write(name, text);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_STUB_PROGRAMS_H_
