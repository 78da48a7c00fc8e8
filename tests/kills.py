#!/usr/bin/env python3
"""Kills sf_run and sf_batch at random moments, lets the same command go on, and
compares what comes out with an undisturbed run, byte by byte.

  tests/kills.py SEQUENCE [--kills=50] [--batch_kills=6] [--frames=36]
                 [--work=DIR] [--seed=1] [--build=build/release]

SIGKILL goes to the whole process group. Exit status 1 if a file differs or is
missing. Too slow for every run of the tests; run it after changes of
checkpoints or run directories.
"""
import argparse
import csv
import hashlib
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# What must be the same bytes (docs/report_format.md); other files hold times
# or the random ids of .vdb grids.
SAME = ("trajectory.txt", "mesh.ply", "motions.bin", "graph.json")


def digests(run):
    """Path -> SHA-256 of the files that must be the same."""
    found = {}
    for path in sorted(pathlib.Path(run).rglob("*")):
        inside = path.relative_to(run)
        if path.is_file() and (path.name in SAME or inside.parts[0] == "masks"):
            found[str(inside)] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def start(command, log):
    return subprocess.Popen(command, stdout=log, stderr=log,
                            start_new_session=True)


def kill_after(process, seconds):
    """Whether the process was still there to be killed."""
    try:
        process.wait(seconds)
        return False
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return True


def figures(table):
    """Rows of a results.csv without times and memory."""
    with open(table, newline="", encoding="utf-8") as file:
        return sorted(
            tuple((k, v) for k, v in row.items()
                  if "seconds" not in k and "memory" not in k)
            for row in csv.DictReader(file))


def kill_runs(args, work, log, draw):
    command = [args.build + "/bin/sf_run", "--sequence=" + args.sequence,
               f"--max_frames={args.frames}", "--checkpoint_every=6",
               "--pictures_every=0", "--write_masks"]
    begun = time.time()
    subprocess.run(command + [f"--output={work}/undisturbed"], check=True,
                   stdout=log, stderr=log)
    whole = time.time() - begun
    expected = digests(work / "undisturbed")
    kills = runs = bad = 0
    while kills < args.kills:
        output = work / "killed"
        shutil.rmtree(output, ignore_errors=True)
        rest = draw.randint(1, 3)  # Kills of this run.
        while True:
            process = start(command + [f"--output={output}"], log)
            if rest and kills < args.kills:
                killed = kill_after(process, draw.uniform(0, 0.9 * whole))
                kills += killed
                rest -= 1
                if killed:
                    continue
            process.wait()
            break
        runs += 1
        if process.returncode != 0 or digests(output) != expected:
            bad += 1
            print(f"run {runs}: exit status {process.returncode}, "
                  "files differ", flush=True)
    print(f"sf_run: {kills} kills, {runs} runs, {len(expected)} files each, "
          f"{bad} bad")
    return bad


def kill_batches(args, work, log, draw):
    command = [args.build + "/bin/sf_batch", "run",
               "--sequences=" + args.sequence,
               "--grid=terms.arap.weight=4,8,16; object_voxel=0.005,0.006",
               "--set=max_frames=6; pictures_every=0", "--repeat=4",
               "--jobs=2", "--threads=1"]
    begun = time.time()
    subprocess.run(command + [f"--output={work}/sweep"], check=True,
                   stdout=log, stderr=log)
    whole = time.time() - begun
    kills = 0
    while kills < args.batch_kills:
        process = start(command + [f"--output={work}/killed_sweep"], log)
        if not kill_after(process, draw.uniform(0.02, 0.4) * whole):
            break
        kills += 1
    last = start(command + [f"--output={work}/killed_sweep"], log).wait()
    expected = figures(work / "sweep/results.csv")
    bad = last != 0 or figures(work / "killed_sweep/results.csv") != expected
    print(f"sf_batch: {kills} kills, {len(expected)} tasks, "
          f"tables {'differ' if bad else 'are equal, times apart'}")
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("sequence")
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--batch_kills", type=int, default=6)
    parser.add_argument("--frames", type=int, default=36)
    parser.add_argument("--work")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", default="build/release")
    args = parser.parse_args()
    draw = random.Random(args.seed)
    work = pathlib.Path(args.work or tempfile.mkdtemp(prefix="kills-"))
    work.mkdir(parents=True, exist_ok=True)
    with open(work / "log", "ab") as log:
        bad = kill_runs(args, work, log, draw) if args.kills else 0
        bad += kill_batches(args, work, log, draw) if args.batch_kills else 0
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
