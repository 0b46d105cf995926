#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What it costs to have paths checked in Coq (docs/formal.md), by taut-verify, and by taut-check.

All planned cases of Table I that Coq is told of, a spline, and cases with load items, tolerances, an oblique ellipsoid
and a geodesic. formal/build has to have run. Times are of the processor, user and system; processes run one after the
other. Of coqc what it takes to load its libraries, measured beside, is taken away.

Usage: formal.py RESULTS TAUT TAUT_CHECK [--quick]     writes RESULTS/formal.md; --quick measures everything once
"""
import os
import re
import statistics
import subprocess
import sys
import tempfile

RESULTS, TAUT, CHECK = sys.argv[1:4]
REPEATS = 1 if "--quick" in sys.argv[4:] else 3
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LIBRARY = os.path.join(ROOT, "formal")
VERIFY = os.path.join(LIBRARY, "taut-verify")
CASES = [os.path.join(ROOT, "cases", name + ".yaml") for name in (
    "robot1-slice-qs-qg", "robot1-slice-qs1-qg", "robot1-slice-qs2-qg", "robot1-free-box-qs-qg",
    "robot1-roll-pitch-yaw", "tutorial/03-a-smooth-move", "robot2-sphere-q1-q2", "robot2-sphere-q2-q3",
    "robot2-sphere-q1-q2-q3", "robot2-sphere-sigma-free-q2-q3", "robot2-free-q2-q3",
    "robot2-free-q2-q3-astar")]
CASES += [os.path.join(ROOT, "tests", "cli", name) for name in (
    "formal_items.yaml", "formal_tolerances.yaml", "formal_oblique.yaml")]
CASES += [os.path.join(ROOT, "cases", *name) + ".yaml" for name in (
    ("audits", "robot1-geodesic"), ("audits", "robot1-cable-lengths"), ("robots", "iri-hexacrane", "q2-q3"),
    ("robots", "fast", "focus"), ("robots", "nist-roboprinter", "print"))]

HEAD = """# Paths checked in Coq

From `bench/formal.py`: processor times. `check` is what Coq's virtual machine takes to compute it, without loading
libraries and reading the file, some four seconds. `fast` is in the processor's floating point, `exact` and taut-verify
are over whole numbers of 30 bits, or more where tubes are thin. Others used the machine; what counts are ratios.

| path | boxes | taut-check, ms | **taut-verify, s** | check, fast, s | check, exact, s | verify / taut-check |
|---|---|---|---|---|---|---|
"""


def seconds(command, repeats):
    """The median of what the command took of the processor, and its output."""
    taken = []
    for _ in range(repeats):
        with tempfile.TemporaryFile() as output:
            process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0)
            text = output.read().decode()
            assert process.returncode == 0, (command, text)
            taken.append(usage.ru_utime + usage.ru_stime)
    return statistics.median(taken), text


def coqc(folder, text):
    file = os.path.join(folder, "asked.v")
    with open(file, "w", encoding="utf-8") as out:
        out.write(text)
    return seconds(["coqc", "-q", "-Q", LIBRARY, "Taut", file], REPEATS)[0]


def row(case, folder):
    certificate, written, boxes = (os.path.join(folder, name) for name in ("certificate.json", "path.v", "boxes.json"))
    command = "audit" if "/audits/" in case else "plan"
    seconds([TAUT, command, case, "--out", folder, "--no-report", "--headroom", "0"], 1)
    said = seconds([TAUT, "formal", certificate, "--no-coq", "--out", written, "--boxes", boxes], 1)[1]
    check, verify = (seconds(command, REPEATS)[0]
                     for command in ([CHECK, certificate], [VERIFY, certificate, boxes]))
    with open(written, encoding="utf-8") as file:
        exact = file.read()
    head = exact[:exact.index("Theorem feasible")]
    nothing = coqc(folder, head)
    times = [coqc(folder, head + f"Goal {name}.check cert = true. Proof. vm_compute. reflexivity. Qed.\n") - nothing
             for name in ("Fast", "Exact")]
    count = re.search(r"\((\d+) box", said).group(1)
    name = os.path.basename(case)[:-5]
    return (f"| {name} | {count} | {1e3 * check:.0f} | {verify:.2f} | {max(times[0], 0):.1f} | {max(times[1], 0):.1f} "
            f"| {verify / check:.0f} |")


def main():
    rows = []
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            rows.append(row(case, folder))
            print(rows[-1], flush=True)
    with open(os.path.join(RESULTS, "formal.md"), "w", encoding="utf-8") as file:
        file.write(HEAD + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
