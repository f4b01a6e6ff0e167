"""Says on a CAN interface what nobody should: python3 garbage.py INTERFACE SECONDS SEED, with Debian's python3-can.

Half of it under ids of the protocol, of every length, remote and extended ones among them; random data, or data that was heard
before with a bit flipped or not at all.
"""
import random
import sys
import time

import can

interface, seconds, seed = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
draw = random.Random(seed)
bus = can.Bus(interface="socketcan", channel=interface)
ids = [base + node for base in (0x10, 0x20, 0x40, 0x60, 0xA0, 0x100, 0x140, 0x600, 0x680) for node in (1, 2, 3)] + [0xF0, 0xF8]
heard = []
sent = 0
end = time.monotonic() + seconds
while time.monotonic() < end:
    message = bus.recv(0)
    if message is not None and not message.is_error_frame and not message.is_remote_frame:
        heard = (heard + [message])[-500:]
    data = bytearray(draw.randbytes(draw.choice([0, 1, 2, 7, 8, 8, 8, 8])))
    identifier = draw.choice(ids) if draw.random() < 0.5 else draw.randrange(0x800)
    if heard and draw.random() < 0.5:
        old = draw.choice(heard)
        data, identifier = bytearray(old.data), old.arbitration_id & 0x7FF
        if data and draw.random() < 0.5:
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    kind = draw.random()
    try:
        bus.send(can.Message(arbitration_id=identifier, data=b"" if kind < 0.05 else bytes(data),
                             is_remote_frame=kind < 0.05, is_extended_id=0.05 <= kind < 0.1))
        sent += 1
    except can.CanError:
        pass  # a full queue
    if draw.random() < 0.2:
        time.sleep(0.001)
print(sent)
