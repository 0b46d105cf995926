#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audits of long paths: segments a second on one core and on all, and memory, which must not grow with the path.

Usage: audits.py RESULTS TAUT [--quick]     writes RESULTS/audit.md
"""
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

RESULTS, TAUT = sys.argv[1:3]
QUICK = "--quick" in sys.argv[3:]
CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cases", "audits", "robot1-geodesic.yaml")
CORES = sorted(os.sched_getaffinity(0))
REPEATS = 1 if QUICK else 5


def helix(rows):
    """The origin on a helix, the platform turning a little, as a controller logs it: time and quaternion."""
    yield "t[s],px[mm],py[mm],pz[mm],qx,qy,qz,qw"
    for k in range(rows):
        turn = 2 * math.pi * k / 500
        x, y, z = 5 * math.cos(turn), 5 * math.sin(turn), 345 + 10 * k / rows
        tilt, direction, torsion = 0.7 + 0.01 * math.sin(turn / 3), -1.55 + 0.02 * math.cos(turn / 5), math.radians(17)
        qx, qy = -math.sin(tilt) * math.sin(direction - torsion), math.sin(tilt) * math.cos(direction - torsion)
        qz, qw = math.cos(tilt) * math.sin(torsion), math.cos(tilt) * math.cos(torsion)
        yield f"{k * 0.01:.2f},{x:.6f},{y:.6f},{z:.6f},{qx:.12f},{qy:.12f},{qz:.12f},{qw:.12f}"


def audit(folder, path, cores):
    """Summary, all seconds from start to end, and the largest resident memory [MB]."""
    command = ["taskset", "-c", ",".join(map(str, cores)), TAUT, "audit", CASE, path,
               "--out", os.path.join(folder, "out"), "--json"]
    with tempfile.TemporaryFile() as output:
        begin = time.monotonic()
        process = subprocess.Popen(command, stdout=output)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        summary = json.loads(output.read())
    assert summary["verdict"] == "proved" and process.returncode == 0, summary
    return summary, seconds, usage.ru_maxrss / 1024


def main():
    lines = ["# Long audits", "",
             "A helix in a log of times and quaternions (geodesic): read, proved, and written as path.csv and",
             f"certificate.json. Runs on one core and on {len(CORES)} alternate; medians of {REPEATS}. The rate is",
             "segments a second while they are proved. The total is the time of the whole command in seconds: it",
             "reads the file once before it proves, and puts the certificate together in the end. Memory is the most",
             "that was used; sizes are in MB.", "",
             f"| waypoints | rate, 1 core | rate, {len(CORES)} cores | ratio "
             f"| total, 1 core | total, {len(CORES)} cores | ratio "
             "| memory | certificate |", "|---|---|---|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for rows in [10_000] + ([] if QUICK else [100_000]):
            path = os.path.join(folder, "helix.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.writelines(row + "\n" for row in helix(rows))  # a child's memory counts from what this process has
            rates, times, memory = ([], []), ([], []), 0
            for _ in range(REPEATS):
                for which, cores in enumerate(([CORES[0]], CORES)):
                    summary, seconds, peak = audit(folder, path, cores)
                    rates[which].append(summary["segments"] / summary["prove_seconds"])
                    times[which].append(seconds)
                    memory = max(memory, peak)
            size = os.path.getsize(os.path.join(folder, "out", "certificate.json")) / 1e6
            ratio = statistics.median(many / one for one, many in zip(*rates))
            ratio_of_all = statistics.median(one / many for one, many in zip(*times))
            one_core, all_cores = (statistics.median(of) for of in rates)
            total_one_core, total_all_cores = (statistics.median(of) for of in times)
            lines.append(f"| {rows} | {one_core:.0f} | {all_cores:.0f} | {ratio:.2f} | "
                         f"{total_one_core:.2f} | {total_all_cores:.2f} | {ratio_of_all:.2f} | "
                         f"{memory:.0f} | {size:.1f} |")
            print(lines[-1], flush=True)
    with open(os.path.join(RESULTS, "audit.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


main()
