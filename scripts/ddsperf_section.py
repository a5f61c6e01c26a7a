"""The section of docs/latency.md that sets the bus beside the vendor's own ddsperf: turns of both, one after the other."""
import json
import re
import statistics
import subprocess

TURNS = 10
SIZE = 160       # bytes: a ToolState has 136, a ForceState 180
RATE = "4kHz"    # as often as one of the four ways of `palpate latency` sends: cores that rest are slower


def of_the_bus(palpate, seconds):
    printed = subprocess.run([palpate, "latency", "--domain", "95", "--seconds", str(seconds), "--json"],
                             check=True, capture_output=True, text=True).stdout
    figures = json.loads(printed)
    return {way: figures[f"{way}_us"]["p50"] for way in ("round_trip", "bare_dds", "bare_dds_listener")}


def of_ddsperf(seconds):
    """The median of its seconds' medians, there and back [us]; it prints half of that."""
    pong = subprocess.Popen(["ddsperf", "-i", "96", "-D", str(seconds + 3), "pong"], stdout=subprocess.DEVNULL)
    printed = subprocess.run(["ddsperf", "-i", "96", "-D", str(seconds + 1), "ping", RATE, "size", str(SIZE)],
                             capture_output=True, text=True).stdout
    pong.terminate()
    pong.wait()
    halves = [float(half) for half in re.findall(r" mean .* 50% ([\d.]+)us", printed)]
    if not halves:
        raise RuntimeError(f"ddsperf printed no round trips:\n{printed}")
    return 2 * statistics.median(halves)


def section(palpate, seconds):
    turns = [(of_the_bus(palpate, seconds), of_ddsperf(seconds)) for _ in range(TURNS)]
    ways = [("palpate's bus", [bus["round_trip"] for bus, _ in turns]),
            ("bare Cyclone DDS by listener", [bus["bare_dds_listener"] for bus, _ in turns]),
            ("bare Cyclone DDS by wait set", [bus["bare_dds"] for bus, _ in turns]),
            ("`ddsperf`, by listener", [vendor for _, vendor in turns])]
    ratios = [bus["round_trip"] / vendor for bus, vendor in turns]
    alone = statistics.median(ways[1][1]) / statistics.median(ways[3][1])
    return ["## Beside the vendor's ddsperf", "",
            f"{TURNS} turns of {seconds} s each, `palpate latency` (each of its four ways at 1 kHz) and `ddsperf ping {RATE} size {SIZE}` with `ddsperf pong` one after the other; p50 of a turn.",
            "`ddsperf` prints half a round trip; here it is doubled.", "",
            "| there and back [µs] | median of the turns | least | most |", "| --- | --- | --- | --- |",
            *(f"| {name} | {statistics.median(values):.0f} | {min(values):.0f} | {max(values):.0f} |" for name, values in ways), "",
            f"The bus takes **{statistics.median(ratios):.2f} times** as long as `ddsperf` (median of the turns' ratios, {min(ratios):.2f} to {max(ratios):.2f}). `ddsperf` has",
            "the cores and their caches to itself, while the four ways of `palpate latency` drive one another out: bare DDS by listener, which does there what `ddsperf`",
            f"does, takes {alone:.2f} times as long as it (medians)."]
