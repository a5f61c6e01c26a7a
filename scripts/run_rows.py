"""Benchmark rows from the summaries of two runs of the liver scene: with two processes and with three."""
import json
import sys

two, three = (json.load(open(name)) for name in sys.argv[1:3])
rows = [
    ("run", "liver", "haptic_hz", two["haptic_node"]["rate_hz"], "Hz"),
    ("run", "liver", "visual_hz", two["render_node"]["rate_hz"], "Hz"),
    ("run", "liver", "step_p50", two["haptic_node"]["step_us_p50"], "us"),
    ("run", "liver", "step_p999", two["haptic_node"]["step_us_p999"], "us"),
    ("run", "liver", "missed_ticks", two["haptic_node"]["missed"], "ticks"),
    ("latency", "loopback_tool_to_picture", "p50", two["render_node"]["latency_us_p50"], "us"),
    ("latency", "loopback_tool_to_surface", "p50", three["deform_node"]["latency_us_p50"], "us"),
    ("latency", "loopback_tool_to_surface", "p99", three["deform_node"]["latency_us_p99"], "us"),
]
for bench, case, metric, value, unit in rows:
    print(f"{bench},{case},{metric},{value:.6g},{unit}")
