"""Benchmark rows from the summary of a run of the liver scene."""
import json
import sys

summary = json.load(open(sys.argv[1]))
haptic, render = summary["haptic_node"], summary["render_node"]
rows = [
    ("run", "liver", "haptic_hz", haptic["rate_hz"], "Hz"),
    ("run", "liver", "visual_hz", render["rate_hz"], "Hz"),
    ("run", "liver", "step_p50", haptic["step_us_p50"], "us"),
    ("run", "liver", "step_p999", haptic["step_us_p999"], "us"),
    ("run", "liver", "missed_ticks", haptic["missed"], "ticks"),
    ("latency", "loopback_tool_to_picture", "p50", render["latency_us_p50"], "us"),
]
for bench, case, metric, value, unit in rows:
    print(f"{bench},{case},{metric},{value:.6g},{unit}")
