#!/usr/bin/env python3
"""A driver in Python: publishes a tool's position a thousand times a second and takes the force for the motors.

    PYTHONPATH=.../lib/python3/dist-packages press.py DOMAIN [TOOL [FROM TO]]

DOMAIN: of the running system on this host. TOOL: its place in the scene's list, from 0. FROM, TO: depths beyond the
trocar [m], between which the emulated hardware goes in and out. For hardware of your own, replace read_position() and
Motors."""
import math
import signal
import sys
import time

import palpate

PERIOD = 0.001  # [s]
LIMITS = {"max_force": 10.0, "max_torque": 3.0, "max_grip": 1.0, "max_force_rate": 500.0}  # what the motors give


def read_position(seconds, shallow, deep):
    """Yaw, pitch [rad], depth [m], roll, grip [rad], pedal: in and out within four seconds."""
    return 0, 0, shallow + (deep - shallow) * 0.5 * (1 - math.cos(2 * math.pi * seconds / 4)), 0, 0, 0


class Motors:
    """Emulated ones: they remember the largest force and the largest change in a tick [N]."""

    def __init__(self):
        self.force, self.largest, self.change = (0.0, 0.0, 0.0), 0.0, 0.0

    def drive(self, force):
        self.largest = max(self.largest, math.hypot(*force))
        self.change = max(self.change, math.dist(force, self.force))
        self.force = force


def ticks():
    due = time.monotonic()
    while True:
        yield
        due += PERIOD
        time.sleep(max(0.0, due - time.monotonic()))


def run(device, motors, shallow, deep):
    begin, limp = time.monotonic(), True  # limp until the first force
    for _ in ticks():
        sensed = time.monotonic_ns()
        device.write(read_position(1e-9 * sensed - begin, shallow, deep), sense_ns=sensed)
        motors.drive(device.motors().force)
        if device.limp and not limp:
            print("limp: no force for 40 ms", flush=True)
        limp = device.limp


def let_go(device, motors):
    """No kick at the end either."""
    for _ in ticks():
        if device.limp:
            return
        motors.drive(device.fade().force)


def number(place, name, kind, otherwise):
    """The argument at a place, or what stands for it where there is none."""
    if len(sys.argv) <= place:
        return otherwise
    try:
        value = kind(sys.argv[place])
    except ValueError:
        value = -1
    if not 0 <= value <= 1e9:
        sys.exit(f"press: {name} is a number from 0, and not '{sys.argv[place]}'")
    return value


def main():
    if len(sys.argv) > 5:
        sys.exit("press: too many arguments: press.py DOMAIN [TOOL [FROM TO]]")
    domain, tool = number(1, "DOMAIN", int, 0), number(2, "TOOL", int, 0)
    shallow, deep = number(3, "FROM", float, 0.10), number(4, "TO", float, 0.12)
    device, motors = palpate.Device(tool, domain=domain, **LIMITS), Motors()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run(device, motors, shallow, deep)
    except KeyboardInterrupt:
        let_go(device, motors)
        print(f"{device.written} samples, the largest force {motors.largest:.3f} N, "
              f"the largest change {motors.change:.3f} N")
        print(f"not felt: {device.strange} forces of another run, {device.refused} out of range")


if __name__ == "__main__":
    main()
