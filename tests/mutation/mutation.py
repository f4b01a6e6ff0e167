#!/usr/bin/python3
"""Promises: MUT.

Builds the mutants of protocol/wire and firmware_sim/core, runs the tests against each, and says which survive.

usage: mutation.py [--build DIR] [--again] [--quick] [--file PART]

Fails where a mutant survives that tests/mutation/equivalents.txt does not prove equivalent, or where that list names one
that is not there or that a test kills. --again runs only what survived the last time; --file only mutants of files whose
name contains PART; --quick leaves the state table's mutants out and gives each of the others 100 ms of tests, so that
more survive. Results are kept in DIR/mutation/.
"""
import argparse
import json
import os
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def key_of(mutant):
    return (mutant["file"], mutant["function"], mutant["original"], mutant["mutated"])


def equivalents(path):
    """Blocks of `file | function`, `- original`, `+ mutated`, `= why`, apart by empty lines; # begins a comment."""
    found = {}
    for number, block in enumerate(path.read_text().split("\n\n"), 1):
        lines = [line for line in block.splitlines() if line.strip() and not line.startswith("#")]
        if not lines:
            continue
        heads, why = lines[0].split(" | "), " ".join(line[2:] for line in lines if line.startswith("= "))
        minus = [line[2:] for line in lines if line.startswith("- ")]
        plus = [line[2:] for line in lines if line.startswith("+ ")]
        if len(heads) != 2 or len(minus) != 1 or not plus or len(why) < 20 or 2 + len(plus) + sum(l.startswith("= ") for l in lines) != len(lines):
            sys.exit(f"mutation: {path.name}: block {number} is not `file | function`, `- original`, `+ mutated`.., `= why`")
        for mutated in plus:
            found[(heads[0], heads[1], minus[0], mutated)] = why
    return found


def without_figures():
    """The environment of tests that state none: those of a mutant are not ours."""
    return {name: value for name, value in os.environ.items() if name != "PINJAW_FIGURES"}


def reach(program, folder):
    out = folder / "reach.txt"
    if not out.exists() or out.stat().st_mtime < program.stat().st_mtime:
        subprocess.run([program, "--reach", folder / "reach.new"], check=True, env=without_figures())
        (folder / "reach.new").rename(out)
    tests = []
    for line in out.read_text().splitlines():
        name, ms, *ids = line.split()
        tests.append((float(ms), name, frozenset(map(int, ids))))
    start_ms = min(ms for ms, _, _ in tests)  # what a process costs before it has done anything
    tests = [(ms - start_ms, name, ids) for ms, name, ids in tests]
    # those that come by few places first: they ask about little, and quickly; but the table's own see all of it at once
    return sorted(tests, key=lambda test: (not test[1].startswith("StateTable."), 20 * test[0] + len(test[2]), test[1]))


def compiler_kills(mutant, folder):
    """Whether the compiler refuses its own checks with this mutant in what it evaluates."""
    return subprocess.run(["g++", "-std=c++20", "-w", "-Wno-narrowing", "-fsyntax-only", "-fmax-errors=1", f"-DPINJAW_MUTANT={mutant['id']}",
                           f"-I{folder / 'tree'}", f"-I{ROOT}", "-xc++", ROOT / "tests/protocol/wire/constant_checks.hpp"],
                          capture_output=True).returncode != 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--file", default="")
    options = parser.parse_args()
    folder = options.build / "mutation"
    subprocess.run(["cmake", "--build", options.build, "--target", "pinjaw_mutants"], check=True, stdout=sys.stderr)
    program = options.build / "bin" / "pinjaw_mutants"
    mutants = json.loads((folder / "mutants.json").read_text())
    proven = equivalents(ROOT / "tests/mutation/equivalents.txt")
    chosen = [m for m in mutants if options.file in m["file"]]
    last = folder / "verdicts.json"
    verdicts = {tuple(k): v for k, v in json.loads(last.read_text())} if last.exists() else {}
    if options.again:
        chosen = [m for m in chosen if verdicts.get(key_of(m), "survived") in ("survived", "unreached")]

    tests = reach(program, folder)
    if options.quick:
        chosen = [m for m in chosen if m["family"] != "table"]
    began = time.monotonic()
    plan, by_id = [], {}
    for mutant in chosen:
        mine, spent_ms = [], 0.0
        for ms, name, ids in tests:
            if mutant.get("reach", mutant["id"]) in ids and not (options.quick and spent_ms > 100):
                mine.append(f"{name}={ms}")
                spent_ms += ms
        by_id[mutant["id"]] = mutant
        mutant["verdict"] = "unreached"
        if mine:
            plan.append(f"{mutant['id']} {' '.join(mine)}\n")
    (folder / "plan.txt").write_text("".join(plan))
    subprocess.run([program, "--kill", folder / "plan.txt", folder / "kills.txt"], check=True, env=without_figures())
    cpu_ms, killers = 0.0, Counter()
    for line in (folder / "kills.txt").read_text().splitlines():
        mutant, verdict, ms, *test = line.split()
        by_id[int(mutant)]["verdict"] = verdict
        cpu_ms += float(ms)
        if verdict != "survived" and test:
            killers[test[0]] += 1

    worst = ("survived", "unreached")
    wire = [m for m in chosen if m["verdict"] in worst and m["file"].startswith("protocol/wire/")]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for mutant, killed in zip(wire, pool.map(lambda m: compiler_kills(m, folder), wire)):
            mutant["verdict"] = "not compiled" if killed else mutant["verdict"]

    fresh = {}
    for mutant in chosen:
        key = key_of(mutant)
        fresh[key] = mutant["verdict"] if fresh.get(key) not in worst else fresh[key]
    known = {key_of(m) for m in mutants}
    verdicts = {k: v for k, v in {**verdicts, **fresh}.items() if k in known}
    last.write_text(json.dumps(list(verdicts.items())))

    bad = 0
    for mutant in chosen:
        if mutant["verdict"] in worst and key_of(mutant) not in proven:
            bad += 1
            print(f"{mutant['file']}:{mutant['line']}: {mutant['function']}: {mutant['verdict']} ({mutant['family']})\n- {mutant['original']}\n+ {mutant['mutated']}")
    for key in proven:
        if key not in known:
            bad += 1
            print(f"equivalents.txt: there is no such mutant: {' | '.join(key)}")
        elif verdicts.get(key, "survived") not in worst:
            bad += 1
            print(f"equivalents.txt: a test kills this one: {' | '.join(key)}")
    count = Counter(m["verdict"] for m in chosen)
    equivalent = sum(1 for m in chosen if m["verdict"] in worst and key_of(m) in proven)
    killed = sum(n for verdict, n in count.items() if verdict not in worst)
    table = sum(1 for m in chosen if m["family"] == "table")
    print(f"{len(chosen)} mutants ({table} of them of the state table): {killed} killed, {equivalent} proven equivalent, "
          f"{sum(count[w] for w in worst) - equivalent} survived ({dict(count)}); {cpu_ms / 1000:.0f} s of CPU, {time.monotonic() - began:.0f} s")
    figures = os.environ.get("PINJAW_FIGURES")
    if figures and not (options.again or options.quick or options.file):
        with open(figures, "a") as out:
            for what, value in (("mutants", len(chosen)), ("killed", killed), ("proven equivalent", equivalent),
                                ("survived", sum(count[w] for w in worst) - equivalent), ("CPU", round(cpu_ms / 1000))):
                out.write(json.dumps({"promise": "MUT", "what": what, "value": str(value), "unit": "s" if what == "CPU" else "mutants"}) + "\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
