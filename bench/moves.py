#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves: time laws beside an independent optimum, what jerks cost, proofs of timed paths beside untimed ones, the
greatest speed that is proved, and how long a monitor takes for a row.

Usage: moves.py RESULTS TAUT MOVE_PROOFS [--quick]     writes RESULTS/moves.md; needs python3-numpy and python3-scipy
"""
import json
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile

from move_optimum import duration, fastest, greatest_jerk

RESULTS, TAUT, PROOFS = sys.argv[1:4]
QUICK = "--quick" in sys.argv[4:]
POINTS = 300 if QUICK else 1000
ROWS = 100_000
FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cases", "moves")
CASES = ["portal-20t", "portal-20t-may-stop", "hexacrane", "hexacrane-on-equations", "roboprinter"]


WORDS = ["""# Moves

`bench/moves.py` on PROCESSOR, CORES cores that others used: times are processor times, of all threads, and what counts
are ratios within this run.

The optimum is that of `bench/move_optimum.py`, which reads a certificate and has nothing else of taut's: its own
kinematics and dynamics (of particles), POINTS intervals of arc length, a linear program (HiGHS), no limit of jerk,
no slack and no deviations, so that no proved law can be faster. The law is the one that is proved, along the same path.
Without a limit of jerk the law is smooth all the same. Jerks are those of the load point.""",
         """The path of each plan with its law and without it, by the same prover in turns (`bench/move_proofs.cc`),
medians of REPEATS runs.""",
         """`--max-speed`: shares of the planned speed. The bracket is between the fastest move that is proved and the
slowest that is refuted.""",
         """The table `winches.csv` without times, again and again, less the start (one row), divided by rows; reading
are part of it, and the start has the checker's proof."""]


def text_of(name):
    with open(name, encoding="utf-8") as file:
        return file.read()


def case(folder, name, change=lambda text: text):
    path = os.path.join(folder, name + ".yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(change(text_of(os.path.join(FOLDER, name.split("@")[0] + ".yaml"))))
    return path


def run(*command, stdin=None):
    """What it prints, and the processor time that it took, of all threads."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = subprocess.run(command, stdin=stdin, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert said.returncode == 0, said.stdout + said.stderr
    return said.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def plan(path, out, *options):
    said, seconds = run(TAUT, "plan", path, "--out", out, "--no-report", "--json", *options)
    summary = json.loads(said)
    assert summary["verdict"] == "proved", summary
    return summary, json.loads(text_of(os.path.join(out, "certificate.json"))), seconds


def processor():
    model = re.search(r"model name\s*:\s*(.*)", text_of("/proc/cpuinfo"))
    return model.group(1) if model else "an unknown processor"


def laws(folder):
    yield ("| case | optimum, s | law, s | **law / optimum** | without limit of jerk "
           "| jerk / limit | laws tried | whole plan, s |")
    yield "|---|---|---|---|---|---|---|---|"
    for name in CASES:
        out = os.path.join(folder, name)
        plans = [plan(case(folder, name), out) for _ in range(1 if QUICK else 3)]
        summary, certificate, _ = plans[0]
        _, other, _ = plan(case(folder, name + "@vast", lambda text: re.sub(r"\n  jerk:.*", "", text)), out + "@vast")
        assert certificate["path"]["waypoints"] == other["path"]["waypoints"]
        text = text_of(os.path.join(FOLDER, name + ".yaml"))
        value, unit = re.search(r"\n  jerk: ([\d.]+) (c?)m/s\^3", text).groups()
        limit = float(value) * (0.01 if unit else 1)
        best, law = fastest(certificate, POINTS), duration(certificate)
        yield (f"| {name} | {best:.3f} | {law:.3f} | **{law / best:.3f}** | {duration(other) / best:.3f} | "
               f"{greatest_jerk(certificate) / limit:.2f} | {summary['move']['tries']} | "
               f"{statistics.median(seconds for _, _, seconds in plans):.1f} |")


def proofs():
    yield "| case | boxes, timed | untimed | proof, ms, timed | untimed | **timed / untimed** | quartiles |"
    yield "|---|---|---|---|---|---|---|"
    said, _ = run(PROOFS, *(["--quick"] if QUICK else []))
    for of in json.loads(said):
        yield (f"| {of['case']} | {of['timed_boxes']} | {of['untimed_boxes']} | {of['timed_ms']:.2f} | "
               f"{of['untimed_ms']:.2f} | **{of['ratio']:.1f}** | {of['low']:.1f} to {of['high']:.1f} |")


def greatest_speeds(folder):
    yield "| case | proved at | refuted at | **bracket** |"
    yield "|---|---|---|---|"
    for name in CASES:
        summary, _, _ = plan(case(folder, name), os.path.join(folder, name + "@max"), "--max-speed")
        speed = summary["move"]["greatest_speed"]
        proved, refuted = speed["proved_share"], speed["refuted_share"]
        bracket = f"{100 * (refuted / proved - 1):.2f} %" if refuted else "-"
        yield f"| {name} | {proved:.4f} | {f'{refuted:.4f}' if refuted else '-'} | **{bracket}** |"


def latencies(folder):
    """Per row: of many rows by a table's own, less what the same takes with few: processor time."""
    yield "| case | columns | rows | start, s | **a row, us** |"
    yield "|---|---|---|---|---|"
    for name in CASES:
        out = os.path.join(folder, name)
        lines = [x for x in text_of(os.path.join(out, "winches.csv")).splitlines() if not x.startswith("#")]
        wanted = [k for k, x in enumerate(lines[0].split(",")) if re.match(r"(t|l\d)\[", x)]
        rows = [",".join(line.split(",")[k] for k in wanted) for line in lines]
        header, body = rows[0], [row.split(",", 1)[1] for row in rows[1:]]
        without_t = header.split(",", 1)[1]
        many = os.path.join(folder, "many.csv")
        few = os.path.join(folder, "few.csv")
        count = 2000 if QUICK else ROWS
        for path, number in ((many, count), (few, 1)):
            with open(path, "w", encoding="utf-8") as file:
                file.write(without_t + "\n" + "".join(body[k % len(body)] + "\n" for k in range(number)))
        times = []
        start = []
        for _ in range(1 if QUICK else 3):
            options = ("--length-error", "0.1mm")
            long, short = (run(TAUT, "monitor", os.path.join(out, "certificate.json"), path, *options)[1]
                           for path in (many, few))
            times.append(1e6 * (long - short) / count)
            start.append(short)
        yield f"| {name} | lengths | {count} | {statistics.median(start):.2f} | **{statistics.median(times):.1f}** |"


def main():
    with tempfile.TemporaryDirectory() as folder:
        sections = [("", laws(folder)), ("## Proofs", proofs()), ("## The greatest speed", greatest_speeds(folder)),
                    ("## A monitor's rows", latencies(folder))]
        lines = []
        for (head, table), text in zip(sections, WORDS):
            lines += [head, ""] if head else []
            lines += [text.strip().replace("PROCESSOR", processor()).replace("CORES", str(os.cpu_count()))
                      .replace("POINTS", str(POINTS)).replace("REPEATS", "3" if QUICK else "15"), "", *table, ""]
            print("\n".join(lines[-8:]), file=sys.stderr, flush=True)
    with open(os.path.join(RESULTS, "moves.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


main()
