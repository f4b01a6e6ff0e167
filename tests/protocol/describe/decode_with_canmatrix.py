#!/usr/bin/python3
"""Decodes a candump log by a DBC with canmatrix: an independent reader of both.

usage: decode_with_canmatrix.py DBC LOG    one JSON object a line: {"message": ..., "raw": {...}, "physical": {...}}
"""
import json
import re
import sys

import canmatrix
import canmatrix.formats

LINE = re.compile(r"^\((\d+\.\d{6})\) (\S+) ([0-9A-F]{3})#([0-9A-F]{0,16})$")


def main(dbc, log):
    matrix = canmatrix.formats.loadp_flat(dbc)
    with open(log, encoding="ascii") as lines:
        for text in lines:
            match = LINE.match(text)
            if not match:
                sys.exit(f"not a line of a log: {text!r}")
            frame = matrix.frame_by_id(canmatrix.ArbitrationId(int(match[3], 16), extended=False))
            if frame is None:
                sys.exit(f"no message for id {match[3]}")
            signals = frame.decode(bytes.fromhex(match[4]))
            print(json.dumps({
                "message": frame.name,
                "raw": {name: int(signal.raw_value) for name, signal in signals.items()},
                "physical": {name: float(signal.phys_value) for name, signal in signals.items()},
            }))


main(*sys.argv[1:])
