"""What palpate.Device takes and counts: device.py DOMAIN"""
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

import palpate

from refused import refused

domain = int(sys.argv[1])
refused(RuntimeError, "domain", lambda: palpate.Device(domain=999))
for limit in "max_force", "max_torque", "max_grip", "max_force_rate":
    for value in math.nan, math.inf, 0, -1:
        refused(RuntimeError, limit, lambda: palpate.Device(domain=domain, **{limit: value}))

device = palpate.Device(domain=domain)
assert device.write([0, 0, 0.1, 0, 0, 0]) and device.written == 1
assert not device.write([math.nan] * 6) and device.written == 1, "what was not sent is not counted"
assert device.write([0, 0, 0.1, 0, 0, 0]) and device.written == 2

assert palpate.__version__
assert subprocess.run([sys.executable, "-c", "from palpate import *; Device; import palpate; help(palpate)"],
                      stdout=subprocess.DEVNULL).returncode == 0
refused(TypeError, "__init__() was not called", lambda: palpate.Device.__new__(palpate.Device).motors())
refused(TypeError, "__init__() was not called", lambda: palpate.Device.__new__(palpate.Device).limp)

child = os.fork()
if child == 0:
    try:
        refused(RuntimeError, "forked", lambda: device.write([0, 0, 0.1, 0, 0, 0]))
        refused(RuntimeError, "forked", lambda: palpate.Device(domain=domain))
        del device
        os._exit(0)
    finally:
        os._exit(1)
assert os.waitpid(child, 0)[1] == 0, "a forked process is told, and does not hang"

if not list(pathlib.Path(palpate.__file__).parent.glob("_core.*so")):
    refused(ImportError, "has only palpate.Device: Scene is in the package python3-palpate", lambda: palpate.Scene)

refused(ValueError, "seconds", lambda: device.wait(math.nan))


def on_alarm(*_):
    raise KeyboardInterrupt


signal.signal(signal.SIGALRM, on_alarm)
signal.setitimer(signal.ITIMER_REAL, 0.2)
begin = time.monotonic()
try:
    while device.wait(math.inf):
        pass
    assert False, "it slept for ever, and yet has ended"
except KeyboardInterrupt:
    assert time.monotonic() - begin < 5, "a signal ends it"
