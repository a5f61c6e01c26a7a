#!/usr/bin/env python3
"""Measures latency on loopback and over a veth pair between two network namespaces and writes docs/latency.md with its
pictures: latency_page.py [--quick] [BIN]. Needs the right to make namespaces (ip netns) and ddsperf (cyclonedds-tools). Leave the machine alone meanwhile."""
import json
import os
import pathlib
import platform
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import ddsperf_section
import delay_section

root = pathlib.Path(__file__).resolve().parent.parent
arguments = [a for a in sys.argv[1:] if a != "--quick"]
seconds = "3" if "--quick" in sys.argv else "20"
bin_folder = pathlib.Path(arguments[0]).resolve() if arguments else root / "build/release/bin"
palpate = str(bin_folder / "palpate")
scene = str(root / "scenes/liver.toml")
here, there = f"palpate-h{os.getpid()}", f"palpate-d{os.getpid()}"
address = {here: "10.77.0.1", there: "10.77.0.2"}


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def make_hosts():
    for name in (here, there):
        ip("netns", "add", name)
        ip("-n", name, "link", "set", "lo", "up")
    ip("link", "add", "palpate0", "netns", here, "type", "veth", "peer", "name", "palpate0", "netns", there)
    for name in (here, there):
        ip("-n", name, "addr", "add", f"{address[name]}/24", "dev", "palpate0")
        ip("-n", name, "link", "set", "palpate0", "up")


def remove_hosts():
    for name in (here, there):
        subprocess.run(["ip", "netns", "del", name], stderr=subprocess.DEVNULL)


def on(host, *command):
    """The command as run on one host, which knows the other as its peer."""
    other = there if host == here else here
    return ["ip", "netns", "exec", host, *command, "--domain", "95", "--interface", "palpate0", "--peer", address[other]]


def start(command):
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def stop(processes):
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        process.wait(timeout=20)


def measured(command, picture):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([*command, "--seconds", seconds, "-o", folder], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if picture:
            shutil.copy(pathlib.Path(folder) / "latency.png", root / "docs/pictures" / picture)
        return json.loads((pathlib.Path(folder) / "latency.json").read_text())


def over_veth(with_scene, picture, *keys):
    others = [start(on(there, palpate, "latency", "--answer", "--json", *keys))]
    command = on(here, palpate, "latency", *keys)
    if with_scene:
        others += [start(on(host, str(bin_folder / node), scene, *keys))
                   for host, node in ((there, "deform_node"), (there, "render_node"), (here, "haptic_node"))]
        command.append("--attach")
    time.sleep(3)
    result = measured(command, picture)
    stop(reversed(others))
    return result


def with_and_without_keys():
    """The same over veth, in turns, so that a change of the host's load shows."""
    with tempfile.TemporaryDirectory() as folder:
        keys = pathlib.Path(folder) / "keys"
        subprocess.run([palpate, "keys", keys], check=True, stdout=subprocess.DEVNULL)
        return [(over_veth(True, None), over_veth(True, None, "--keys", str(keys))) for _ in range(3)]


def cost_of_security(turns):
    lines, ratios = [], []
    for key, title in (("round_trip", "there and back over the bus"), ("tool_to_surface", "tool to surface")):
        of = [[(d["hops_us"] if key.startswith("tool") else {key: d[f"{key}_us"]})[key] for d in turn] for turn in turns]
        lines += [f"| {title} [µs] | p50 | p90 | p99 | p99.9 | max |", "| --- | --- | --- | --- | --- | --- |"]
        for i, turn in enumerate(of):
            lines += [row(f"without keys, turn {i + 1}", turn[0]), row(f"with keys, turn {i + 1}", turn[1])]
        lines.append("")
        ratio = [statistics.median(turn[1][p] / turn[0][p] for turn in of) for p in ("p50", "p99")]
        ratios.append(f"{title} takes {ratio[0]:.2f} times as long ({ratio[1]:.2f} times at p99)")
    lost = [sum(turn[i]["ways"]["round_trip"]["lost"] for turn in turns) for i in (0, 1)]
    sent = [sum(turn[i]["ways"]["round_trip"]["sent"] for turn in turns) for i in (0, 1)]
    return [*lines, f"With keys, by the medians, {' and '.join(ratios)}; each figure is the middle one of {len(turns)} turns.",
            f"Of the messages there and back {lost[0]} of {sent[0]} were lost without keys and {lost[1]} of {sent[1]} with them."]


def row(name, p, rest=""):
    if p is None:
        return f"| {name} | - | - | - | - | - |{rest}"
    return f"| {name} | {p['p50']:.0f} | {p['p90']:.0f} | {p['p99']:.0f} | {p['p999']:.0f} | {p['max']:.0f} |{rest}"


def trips(data):
    lines = ["| there and back [µs] | p50 | p90 | p99 | p99.9 | max | lost | jitter |", "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for key, title in (("round_trip", "palpate's bus"), ("bare_dds", "bare Cyclone DDS"),
                       ("bare_dds_listener", "the same by listener"), ("bare_udp", "bare UDP")):
        way = data["ways"][key]
        lines.append(row(title, data[f"{key}_us"], f" {way['lost']} of {way['sent']} | {way['jitter_us']:.0f} |"))
    return lines + ["", f"The bus takes {data['ratio_to_bare_dds']:.2f} times as long as bare DDS, "
                    f"and {data['ratio_to_bare_dds_listener']:.2f} times as long as it by listener (medians)."]


def hops(data):
    lines = ["| one way [µs] | p50 | p90 | p99 | p99.9 | max |", "| --- | --- | --- | --- | --- | --- |"]
    for key, title in (("tool_to_force", "tool to force"), ("tool_to_surface", "tool to surface"), ("tool_to_picture", "tool to picture")):
        lines.append(row(title, data["hops_us"][key]))
    return lines


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return platform.machine()


subprocess.run([palpate, "precompute", scene], check=True, stdout=subprocess.DEVNULL)
loopback = measured([palpate, "latency", "--domain", "95"], "latency_loopback.png")
loopback_scene = measured([palpate, "latency", scene, "--domain", "95"], "latency_loopback_scene.png")
try:
    make_hosts()
    veth = over_veth(False, "latency_veth.png")
    veth_scene = over_veth(True, "latency_veth_scene.png")
    turns = with_and_without_keys()
finally:
    remove_hosts()

commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True).stdout.strip()
ratio = {name: s["hops_us"]["tool_to_surface"]["p50"] / s[f"{way}_us"]["p50"] for name, s, way in
         (("dds", veth_scene, "bare_dds"), ("udp", veth_scene, "bare_udp"))}
document = ["# Latency", "",
            f"Written by `scripts/latency_page.py`; {machine()}, {os.cpu_count()} cores, commit {commit}, {seconds} s each at 1 kHz. Do it for your own hosts:", "",
            "    palpate latency                      # here, between two processes",
            "    palpate latency --answer --interface eth0 --peer HOST_A     # on host B",
            "    palpate latency --interface eth0 --peer HOST_B -o out       # on host A: table, JSON and plot",
            "    palpate latency scenes/liver.toml    # with a simulation meanwhile, and its hops",
            "    palpate info session.lcmlog          # the hops of a log", "",
            "Four ways take turns within each period, in such an order that each comes as often after each of the others, so that a change of the hosts' load",
            "meets all of them: a `ToolState` there and a `ForceState` back over the bus, served on the thread that brings them (`Bus::serve`), as much over",
            "Cyclone DDS alone, once to a thread that a wait set wakes, and once by listener, where the middleware's own thread serves the message on both sides,",
            "as the vendor's `ddsperf` does, and as much in UDP datagrams. All DDS is reliable and keeps one sample: where two come before they are taken, the first",
            "counts as lost.", "",
            "What costs is the wake of a thread on each side, not what asks for it: readers that wake the waiting thread by listeners in place of the wait set",
            "gained nothing. So the bus calls who serves on the thread that brings a message. The check of each sample before it is kept adds an eighth to the",
            "instructions of that thread.", "",
            "The nodes wait all the same. A deformation node that answered contacts on the thread that brings them was tried by turns: from sense to surface took 414 to",
            "582 µs either way (plate and liver, four turns each), of which the wake is little and the superposition most; for answers of more than 0.2 ms reception",
            "would stand. The haptic node looks once a tick, and moving tissue has a tick of its own. `Bus::serve` is there for programs that answer at once.", "",
            *ddsperf_section.section(palpate, min(int(seconds), 4)), "",
            "## Two processes on one machine", "", *trips(loopback), "", "![Round trips on loopback](pictures/latency_loopback.png)", "",
            "With the liver simulated meanwhile on the same cores:", "", *trips(loopback_scene), "", *hops(loopback_scene), "",
            "![Round trips and hops with a simulation](pictures/latency_loopback_scene.png)", "",
            "## Two network namespaces joined by a veth pair", "", *trips(veth), "", "![Round trips over veth](pictures/latency_veth.png)", "",
            "With the haptic node in one and the deformation and render nodes in the other:", "", *trips(veth_scene), "", *hops(veth_scene), "",
            f"Tool to surface takes {ratio['dds']:.1f} times a bare DDS round trip and {ratio['udp']:.1f} times a bare UDP one.", "",
            "![Round trips and hops over veth](pictures/latency_veth_scene.png)", "",
            "## The cost of security", "",
            "The same over veth with the nodes running, without and with [keys](security.md), in turns. Every message is then encrypted and signed, and so",
            "is the answer that it came.", "", *cost_of_security(turns), "",
            "## How one-way times are told across machines", "",
            "Every message carries the time at which its writer handed it to the bus (`publish_ns`), and those that follow from a haptic step the time at",
            "which that step read its devices (`sense_ns`), each on its own host's monotonic clock. Every node but the haptic one asks it for its clock",
            "eight times a second. A way takes no less than no time, so that each answer bounds the offset between the clocks from both sides; the",
            "offsets `a + b t` that keep within all bounds of the last half minute give the estimate, its uncertainty and the drift",
            "(`common/realtime/clock_offset.hpp`). It holds for ways of unequal delay: with 10 ms there and 30 ms back, a second of offset and 100 ppm of drift",
            "the true offset lies within the stated uncertainty at all times, as a test shows. Nodes announce offset, uncertainty and drift in `NodeStatus`;",
            "`palpate latency`, `info` and `top` use them. On one machine all nodes share one clock, and the offset is zero.", "",
            *delay_section.section(bin_folder, root / "docs/pictures")]
(root / "docs/latency.md").write_text("\n".join(document))
