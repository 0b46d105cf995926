#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulates how parts of a map are dealt to many ranks, from the sizes of parts that taut made, and prints Markdown.

How much work each part is comes from files of parts (`taut map CASE --shard 1/1 --parts FOLDER`): the nodes of its
tree are the cells that were judged. The work is scaled to a map of so many cells. A schedule is that of
shards/ranks.cc: a rank that is free gets the next part. Deaths are drawn with a seed of their own, so that the same
folder gives the same tables.

Usage: clusters.py [--cells CELLS] [--rate CELLS_PER_SECOND] [--seed SEED] FOLDER
"""
import argparse
import heapq
import json
import os
import random

RANKS = (1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024)
NOT_JUDGED, HAS_REASON = 6, 0x40


def judged_cells(path):
    """The cells that were judged for a part: the nodes of its tree (map/parts.h)."""
    with open(path, "rb") as file:
        head = json.loads(file.readline())
        tree = file.read()
    assert head["format"] == "taut-part" and head["work"]["command"] == "map" and head["bytes"] == len(tree), path
    count = at = 0
    while at < len(tree):
        byte = tree[at]
        at += 1 + (byte & HAS_REASON != 0)
        if byte & 7 == NOT_JUDGED:
            at += 4
        else:
            count += 1
    return count


def dealt(times, ranks, deaths=(), silence=0):
    """The makespan where a free rank gets the next part. Who dies while computing loses the part, which is dealt again
    when the rank has been silent for so long. Deaths are (time, rank)."""
    dies = {}
    for time, rank in deaths:
        dies[rank] = min(time, dies.get(rank, time))
    queue, again = list(reversed(times)), []  # again: (time from which, duration)
    free = [(0.0, rank) for rank in range(ranks)]
    heapq.heapify(free)
    end = 0.0
    while queue or again:
        assert free, "all ranks have died"
        now, rank = heapq.heappop(free)
        if again and (again[0][0] <= now or not queue):
            since, duration = heapq.heappop(again)
            now = max(now, since)
        else:
            duration = queue.pop()
        if rank in dies and now + duration > dies[rank]:
            heapq.heappush(again, (max(now, dies[rank]) + silence, duration))
            continue
        end = max(end, now + duration)
        heapq.heappush(free, (now + duration, rank))
    return end


def in_shards(times, ranks):
    """The makespan where shard k of m has the parts k, k + m, …, and each rank a shard."""
    return max(sum(times[shard::ranks]) for shard in range(ranks))


def drawn_deaths(ranks, share, makespan, seed):
    """That this share of all ranks dies, but for rank 0, each at some time of the run."""
    generator = random.Random(seed)
    count = round(share * ranks)
    if count == 0:
        return []
    return [(generator.uniform(0, makespan), rank) for rank in generator.sample(range(1, ranks), count)]


def seconds(value):
    return f"{value:,.1f}" if value < 100 else f"{value:,.0f}"


def table(sizes, cells, rate, seed):
    scale = cells / sum(sizes)
    times = [size * scale / rate for size in sizes]
    largest_first = sorted(times, reverse=True)
    total = sum(times)
    print(f"{len(times)} parts, {cells:.3g} cells at {rate:,.0f} a second and rank: {seconds(total)} s of one rank. "
          f"The largest part is {100 * max(times) / total:.2f} % of all, {seconds(max(times))} s.\n")
    print("| ranks | ideal, s | largest first, s | in order, s | static, s | largest first, % | static, % | "
          "5 % die, s |")
    print("|---|---|---|---|---|---|---|---|")
    for ranks in RANKS:
        ideal = total / ranks
        best, ordinary, static = dealt(largest_first, ranks), dealt(times, ranks), in_shards(times, ranks)
        lossy = dealt(largest_first, ranks, drawn_deaths(ranks, 0.05, best, seed), silence=60)
        print(f"| {ranks} | {seconds(ideal)} | {seconds(best)} | {seconds(ordinary)} | {seconds(static)} | "
              f"{100 * ideal / best:.0f} % | {100 * ideal / static:.0f} % | {seconds(lossy)} |")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder")
    parser.add_argument("--cells", type=float, default=1e9)
    parser.add_argument("--rate", type=float, default=2e5, help="cells a second and rank (bench/results/map.md)")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    files = sorted(name for name in os.listdir(arguments.folder) if name.endswith(".taut-part"))
    sizes = [judged_cells(os.path.join(arguments.folder, name)) for name in files]
    tree_bytes = sum(os.path.getsize(os.path.join(arguments.folder, name)) for name in files)
    print(f"Measured: {len(sizes)} parts, {sum(sizes)} cells judged, {tree_bytes / sum(sizes):.2f} bytes of files a "
          f"judged cell.\n")
    table(sizes, arguments.cells, arguments.rate, arguments.seed)


if __name__ == "__main__":
    main()
