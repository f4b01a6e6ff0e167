#!/usr/bin/env python3
"""Has spin search custody.pml whole, as it is and with one rule left out at a time.

usage: custody_twin.py MODEL FOLDER

States its figures as tests/support/figures.hpp does. Exits 1 where the protocol as it is breaks an invariant, or
where a rule left out is not found.

Promises: I2, I2b, I2c.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

# (nodes, tokens of each) that are searched whole without a mistake
WHOLE = [(2, 1), (2, 2), (3, 1)]
# what is left out, and the tokens needed to see it
MISTAKES = {
    "NO_R1": 1, "NO_R2": 2, "NO_R3": 1, "NO_R4": 2, "NO_R5": 1, "NO_R6": 1, "NO_R7": 1, "NO_R8": 1, "NO_R9": 1,
    "NO_R10": 2, "NO_LATCH": 1, "SOLE_WITHOUT_RELEASED": 1, "RETAIN_AFTER_DECISION": 1,
}


def figure(promise, what, value, unit=""):
    line = json.dumps({"promise": promise, "what": what, "value": value, "unit": unit})
    print("figure", line, flush=True)
    if path := os.environ.get("PINJAW_FIGURES"):
        with open(path, "a", encoding="utf-8") as file:
            file.write(line + "\n")


def invariant_of(assertion):
    """Which of custody.pml's assertions it is."""
    for part, name in {"custodians": "I2b", "held": "I2", "nvm": "R6"}.items():
        if part in assertion:
            return name
    return "I2c"


def search(model, folder, nodes, tokens, mistake=None):
    """(states, the invariant that is broken or '', seconds of CPU) of one search; stops at the first error."""
    folder.mkdir(parents=True, exist_ok=True)
    defines = [f"-DNODES={nodes}", f"-DTOKENS={tokens}"] + ([f"-D{mistake}"] if mistake else [])
    subprocess.run(["spin", *defines, "-a", str(model)], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    optimise = "-O0" if mistake else "-O2"
    subprocess.run(["gcc", optimise, "-w", "-DSAFETY", "-DNOREDUCE", "-o", "pan", "pan.c"], cwd=folder, check=True)
    before = os.times()
    out = subprocess.run(["./pan", "-m2000000", "-w22"], cwd=folder, check=True, capture_output=True, text=True).stdout
    after = os.times()
    errors = int(re.search(r"errors: (\d+)", out).group(1))
    states = int(float(re.search(r"([\d.e+]+) states, stored", out).group(1)))
    if "Search not completed" in out and not errors:
        raise SystemExit(f"{folder.name}: not searched whole\n{out}")
    broken = re.search(r"assertion violated (.*) \(at depth", out)
    if errors and not broken:
        raise SystemExit(f"{folder.name}: no invariant broken, but\n{out}")
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return states, invariant_of(broken.group(1)) if errors else "", seconds


def main():
    model, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    failed = False
    for nodes, tokens in WHOLE:
        states, broken, seconds = search(model, folder / f"{nodes}x{tokens}", nodes, tokens)
        failed |= broken != ""
        name = f"spin, {nodes} nodes, {tokens} token{'s' if tokens > 1 else ''} each"
        for promise in ("I2", "I2b", "I2c"):
            figure(promise, f"{name}: errors", broken or "0")
        figure("I2", f"{name}: states", f"{states:,}", "states")
        figure("I2", f"{name}: processor time", f"{seconds:.3g}", "s")
    for mistake, tokens in MISTAKES.items():
        states, broken, _ = search(model, folder / mistake, 2, tokens, mistake)
        failed |= broken == ""
        found = f"found after {states:,} states, breaks {broken}" if broken else "NOT FOUND"
        figure("I2", f"spin, {mistake}", found)
    return failed


if __name__ == "__main__":
    sys.exit(main())
