#!/usr/bin/env bash
# Prints one line for each constant of the method that no flag reaches:
#   FILE:LINE NAME = VALUE
# What counts, and how a constant is marked that is none of the method, is in
# CONTRIBUTING.md ("Constants"). Needs no build.
#   tools/list_constants.sh [ROOT]
set -euo pipefail
cd "${1:-"$(dirname "${BASH_SOURCE[0]}")/.."}"
exec python3 - <<'PYTHON'
import os
import re

FOLDERS = ("lib", "pipelines", "cost_functions")
OTHER = re.compile("lib/(base|calibration|sequence|segmentation|report|evaluation|"
                   "experiment|synthetic|page|export)/")
MARKED = re.compile(r"//[/<]*\s*(Layout|Speed|Format|Unit|Maths|Flag)\b[.:]")
NUMBER = r"-?(?:\d[\d']*\.?\d*(?:e[-+]?\d+)?|\.\d+)[fu]?\b"
TYPE = r"(?:bool|int|float|double|std::size_t|std::u?int\d+_t)"
# constexpr TYPE NAME = VALUE, and TYPE NAME = NUMBER anywhere else: members,
# arguments, variables. VALUE goes on to the end of the statement.
CONSTANT = re.compile(r"\bconstexpr\s+([\w:<>, ]+?)\s(\w+)(?:\[\w*\])*\s*=\s*"
                      r"([^;]+);")
DEFAULT = re.compile(rf"\b{TYPE}\s+(\w+)\s*=\s*({NUMBER})\s*[;,)]")
MEMBER = re.compile(rf"(?:\.|->)(\w+)\s*=\s*{NUMBER}\s*;")
FLOAT = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+(?=e-?\d))(?:e[-+]?\d+)?f?")
LISTING = re.compile(r"^\S[^\n]*::List\w*\(OptionList\* list\) \{.*?^\}|"
                     r"^  void List\(OptionList\* list\) override \{.*?^  \}",
                     re.M | re.S)
STRUCT = re.compile(r"(?:struct|class) (\w+)(?! *;)")
FUNCTION = re.compile(r"^(?:  )?(?!return|if|for|while|switch|else)[A-Za-z]"
                      r"[^;=#([]*?([\w~]+)\((?:[^;[]*|.*\})$")
SIMPLE = {0, 0.5, 1, 2}


def value_of(text):
    return float(text.strip().rstrip("fu").replace("'", ""))


def is_simple(text):
    return abs(value_of(text)) in SIMPLE


def is_sentinel(value):
    """Whether it stands for what is never reached."""
    return re.fullmatch(NUMBER, value) and abs(value_of(value)) >= 1e5


def is_derived(value):
    """Whether it is made of other names and of no number to choose."""
    return (re.search(r"[A-Za-z_]\w{2,}", re.sub(NUMBER, "", value))
            and all(map(is_simple, re.findall(rf"(?<![\w.]){NUMBER}", value))))


def without_comment(line):
    return re.sub(r'"(?:\\.|[^"\\])*"', '""', line).split("//")[0]


def files():
    for folder in FOLDERS:
        for place, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(place, name)
                if name.endswith((".h", ".cc")) and not OTHER.match(path):
                    yield path


def option_fields(texts):
    """Fields that a List...(OptionList*) names, and the lines of these."""
    fields, lines = set(), set()
    for path, text in texts.items():
        for body in LISTING.finditer(text):
            fields.update(re.findall(r"&(?:\w+\.)*(\w+)", body[0]))
            first = text.count("\n", 0, body.start()) + 1
            lines.update((path, first + i)
                         for i in range(body[0].count("\n") + 1))
    return fields, lines


def structs_with_options(texts):
    """Those that declare a List(OptionList*)."""
    names = set()
    for path, text in texts.items():
        struct = ""
        for line in text.split("\n"):
            struct = (STRUCT.match(line) or [0, struct])[1]
            if re.match(r"  (?:virtual )?void List\(OptionList\*", line):
                names.add(struct)
    return names


def constants(path, text, fields, listed, owners):
    """(line, name, value) of all constants of a file that are not marked."""
    lines = text.split("\n")
    code = [without_comment(line) for line in lines]
    internal = "/internal/" in path
    struct = function = ""
    end = 0  # Of the statement before.
    for i, line in enumerate(code):
        struct = (STRUCT.match(line) or [0, struct])[1]
        function = (FUNCTION.match(line) or [0, function])[1]
        statement = line if ";" in line else " ".join(code[i:i + 8])
        constant = "constexpr" in line and CONSTANT.search(statement)
        if i < end or (path, i + 1) in listed or MARKED.search(lines[i]):
            continue
        if constant:
            end = 1 + next(k for k in range(i, len(code)) if ";" in code[k])
            kind, name, value = constant.groups()
            value = " ".join(value.split())
            whole = not re.search(r"float|double", kind)
            if not (is_derived(value) or not re.search(r"\d", value)
                    or is_sentinel(value) or internal and whole):
                yield i + 1, name, value
            continue
        default = DEFAULT.search(line)
        if default:
            reached = struct in owners and default[1] in fields
            if not (reached or is_sentinel(default[2]) or
                    not struct.endswith("Options") and is_simple(default[2]) or
                    line.lstrip().startswith("for")):
                yield i + 1, default[1], default[2]
            continue
        member = MEMBER.search(line)
        if member and member[1] in fields:
            continue
        for number in FLOAT.findall(line):
            if not (is_simple(number) or is_sentinel(number) or
                    value_of(number) < 1e-5):
                yield i + 1, function, number


texts = {path: open(path).read() for path in sorted(files())}
fields, listed = option_fields(texts)
owners = structs_with_options(texts)
for path, text in texts.items():
    for line, name, value in constants(path, text, fields, listed, owners):
        print(f"{path}:{line} {name} = {value}")
PYTHON
