#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audits of long paths: segments a second on one core and on all, and what the checker takes to prove them again.

Usage: audits.py RESULTS TAUT TAUT_CHECK [--quick]     writes RESULTS/audit.md
"""
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

RESULTS, TAUT, CHECK = sys.argv[1:4]
QUICK = "--quick" in sys.argv[4:]
CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cases", "audits", "robot1-geodesic.yaml")
CORES = sorted(os.sched_getaffinity(0))
REPEATS = 1 if QUICK else 3


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


def run(command, cores):
    """What it printed, all seconds from start to end, and the largest resident memory [MB]."""
    with tempfile.TemporaryFile() as output:
        begin = time.monotonic()
        process = subprocess.Popen(["taskset", "-c", ",".join(map(str, cores)), *command], stdout=output)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return output.read().decode(), process.returncode, seconds, usage.ru_maxrss / 1024


def audit(out, path, cores):
    """Proved, but left to taut-check to check."""
    said, _, seconds, memory = run([TAUT, "audit", CASE, path, "--out", out, "--no-report", "--headroom", "0",
                                    "--max-seconds", "0", "--json"], cores)
    return json.loads(said), seconds, memory


def check(out):
    said, code, seconds, memory = run([CHECK, os.path.join(out, "certificate.json"), CASE], CORES)
    assert code == 0 and said.startswith("accepted: an audit, proved again"), said
    return seconds, memory


def main():
    count = len(CORES)
    lines = ["# Long audits", "",
             "A helix in a log of times and quaternions (geodesic): read, proved with the checker's kernel run on",
             "every box, and written as path.csv and certificate.json, without a report; then checked by `taut-check`",
             f"with the case. Audits on one core and on {count} alternate; medians of {REPEATS}. The rate is segments",
             "a second while they are proved, the total the time of the whole command in seconds; memory is the most",
             f"that was used, the file the certificate; both are in MB. The check runs on {count}.", "",
             f"| waypoints | rate, 1 core | {count} cores | ratio | total, 1 core | {count} cores | ratio "
             "| memory | file | check, s | its memory |", "|---|---|---|---|---|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        for rows in [10_000] + ([] if QUICK else [100_000]):
            path = os.path.join(folder, "helix.csv")
            with open(path, "w", encoding="utf-8") as file:
                # One by one: a child's memory counts from what this process has.
                file.writelines(row + "\n" for row in helix(rows))
            rates, times, memory, checks = ([], []), ([], []), 0, []
            for _ in range(REPEATS):
                for which, cores in enumerate(([CORES[0]], CORES)):
                    summary, seconds, peak = audit(out, path, cores)
                    rates[which].append(summary["segments"] / summary["prove_seconds"])
                    times[which].append(seconds)
                    memory = max(memory, peak)
                checks.append(check(out))
            size = os.path.getsize(os.path.join(out, "certificate.json")) / 1e6
            ratio = statistics.median(many / one for one, many in zip(*rates))
            ratio_of_all = statistics.median(one / many for one, many in zip(*times))
            one_core, all_cores = (statistics.median(of) for of in rates)
            total_one_core, total_all_cores = (statistics.median(of) for of in times)
            check_seconds, check_memory = (statistics.median(of) for of in zip(*checks))
            lines.append(f"| {rows} | {one_core:.0f} | {all_cores:.0f} | {ratio:.2f} | "
                         f"{total_one_core:.2f} | {total_all_cores:.2f} | {ratio_of_all:.2f} | "
                         f"{memory:.0f} | {size:.1f} | {check_seconds:.1f} | {check_memory:.0f} |")
            print(lines[-1], flush=True)
    with open(os.path.join(RESULTS, "audit.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


main()
