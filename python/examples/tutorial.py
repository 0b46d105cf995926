#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans a case, looks at the path, and audits one of one's own: tutorial.py [CASE.yaml [FOLDER]]

Writes plan.png, audit.png, certificate.json and report.html into FOLDER (default: here). CASE has the parameters phi
and theta; the default is cases/robot1-slice-qs-qg.yaml.
"""
import pathlib
import sys

import matplotlib
import numpy as np

import taut

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (behind the choice of what draws)

root = pathlib.Path(__file__).resolve().parents[2]
case_file = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "cases" / "robot1-slice-qs-qg.yaml"
out = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(".")


def draw_tensions(axes, samples, limits):
    """Draws each cable's tensions over all wrenches of the load, and its limits. These are floating-point samples; the
    proof is in the certificate."""
    for cable in range(6):
        axes.fill_between(samples.position, samples.tension_lower_N[:, cable], samples.tension_upper_N[:, cable],
                          alpha=0.6, label=f"cable {cable + 1}")
    for limit in np.unique(limits):
        axes.axhline(limit, color="black", linestyle="--")
    axes.set(xlabel="segment", ylabel="tension [N]")
    axes.legend(ncols=3, fontsize="small")


# 1. Plan. The certificate has the path and the proof.
case = taut.Case.load(case_file)
plan = taut.plan(case, progress=lambda stage, done, total: print(f"{stage}: {done} charts", file=sys.stderr))
print(plan)
print("proved margins:", plan.theorem.margins)
plan.save(out / "certificate.json")
(out / "report.html").write_text(taut.report(plan), encoding="utf-8")

# 2. Somebody else proves it again.
print("checker:", taut.check(out / "certificate.json", case).message)

# 3. Look at it.
parameters = plan.path.parameters
figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5), layout="constrained")
left.plot(parameters[:, 0], parameters[:, 1], "o-", markersize=3)
left.set(xlabel=case.parameters[0] + " [rad]", ylabel=case.parameters[1] + " [rad]", title="the planned path")
draw_tensions(right, plan.samples(400), case.tension_limits_N)
figure.savefig(out / "plan.png", dpi=100)

# 4. A path of one's own: from start to goal without a detour.
steps = np.linspace(0, 1, 21)[:, np.newaxis]
straight = (1 - steps) * parameters[0] + steps * parameters[-1]
audit = taut.audit(case, {"phi[rad]": straight[:, 0], "theta[rad]": straight[:, 1]}, name="straight")
print(audit)
figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
draw_tensions(axes, audit.samples(400), case.tension_limits_N)
axes.set_ylim(-1, 2)
for stretch in audit.stretches:
    axes.axvspan(stretch.begin.position, stretch.end.position, color="red", alpha=0.2)
    why = stretch.reason
    if stretch.violations:
        first = stretch.violations[0]
        why = f"{first.kind}" + (f" of cable {first.cable}: {first.value[1]:.3g} N" if first.cable else "")
    print(f"  not proved from {stretch.begin.position:.3f} to {stretch.end.position:.3f}: {why}")
figure.savefig(out / "audit.png", dpi=100)

# 5. The same waypoints as the planner's, reversed: a proof needs no planner.
back = taut.prove(case, plan.path.waypoints[::-1], half_turns=plan.path.half_turns[::-1])
print("and back:", back.verdict)
