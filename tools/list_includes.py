#!/usr/bin/env python3
"""Who includes whom: the longest chain of the project's own includes, and every
include that breaks a rule of CONTRIBUTING.md ("Layers", whose table this
reads).

    tools/list_includes.py [ROOT]

Prints the chain and one line for each breach. Exit status 1 if there is a
breach, or the chain has more than LONGEST includes.
"""
import functools
import os
import re
import sys

LONGEST = 9
GENERATED = "splitfusion/method_hash.h"
FOLDERS = ("lib", "cost_functions", "pipelines", "tools", "examples")
HERE = os.path.dirname(os.path.abspath(__file__))


def read_layers():
    """Level of every module, and pairs that may include within a level."""
    level_of, pairs = {}, set()
    with open(os.path.join(HERE, "..", "CONTRIBUTING.md")) as file:
        for line in file:
            row = re.match(r"\| (\d+) \| (.*) \| (.*) \|$", line)
            if row:
                for module in re.findall(r"`([a-z_/]+)`", row[2]):
                    level_of[module] = int(row[1])
                pairs.update(re.findall(r"`([a-z_/]+)` includes `([a-z_/]+)`",
                                        row[3]))
    return level_of, pairs


def read_includes(root):
    """Of every source file, by its path, the includes: (text, in quotes)."""
    found = {}
    for folder in FOLDERS:
        for place, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                # A project of a user, to copy.
                if place.endswith("term_project"):
                    continue
                if name.endswith((".h", ".cc")):
                    path = os.path.join(place, name)
                    with open(path) as file:
                        lines = re.findall(
                            r'^ *# *include +([<"])(.*)[>"]', file.read(), re.M)
                    found[os.path.relpath(path, root)] = [
                        (text, quote == '"') for quote, text in lines]
    return found


def module_of(path):
    """lib/energy/solver.h -> lib/energy, pipelines/presets.h -> pipelines."""
    return "/".join(path.split("/")[:2 if path.startswith("lib/") else 1])


def breach(path, included, quoted, level_of, pairs):
    """What is wrong with one include; None if nothing is."""
    module = module_of(path)
    if included == GENERATED:
        return None
    own = re.match("splitfusion/(.*)", included)
    private = path.endswith(".cc") or "/internal/" in path
    if own:
        other = module_of(own[1])
        if "/internal/" in included and module != "tools" and not private:
            return f"public header includes {own[1]}, not installed"
        if other not in level_of:
            return f"includes {own[1]}, a module that is not listed"
        if (other != module and (module, other) not in pairs
                and level_of[other] >= level_of[module]):
            return f"{module} may not include {other} ({own[1]})"
    elif quoted and module != "tools":
        return f'includes "{included}": write "splitfusion/..."'
    elif re.match("(gflags|glog)/", included) and module != "tools":
        return f"includes {included}: only tools/ may"
    elif re.match("(openvdb|pcl)/", included) and not private:
        return f"includes {included}: only .cc files may"
    return None


def breaches(includes):
    """One line for each."""
    level_of, pairs = read_layers()
    for path in sorted(includes):
        if module_of(path) not in level_of:
            yield f"{path}: {module_of(path)} is not listed in any level"
            continue
        for included, quoted in includes[path]:
            text = breach(path, included, quoted, level_of, pairs)
            if text:
                yield f"{path}: {text}"


def longest_chain(includes):
    """Files, each of which includes the next."""
    def target(path, included):
        beside = os.path.normpath(os.path.join(os.path.dirname(path), included))
        return next((file for file in (included.replace("splitfusion/", "", 1),
                                       beside, "tools/" + included)
                     if file in includes and file != path), None)

    @functools.lru_cache(None)
    def chain(path):
        rest = [chain(file) for file in
                (target(path, included) for included, _ in includes[path])
                if file]
        return (path,) + max(rest, key=len, default=())

    return max(map(chain, sorted(includes)), key=len)


def main():
    includes = read_includes(sys.argv[1] if sys.argv[1:] else HERE + "/..")
    if not includes:
        sys.exit("list_includes: no sources")
    found = list(breaches(includes))
    chain = longest_chain(includes)
    print(f"{len(includes)} files; the longest chain has {len(chain) - 1} "
          f"includes, {LONGEST} at most:")
    print("".join(f"  {path}\n" for path in chain) + "\n".join(found))
    sys.exit(bool(found) or len(chain) - 1 > LONGEST)


if __name__ == "__main__":
    main()
