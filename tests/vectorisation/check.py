"""Reads the disassembly of a contact plugin and proves that its loop over pairs works on packed numbers.

usage: check.py OBJDUMP PLUGIN.so lanes|scalar|xmm|ymm|zmm

lanes   the loops over SIMD lanes: packed arithmetic at least RATIO times the scalar arithmetic, no call at all
scalar  the scalar reference twins must miss that bar: the check can tell the two apart
xmm …   the widest registers of every loop over SIMD lanes: those of x86-64-v2, of x86-64-v3, of x86-64-v4
"""

import re
import subprocess
import sys

RATIO = 10  # measured with g++ 12 and AVX2: 19 and more in the lanes, 0.4 and less in the twins
ARITHMETIC = re.compile(r"v?(?:add|sub|mul|div|sqrt|min|max|fn?m(?:add|sub)\d{3})([ps])[sd]$")
REGISTER = re.compile(r"%([xyz]mm)\d")
TWIN = re.compile(r"pair_loop<[^<>]*, \d+u, (?:double|float),")


def loops(objdump, plugin):
    """Name of each pair_loop → counts of packed and scalar arithmetic, the calls in it, and its widest registers."""
    listing = subprocess.run([objdump, "-d", "-C", "--no-show-raw-insn", plugin], capture_output=True, text=True, check=True)
    found, current = {}, None
    for line in listing.stdout.splitlines():
        if line.endswith(">:"):
            name = line.split("<", 1)[1]
            start = {"p": 0, "s": 0, "calls": [], "widest": ""}
            current = found.setdefault(name, start) if "detail::pair_loop<" in name else None
        elif current is not None and (code := line.split("\t")[1:]):
            word = code[0].split()[0]
            current["widest"] = max([current["widest"], *REGISTER.findall(code[0])])
            if match := ARITHMETIC.match(word):
                current[match[1]] += 1
            elif word.startswith("call"):
                current["calls"].append(code[0])
    return found


def faults(name, counts):
    if counts["p"] < RATIO * counts["s"]:
        yield f"{name[:100]}: {counts['p']} packed against {counts['s']} scalar, {RATIO} to 1 is asked for"
    for call in counts["calls"]:
        yield f"{name[:100]}: {call}"


def main(objdump, plugin, which):
    found = loops(objdump, plugin)
    twins = {name for name in found if TWIN.search(name)}
    chosen = sorted(twins if which == "scalar" else found.keys() - twins)
    if not chosen:
        return f"{plugin}: no loop over pairs found ({which})"
    if which.endswith("mm"):
        return "\n".join(f"{name[:100]}: uses {found[name]['widest']}" for name in chosen if found[name]["widest"] != which) or None
    if which == "scalar":
        return "\n".join(f"{name[:100]}: passes as vectorised" for name in chosen if not [*faults(name, found[name])]) or None
    return "\n".join(fault for name in chosen for fault in faults(name, found[name])) or None


sys.exit(main(*sys.argv[1:]))
