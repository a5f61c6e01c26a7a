"""Benchmark rows from the summary of a run: run_rows.py SUMMARY.json SCENE."""
import json
import sys

summary = json.load(open(sys.argv[1]))
scene = sys.argv[2]
bench, case = (scene, "run") if scene == "hepatectomy" else ("run", scene)
haptic, render = summary["haptic_node"], summary["render_node"]
rows = [
    (bench, case, "haptic_hz", haptic["rate_hz"], "Hz"),
    (bench, case, "visual_hz", render["rate_hz"], "Hz"),
    (bench, case, "step_p50", haptic["step_us_p50"], "us"),
    (bench, case, "step_p999", haptic["step_us_p999"], "us"),
    (bench, case, "missed_ticks", haptic["missed"], "ticks"),
]
if scene == "liver":
    rows.append(("latency", "loopback_tool_to_picture", "p50", render["latency_us_p50"], "us"))
deform = summary.get("deform_node") or {}
if "tick_hz" in deform:
    rows += [
        (bench, case, "tissue_hz", deform["tick_hz"], "Hz"),
        (bench, case, "tissue_tick_p50", deform["tick_us_p50"], "us"),
        (bench, case, "tissue_missed_ticks", deform["missed"], "ticks"),
        (bench, case, "tetrahedra_cut", deform["tetrahedra_cut"], "1"),
    ]
for bench, case, metric, value, unit in rows:
    print(f"{bench},{case},{metric},{value:.6g},{unit}")
