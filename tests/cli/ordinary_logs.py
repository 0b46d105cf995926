#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs as controllers write them: a move of the crane that `taut init` writes, a row every few milliseconds, with
decimals as programs print them, and rows in which the platform rests before and after the move.

Usage: ordinary_logs.py FOLDER   writes one log of 60 s at 100 Hz (6,001 rows) in each format into FOLDER
"""
import math
import os
import sys

# The crane of `taut init`: anchors in metres, in workshop axes and in the platform's.
BASE = [(0, 3, 8), (0, 3, 8), (-2.598, -1.5, 8), (-2.598, -1.5, 8), (2.598, -1.5, 8), (2.598, -1.5, 8)]
PLATFORM = [(-.866, .5, 0), (.866, .5, 0), (0, -1, 0), (-.866, .5, 0), (.866, .5, 0), (0, -1, 0)]
BEGIN = (0, 0, 2.0, 0)  # px, py, pz [m], yaw [rad]
END = (.5, -.3, 3.5, math.radians(12))


def share(seconds, rest_s, move_s):
    """How much of the move is behind the platform after so many seconds: from rest to rest, without a jerk."""
    u = min(max((seconds - rest_s) / move_s, 0), 1)
    return u ** 3 * (10 - 15 * u + 6 * u * u)


def poses(rows=6001, hertz=100, rest_s=3):
    """(row number, px, py, pz [m], yaw [rad]) of each row."""
    move_s = (rows - 1) / hertz - 2 * rest_s
    for k in range(rows):
        s = share(k / hertz, rest_s, move_s)
        yield (k, *(a + s * (b - a) for a, b in zip(BEGIN, END)))


def lengths(px, py, pz, yaw):
    """The cables' lengths [m] at a level pose."""
    c, s = math.cos(yaw), math.sin(yaw)
    return [math.dist(a, (px + c * b[0] - s * b[1], py + s * b[0] + c * b[1], pz + b[2]))
            for a, b in zip(BASE, PLATFORM)]


def angles(hertz=100, **what):
    """Millimetres and degrees, as spreadsheets and the controllers of cranes write them."""
    lines = ["t [s], px [mm], py [mm], pz [mm], phi [deg], theta [deg], sigma [deg]"]
    lines += [f"{k / hertz:.3f}, {1e3 * x:.2f}, {1e3 * y:.2f}, {1e3 * z:.2f}, 0.000, 0.000, {math.degrees(yaw):.3f}"
              for k, x, y, z, yaw in poses(hertz=hertz, **what)]
    return "\n".join(lines) + "\n"


def quaternions(hertz=100, **what):
    """Metres and quaternions behind the clock's time since 1970, between semicolons."""
    lines = ['"time [s]";"px [m]";"py [m]";"pz [m]";"qx";"qy";"qz";"qw"']
    lines += [f"{1760000000 + k / hertz:.3f};{x:.5f};{y:.5f};{z:.5f};0.000000;0.000000;{math.sin(yaw / 2):.6f};"
              f"{math.cos(yaw / 2):.6f}" for k, x, y, z, yaw in poses(hertz=hertz, **what)]
    return "\r\n".join(lines) + "\r\n"


def winches(hertz=100, **what):
    """What winches' encoders say: lengths in millimetres between tabs, times in milliseconds."""
    lines = ["\t".join(["t[ms]"] + [f"l{i}[mm]" for i in range(1, 7)])]
    lines += ["\t".join([f"{1000 * k // hertz}"] + [f"{1e3 * length:.3f}" for length in lengths(*pose)])
              for k, *pose in poses(hertz=hertz, **what)]
    return "\n".join(lines) + "\n"


def trajectory(hertz=100, **what):
    """The TUM format of robotics."""
    lines = ["# timestamp tx ty tz qx qy qz qw"]
    lines += [f"{k / hertz:.6f} {x:.6f} {y:.6f} {z:.6f} 0 0 {math.sin(yaw / 2):.7f} {math.cos(yaw / 2):.7f}"
              for k, x, y, z, yaw in poses(hertz=hertz, **what)]
    return "\n".join(lines) + "\n"


LOGS = {"angles.csv": angles, "quaternions.csv": quaternions, "winches.tsv": winches, "trajectory.tum": trajectory}


def main():
    for name, text in LOGS.items():
        with open(os.path.join(sys.argv[1], name), "w", encoding="utf-8", newline="") as file:
            file.write(text())


if __name__ == "__main__":
    main()
