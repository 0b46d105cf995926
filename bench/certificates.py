#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a certificate costs from a cold process: planned, proved and checked by taut, then checked by taut-check.

Time is of all processors that a process used, user and system, so that it is what a certificate takes of a machine that
makes nothing else; processes run one after the other. A million certificates a day are 86.4 ms of a processor each.

Usage: certificates.py RESULTS TAUT TAUT_CHECK [--quick]     writes RESULTS/certificates.md
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

RESULTS, TAUT, CHECK = sys.argv[1:4]
QUICK = "--quick" in sys.argv[4:]
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cases")
# Two and six free coordinates, no path, load items, tolerances.
PLANS = ("robot1-slice-qs-qg.yaml", "robot2-sphere-q2-q3.yaml", "robot1-free-box-qs-qg.yaml",
         "maps/robot1-sigma34-apart.yaml", "cranes/portal-20t.yaml", "tutorial/04-tolerances.yaml")
REPEATS = 3 if QUICK else 7
MS_OF_A_DAY = 86_400_000
A_DAY = 1_000_000


def processor_ms(command, codes):
    """What the command took of all processors, user and system [ms], its output and its peak of memory [MB]."""
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.returncode in codes, (command, process.returncode)
        output.seek(0)
        return 1e3 * (usage.ru_utime + usage.ru_stime), output.read(), usage.ru_maxrss / 1024


def size_of(folder):
    """The bytes of all files."""
    return sum(os.path.getsize(os.path.join(where, name)) for where, _, names in os.walk(folder) for name in names)


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), "unknown")
    return f"{model}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.0f} at the end."


def row_of(name):
    case = os.path.join(CASES, name)
    plans, bare, checks, peak = [], [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        for _ in range(REPEATS):
            ms, output, memory = processor_ms([TAUT, "plan", case, "--out", out, "--json"], (0, 1))
            plans.append(ms)
            peak = max(peak, memory)
            checks.append(processor_ms([CHECK, os.path.join(out, "certificate.json"), case], (0,))[0])
            bare.append(processor_ms([TAUT, "plan", case, "--out", os.path.join(folder, "bare"), "--json",
                                      "--max-seconds", "0", "--headroom", "0"], (0, 1, 2))[0])
        summary = json.loads(output)
        kilobytes = size_of(out) / 1e3
        certificate = os.path.getsize(os.path.join(out, "certificate.json")) / 1e3
    plan, least, check = (statistics.median(of) for of in (plans, bare, checks))
    return (f"| {name} | {summary['verdict']} | {plan:.0f} | {least:.0f} | {check:.0f} | "
            f"{(plan + check) * A_DAY / MS_OF_A_DAY:.1f} | {(least + check) * A_DAY / MS_OF_A_DAY:.1f} | {peak:.0f} | "
            f"{kilobytes:.0f} | {certificate:.0f} |")


def main():
    lines = ["# What a certificate costs", "",
             f"`bench/certificates.py`: medians of {REPEATS} cold processes, milliseconds of processor time (user and",
             "system, all threads). *plan* is `taut plan`, with its check, headroom and report; *bare* is the same",
             "with `--max-seconds 0 --headroom 0`, for whoever has `taut-check` check all the same; *check* is",
             "`taut-check` with the case. Processors are what a million a day take: by plan and check, or by bare and",
             "check. Memory is the most that `taut plan` used [MB], files are all that it wrote, the certificate among",
             "them [kB].", "",
             "| case | verdict | plan | bare | check | processors | or bare | memory | files | certificate |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for name in PLANS:
        lines.append(row_of(name))
    lines[2:2] = [machine(), ""]
    text = "\n".join(lines) + "\n"
    with open(os.path.join(RESULTS, "certificates.md"), "w", encoding="utf-8") as file:
        file.write(text)
    print(text)


if __name__ == "__main__":
    main()
