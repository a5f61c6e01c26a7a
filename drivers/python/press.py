#!/usr/bin/env python3
"""A driver in Python: publishes a tool's position a thousand times a second and takes the force for the motors.

    PYTHONPATH=.../lib/python3/dist-packages press.py DOMAIN [TOOL [FROM TO]]

DOMAIN: of the running system on this host. TOOL: its place in the scene's list, from 0. FROM, TO: depths beyond the
trocar [m], between which the emulated hardware goes in and out. For hardware of your own, replace read_position() and
drive_motors()."""
import math
import signal
import sys
import time

import palpate

PERIOD = 0.001   # [s]
SILENCE = 0.100  # [s] without a force, after which the motors go limp


def read_position(seconds, shallow, deep):
    """Yaw, pitch [rad], depth [m], roll, grip [rad], pedal: in and out within four seconds."""
    return 0, 0, shallow + (deep - shallow) * 0.5 * (1 - math.cos(2 * math.pi * seconds / 4)), 0, 0, 0


def drive_motors(force):
    drive_motors.largest = max(drive_motors.largest, math.hypot(*force))


drive_motors.largest = 0.0


def run(device, shallow, deep):
    begin = time.monotonic()
    due, heard, limp = begin, begin, True  # limp until the first force
    while True:
        sensed = time.monotonic_ns()
        device.write(read_position(1e-9 * sensed - begin, shallow, deep), sense_ns=sensed)
        state = device.take()
        if state is not None:
            drive_motors(state.force)
            heard, limp = time.monotonic(), False
        elif not limp and time.monotonic() - heard > SILENCE:
            drive_motors((0, 0, 0))
            limp = True
            print("limp: no force for 100 ms", flush=True)
        due += PERIOD
        time.sleep(max(0.0, due - time.monotonic()))


def main():
    domain, tool = (int(value) for value in (sys.argv[1:3] + ["0", "0"][len(sys.argv[1:3]):]))
    shallow, deep = (float(value) for value in (sys.argv[3:5] or ("0.10", "0.12")))
    device = palpate.Device(tool, domain=domain)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run(device, shallow, deep)
    except KeyboardInterrupt:
        print(f"{device.written} samples, the largest force {drive_motors.largest:.3f} N")


if __name__ == "__main__":
    main()
