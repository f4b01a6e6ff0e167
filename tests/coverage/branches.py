#!/usr/bin/python3
"""Lists the branches of a gcovr JSON report that no run took, and fails where there is one.

usage: branches.py REPORT

REPORT is made without --exclude-throw-branches: where a source includes an inline function that the linker took from
another, gcov does not say that a branch of the copy which never ran is an exception's. Only the merged report knows.
"""
import json
import sys
from pathlib import Path


def main():
    taken, branches = 0, 0
    for file in json.loads(Path(sys.argv[1]).read_text())["files"]:
        source = Path(file["file"]).read_text().splitlines()
        for line in file["lines"]:
            counts = [branch["count"] for branch in line["branches"] if not branch["throw"]]
            branches += len(counts)
            taken += len(counts) - counts.count(0)
            if 0 in counts:
                number = line["line_number"]
                print(f"{file['file']}:{number}: {counts.count(0)} of {len(counts)} branches never taken: {source[number - 1].strip()}")
    print(f"branches: {100 * taken / max(1, branches):.1f}% ({taken} out of {branches})")
    return 0 if branches and taken == branches else 1


if __name__ == "__main__":
    sys.exit(main())
