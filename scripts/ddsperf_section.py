"""The section of docs/latency.md that sets the bus beside the vendor's own ddsperf: turns of both, one after the other."""
import json
import statistics
import subprocess

TURNS = 20


def section(palpate, seconds):
    command = ["latency", "--ddsperf", str(TURNS), "--seconds", str(seconds)]
    printed = subprocess.run([palpate, *command, "--domain", "95", "--json"], check=True, capture_output=True, text=True).stdout
    figures = json.loads(printed)
    ways = [("palpate's bus", figures["round_trip_us"]), ("bare Cyclone DDS by listener", figures["bare_dds_listener_us"]),
            ("`ddsperf`, by listener", figures["ddsperf_us"])]
    ratios = [bus / vendor for bus, vendor in zip(ways[0][1], ways[2][1])]
    return ["## Beside the vendor's ddsperf", "",
            f"    palpate {' '.join(command)}", "",
            f"{TURNS} turns of {seconds} s; in each the bus, bare DDS by listener and `ddsperf ping` with `ddsperf pong` have the machine to themselves, one after the other,",
            f"{figures['rate_hz']:.0f} messages a second, each as long. p50 of a turn; `ddsperf` prints half a round trip, here it is doubled.", "",
            "| there and back [µs] | median of the turns | least | most |", "| --- | --- | --- | --- |",
            *(f"| {name} | {statistics.median(values):.0f} | {min(values):.0f} | {max(values):.0f} |" for name, values in ways), "",
            f"The bus takes **{statistics.median(ratios):.2f} times** as long as `ddsperf` (median of the turns' ratios, {min(ratios):.2f} to {max(ratios):.2f})."]
