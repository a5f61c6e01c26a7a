#!/usr/bin/env python3
"""Measures what observers cost the haptic node and writes docs/observers.md with its picture: observers_page.py [--quick]
[BIN | ROWS.csv], where the rows are what BIN/bench_observers prints. Leave the machine alone meanwhile."""
import csv
import os
import pathlib
import subprocess
import sys

import matplotlib
import small_png

matplotlib.use("Agg")
import matplotlib.pyplot as plt

root = pathlib.Path(__file__).resolve().parent.parent
arguments = [a for a in sys.argv[1:] if a != "--quick"]
source = pathlib.Path(arguments[0]) if arguments else root / "build/release/bin"


def lines():
    if source.is_file():
        return source.read_text().splitlines()
    quick = ["--quick"] if "--quick" in sys.argv else []
    return subprocess.run([str(source / "bench_observers"), *quick], check=True, capture_output=True, text=True).stdout.splitlines()


cases = {"peers": {}, "multicast": {}, "shared": {}}
for row in csv.reader(lines()):
    if len(row) < 5 or row[0] != "observers":
        continue
    way, count = row[1].split("_")
    cases[way].setdefault(int(count), {})[row[2]] = float(row[3])


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown"


def table(of):
    out = ["| observers | step p50 | p99 | p99.9 | p99 to none | steps missed | ring to wire p50 | p99 | publisher | middleware | datagrams | bare UDP | heard | missing |",
           "| --- " * 14 + "|"]
    for count, m in sorted(of.items()):
        bare = f"{m['bare_udp']:.0f}" if "bare_udp" in m else "-"
        out.append(f"| {count} | {m['step_p50']:.1f} | {m['step_p99']:.1f} | {m['step_p999']:.1f} | {m['step_p99'] / of[0]['step_p99']:.2f} | "
                   f"{m['missed']:.0f} | {m['ring_to_wire_p50']:.0f} | {m['ring_to_wire_p99']:.0f} | {m['publisher']:.0f} | {m['middleware']:.0f} | "
                   f"{m['datagrams']:.1f} | {bare} | {m['heard']:.0f} | {m['missing']:.0f} |")
    return out


def slope(of, key):
    """Growth per observer from the first, which draws, to the most."""
    first, most = sorted(of)[1], max(of)
    return (of[most][key] - of[first][key]) / (most - first)


figure, axes = plt.subplots(1, 2, figsize=(9, 3.4))
for way in ("peers", "multicast"):
    of = cases[way]
    counts = sorted(of)
    axes[0].plot(counts, [of[c]["step_p99"] for c in counts], "o-", label=way)
    axes[1].plot(counts, [of[c]["publisher"] for c in counts], "o-", label=f"{way}, publisher")
    axes[1].plot(counts, [of[c]["bare_udp"] for c in counts], "s--", label=f"{way}, one bare UDP message")
axes[0].set_ylabel("haptic step, p99 [µs]")
axes[1].set_ylabel("processor time a step [µs]")
for a in axes:
    a.set_xlabel("observers")
    a.set_ylim(0, 1.45 * max(y for line in a.lines for y in line.get_ydata()))
    a.grid(True, color="0.92")
    a.legend(frameon=False, loc="upper left")
    for side in ("top", "right"):
        a.spines[side].set_visible(False)
figure.tight_layout()
small_png.save(figure, root / "docs/pictures/observers.png", dpi=110)

commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
peers, multicast, shared = cases["peers"], cases["multicast"], cases["shared"]
growth = {way: max(m["step_p99"] for m in of.values()) / of[0]["step_p99"] for way, of in cases.items()}
document = [
    "# Many observers", "",
    f"Written by `scripts/observers_page.py` from `bench/observers.cpp`; {machine()}, {os.cpu_count()} cores, commit {commit}.", "",
    "The liver runs on two hosts made of network namespaces, each with half of this machine's cores: the haptic node on one, the",
    "deformation node and the observers on the other. The first observer draws (`render_node`), every fourth records (`palpate record`), and the",
    "others hear every topic and check its sequence numbers. The numbers of observers take turns, in another order each round; figures are",
    "medians over the rounds, in microseconds.", "",
    "- *step*: the whole haptic tick. *p99 to none*: against no observer, in the same run.",
    "- *ring to wire*: from the hand-over to the publisher thread until the bus has all messages of the step.",
    "- *publisher*, *middleware*: processor time a step of the thread that writes, and of all threads of DDS in the haptic node, which read",
    "  acknowledgements and repeat what was lost. *Datagrams*: that leave the haptic node's host, a step.",
    "- *bare UDP*: processor time that the sender of one message needs for as many plain sockets. Both hosts share one kernel, which delivers",
    "  to each receiver in the sender's time; over a cable a multicast datagram costs its sender the same whoever listens.",
    "- *heard*, *missing*: samples of all observers that check in one run, and those that their numbers lack, of all rounds.", "",
    "With peers (`--peer`), where each observer is sent a copy of its own:", "", *table(peers), "",
    "With multicast (no peers given), where one datagram serves all:", "", *table(multicast), "",
    "![p99 of the step and cost of the publisher against the number of observers](pictures/observers.png)", "",
    f"The step's p99 is at most {growth['peers']:.2f} times (peers) and {growth['multicast']:.2f} times (multicast) that without observers. With peers each further observer",
    f"costs the publisher {slope(peers, 'publisher'):.1f} us a step and {slope(peers, 'datagrams'):.1f} datagrams. With multicast it costs {slope(multicast, 'datagrams'):.2f} datagrams; the "
    f"{slope(multicast, 'publisher'):.1f} us a step are the", f"kernel's delivery on this one machine: a bare UDP message costs {slope(multicast, 'bare_udp'):.1f} us more for each further receiver, and a step has up to three.", "",
    "With peers, all processes on all cores, as when everything runs on one machine:", "", *table(shared), ""]
(root / "docs/observers.md").write_text("\n".join(document))
