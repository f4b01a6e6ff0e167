#!/usr/bin/python3
"""Lists the branches of sources that no run took, and fails where there is one.

usage: branches.py FOLDER --leave-out PATTERN SOURCES..

FOLDER: a build with gcov's counts. SOURCES: folders of sources in the checkout. Lines that match PATTERN do not count, nor do what the compiler adds for exceptions and what it hangs on a line that is a lone brace.

A function that is inline or a template is compiled many times, and each copy counts for itself. A branch is taken where
one copy took it. Copies whose line has another number of branches are other code; such a line counts where it ran at all,
or where no copy of it ran.
"""
import argparse
import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


ROOT = Path(__file__).resolve().parents[2]


def decisions(branches):
    """Their counts. A call that may throw has two ways on, back and by exception; neither is a decision of the source."""
    counts = []
    for branch, before in zip(branches, [None, *branches]):
        if not branch["throw"]:
            counts.append(branch["count"])
        elif before and before["fallthrough"]:
            counts.pop()
    return counts


def counted(data, sources):
    """(file, line), runs, counts of branches of each copy of each line of `sources` that `data`, a file of counts, knows."""
    said = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", "--branch-counts", data.resolve()],
                          check=True, capture_output=True, text=True).stdout
    for report in map(json.loads, said.splitlines()):
        for file in report["files"]:
            path = (Path(report["current_working_directory"]) / file["file"]).resolve()
            if not any(path.is_relative_to(source) for source in sources):
                continue
            for line in file["lines"]:
                yield (path, line["line_number"]), line["count"], decisions(line["branches"])


def merged(copies):
    """Counts of branches of the copies of one line."""
    shapes = {}
    for runs, counts in copies:
        known = shapes.setdefault(len(counts), [0, [0] * len(counts)])
        known[0] += runs
        known[1] = [max(pair) for pair in zip(known[1], counts)]
    ran = [counts for runs, counts in shapes.values() if runs] or [counts for _, counts in shapes.values()]
    return [count for counts in ran for count in counts]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--leave-out", type=re.compile, required=True)
    parser.add_argument("sources", nargs="+")
    options = parser.parse_args()
    sources = [ROOT / source for source in options.sources]
    files = sorted(options.folder.rglob("*.gcda"))
    copies = {}
    with ThreadPoolExecutor() as pool:
        for lines in pool.map(lambda data: list(counted(data, sources)), files):
            for place, runs, counts in lines:
                copies.setdefault(place, []).append((runs, counts))
    taken, branches = 0, 0
    for (file, number), found in sorted(copies.items()):
        text = file.read_text().splitlines()[number - 1].strip()
        if options.leave_out.fullmatch(text) or not re.search(r"\w", text):
            continue
        counts = merged(found)
        branches += len(counts)
        taken += len(counts) - counts.count(0)
        if 0 in counts:
            print(f"{file.relative_to(ROOT)}:{number}: {counts.count(0)} of {len(counts)} branches never taken: {text}")
    print(f"branches: {100 * taken / max(1, branches):.1f}% ({taken} out of {branches})")
    return 0 if branches and taken == branches else 1


if __name__ == "__main__":
    sys.exit(main())
