#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps in parts: shards, files of parts that are not what they should be, runs that were ended, ranks under mpirun.

Usage: parts_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from command_line import CASES, ROBOT1, TAUT, InFolder, main, run, text_of

SLICE = (ROBOT1, "--cell", "0.004")
# Some seconds of one processor.
LONG = (os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml"), "--undecided", "25%")
# Longer, so that every one of several ranks has begun long before they end.
LONGER = (LONG[0], "--undecided", "6%")
SPHERE = (os.path.join(CASES, "robot2-sphere-sigma-free-q2-q3.yaml"), "--cell", "0.02", "--undecided", "30%")
# As root, and with more ranks than cores.
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


def content(path):
    with open(path, "rb") as file:
        return file.read()


def change(path, changed):
    with open(path, "rb") as file:
        before = file.read()
    with open(path, "wb") as file:
        file.write(changed(before))


def without_times(text):
    found = json.loads(text)
    for key in ("elapsed_seconds", "map_seconds", "files"):
        del found[key]
    return found


MAPS = {}  # what one process makes, by its arguments: several tests compare with it
SLICE_PARTS = {}  # the content of each of its files


class Parts(InFolder):
    def done(self, *arguments):
        said = run(TAUT, "map", *arguments)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        return said.stdout

    def made(self, name, *arguments, command=(), **options):
        """All that a map comes to: its JSON without times, and its files."""
        folder = self.path(name)
        files = ["--out", folder, "--grid", os.path.join(folder, "g.npy"), "--grid-size", "64"]
        is_flat = ROBOT1 in arguments
        if is_flat:
            files += ["--polygons", os.path.join(folder, "p.json")]
        os.makedirs(folder)
        said = run(*command, TAUT, "map", *arguments, *files, "--json", **options)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        names = ("map.svg", "g.npy", "g.npy.json", "p.json") if is_flat else ("map.html", "g.npy", "g.npy.json")
        return without_times(said.stdout), [content(os.path.join(folder, name)) for name in names]

    def one(self, *arguments):
        """What one process makes, which is computed once."""
        if arguments not in MAPS:
            MAPS[arguments] = self.made("one" + "".join(arguments[1:]), *arguments)
        return MAPS[arguments]

    def slice_parts(self):
        """A folder of all parts of SLICE, which are computed once."""
        parts = self.path("parts")
        if not SLICE_PARTS:
            self.shards(parts, 1, *SLICE)
            SLICE_PARTS.update({name: content(os.path.join(parts, name)) for name in os.listdir(parts)})
            return parts
        os.makedirs(parts)
        for name, text in SLICE_PARTS.items():
            with open(os.path.join(parts, name), "wb") as file:
                file.write(text)
        return parts

    def shards(self, parts, count, *arguments):
        for k in range(1, count + 1):
            self.done(*arguments, "--shard", f"{k}/{count}", "--parts", parts)

    def refused(self, parts, expected, *more):
        said = run(TAUT, "map", *SLICE, "--merge", "--parts", parts, *more)
        self.assertEqual(said.returncode, 3, said.stdout + said.stderr)
        self.assertNotIn("Map of", said.stdout)
        for text in expected:
            self.assertIn(text, said.stderr)


class Shards(Parts):
    def test_make_the_map_of_one_process_bit_for_bit(self):
        one = self.one(*SLICE, "--undecided", "1e-9")
        self.assertEqual(one[0]["end"], "width")
        for count in (1, 3):
            parts = self.path(f"parts{count}")
            self.shards(parts, count, *SLICE)
            self.assertEqual(self.made(f"merged{count}", *SLICE, "--merge", "--parts", parts), one)
        # To a share, too: one process stops in the middle of a level.
        self.assertEqual(self.made("share", *SLICE, "--merge", "--parts", parts, "--undecided", "45%"),
                         self.one(*SLICE, "--undecided", "45%"))

    def test_compute_a_part_once(self):
        parts = self.path("parts")
        first = json.loads(self.done(*SLICE, "--shard", "1/2", "--parts", parts, "--json"))
        self.assertEqual(first["computed"], first["parts_of_shard"])
        self.assertEqual(len(os.listdir(parts)), first["computed"])
        before = {name: os.stat(os.path.join(parts, name)).st_mtime_ns for name in os.listdir(parts)}
        again = json.loads(self.done(*SLICE, "--shard", "1/2", "--parts", parts, "--json"))
        self.assertEqual((again["computed"], again["parts_of_shard"]), (0, first["computed"]))
        second = json.loads(self.done(*SLICE, "--shard", "2/2", "--parts", parts, "--json"))
        self.assertEqual(first["computed"] + second["computed"], second["parts"])
        self.assertEqual({name: os.stat(os.path.join(parts, name)).st_mtime_ns for name in before}, before)
        self.assertRegex(self.done(*SLICE, "--shard", "2/2", "--parts", parts),
                         r"Shard 2/2: \d+ of \d+ parts in .*, 0 of them computed now, in")

    def test_refuse_files_by_name_that_are_not_these_parts(self):
        parts, spare = self.slice_parts(), self.path("spare")
        names = sorted(os.listdir(parts))
        self.assertGreater(len(names), 20)
        self.assertEqual(names[7], "000007.taut-part")
        shutil.copytree(parts, spare)
        seven = os.path.join(parts, names[7])
        middle = max(names, key=lambda name: os.path.getsize(os.path.join(parts, name)))
        largest = os.path.join(parts, middle)

        def restored():
            shutil.rmtree(parts)
            shutil.copytree(spare, parts)

        os.remove(seven)
        self.refused(parts, [seven + ": got no such file, and 1 of", "parts missing in all"])
        restored()
        shutil.copy(os.path.join(parts, names[8]), seven)
        self.refused(parts, [seven + ": got part 8 of", "expected part 7 of"])
        restored()
        shutil.copy(seven, os.path.join(parts, "999999.taut-part"))
        self.refused(parts, ["999999.taut-part: got a part too many"])
        restored()
        change(largest, lambda text: text[:-1])
        self.refused(parts, [largest + ": got", "bytes, which is not the whole part"])
        restored()
        for at in (-1, -40, -200):
            change(largest, lambda text, at=at: text[:at] + bytes([text[at] ^ 1]) + text[len(text) + at + 1:])
            self.refused(parts, [largest + ": got a damaged part, whose SHA-256"])
            # A damaged part is not computed again in silence, either.
            said = run(TAUT, "map", *SLICE, "--shard", "1/1", "--parts", parts)
            self.assertEqual((said.returncode, said.stdout), (3, said.stdout))
            self.assertIn(largest + ": got a damaged part", said.stderr)
            restored()
        change(seven, lambda text: text.replace(b'"version":1', b'"version":2'))
        self.refused(parts, [seven + ": got format version 2, expected 1"])
        restored()
        change(seven, lambda text: text[1:])
        self.refused(parts, [seven + ": got another file or a damaged one"])
        restored()
        self.assertEqual(run(TAUT, "map", *SLICE, "--merge", "--parts", parts).returncode, 0)

    def test_no_bit_of_a_head_may_be_another(self):
        parts = self.slice_parts()
        part = os.path.join(parts, "000003.taut-part")
        good = content(part)
        for at in range(0, good.index(b"\n") + 1, 9):
            change(part, lambda text, at=at: good[:at] + bytes([good[at] ^ 2]) + good[at + 1:])
            self.refused(parts, [part + ": got "])
            change(part, lambda text: good)

    def test_refuse_parts_of_other_work(self):
        parts = self.slice_parts()
        other = self.write("other.yaml", re.sub(r"tension: \[[\d.]+", "tension: [0.051", text_of(ROBOT1)))
        self.assertNotEqual(text_of(other), text_of(ROBOT1))
        said = run(TAUT, "map", other, "--cell", "0.004", "--merge", "--parts", parts)
        self.assertEqual(said.returncode, 3)
        self.assertIn("got a part of other work, of which 'problem_sha256' is", said.stderr)
        said = run(TAUT, "map", ROBOT1, "--cell", "0.002", "--shard", "1/2", "--parts", parts)
        self.assertEqual(said.returncode, 3)
        self.assertIn("got a part of other work, of which 'cell' is 0.004, expected 0.002", said.stderr)

    def test_use_that_makes_no_sense(self):
        parts = self.path("parts")
        for arguments, expected in (
                (["--shard", "1/2"], "--parts"),
                (["--merge"], "--parts"),
                (["--shard", "0/2", "--parts", parts], "--shard: got '0/2', expected k/m"),
                (["--shard", "3/2", "--parts", parts], "--shard: got '3/2', expected k/m"),
                (["--shard", "1", "--parts", parts], "--shard: got '1', expected k/m"),
                (["--shard", "1/2x", "--parts", parts], "--shard: got '1/2x', expected k/m"),
                (["--shard", "1/2", "--merge", "--parts", parts], "--merge"),
                (["--parts", parts, "--budget", "5"], "--budget: got a number of seconds for a map in parts"),
                (["--shard", "1/2", "--parts", parts, "--undecided", "5%"], "--undecided: got a share for a shard")):
            said = run(TAUT, "map", *SLICE, *arguments)
            self.assertEqual(said.returncode, 3, arguments)
            self.assertIn(expected, said.stderr)


class Kept(Parts):
    def test_parts_that_are_kept_change_nothing(self):
        one = self.one(*SLICE, "--undecided", "60%")
        parts = self.path("parts")
        self.assertEqual(self.made("kept", *SLICE, "--undecided", "60%", "--parts", parts), one)
        self.assertEqual(self.made("again", *SLICE, "--undecided", "60%", "--parts", parts), one)
        self.assertEqual(self.made("merged", *SLICE, "--undecided", "60%", "--merge", "--parts", parts), one)
        self.refused(parts, ["got a part in which not all cells are judged"])
        self.refused(parts, ["got a part in which not all cells are judged"], "--undecided", "40%")
        # What is known already is where it goes on.
        self.assertEqual(self.made("finer", *SLICE, "--undecided", "40%", "--parts", parts),
                         self.one(*SLICE, "--undecided", "40%"))

    def test_three_coordinates(self):
        parts = self.path("parts")
        self.assertEqual(self.made("kept", *SPHERE, "--parts", parts), self.one(*SPHERE))

    def test_a_run_that_was_killed_goes_on(self):
        parts = self.path("parts")
        one = self.one(*LONG)
        with subprocess.Popen([TAUT, "map", *LONG, "--parts", parts], stdout=subprocess.DEVNULL) as process:
            while process.poll() is None and not (os.path.isdir(parts) and len(os.listdir(parts)) > 30):
                time.sleep(0.002)
            process.kill()
        self.assertEqual(process.returncode, -signal.SIGKILL, "it should take longer")
        self.assertEqual(self.made("resumed", *LONG, "--parts", parts), one)
        self.assertEqual([name for name in os.listdir(parts) if not name.endswith(".taut-part")], [])


@unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed (openmpi-bin)")
class UnderMpi(Parts):
    def setUp(self):
        super().setUp()
        self.environment = dict(os.environ, **MPI)

    def ranks(self, count, *LONG, flags=()):
        return run("mpirun", *flags, "-n", str(count), TAUT, *LONG, env=self.environment)

    def test_any_number_of_ranks_makes_the_map_of_one_process(self):
        arguments = (*SLICE, "--undecided", "45%")
        one = self.one(*arguments)
        for count in (1, 2, 3):
            self.assertEqual(self.made(f"ranks{count}", *arguments, command=("mpirun", "-n", str(count)),
                                       env=self.environment), one)

    def test_a_rank_that_dies_is_reported_and_its_parts_are_dealt_again(self):
        one = self.one(*LONGER)
        out = self.path("ranks")
        with subprocess.Popen(["mpirun", "--enable-recovery", "-n", "3", TAUT, "map", *LONGER, "--json", "--out",
                               out], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=self.environment) as process:
            os.kill(self.working_rank(process, "2"), signal.SIGKILL)
            stdout, stderr = process.communicate(timeout=300)
        self.assertRegex(stderr,
                         r"taut: rank 2 on \S+ is lost, because its process ended; \d+ of its parts dealt again")
        self.assertEqual((without_times(stdout), content(os.path.join(out, "map.html"))), (one[0], one[1][0]))

    def test_a_minute_of_silence_is_taken_for_death(self):
        """A rank that hangs, and rank 0 that dies: both take a minute, so that they are tried at once."""
        one = self.one(*LONGER)
        jobs = {}
        for name in ("hung", "headless"):
            with open(self.path(name + ".out"), "w") as out, open(self.path(name + ".err"), "w") as err:
                jobs[name] = subprocess.Popen(
                    ["mpirun", "--enable-recovery", "-n", "2", TAUT, "map", *LONGER, "--json",
                     "--out", self.path(name)],
                    stdout=out, stderr=err, env=self.environment)
        pids = {(name, rank): self.working_rank(jobs[name], rank) for name in jobs for rank in ("0", "1")}
        os.kill(pids["hung", "1"], signal.SIGSTOP)
        os.kill(pids["headless", "0"], signal.SIGKILL)
        begin = time.monotonic()
        while is_there(pids["hung", "0"]) and time.monotonic() - begin < 250:
            time.sleep(0.1)
        os.kill(pids["hung", "1"], signal.SIGCONT)  # mpirun waits for a process that hangs
        self.assertEqual(jobs["hung"].wait(60), 0)
        jobs["headless"].wait(60)
        self.assertRegex(text_of(self.path("hung.err")),
                         r"taut: rank 1 on \S+ is lost, because it was not heard of for 60 s; "
                         r"\d+ of its parts dealt again")
        self.assertEqual((without_times(text_of(self.path("hung.out"))), content(self.path("hung", "map.html"))),
                         (one[0], one[1][0]))
        self.assertRegex(text_of(self.path("headless.err")),
                         r"taut: rank 1 on \S+ ends, because rank 0 was not heard of for 60 s")
        self.assertEqual(text_of(self.path("headless.out")), "")
        self.assertFalse(os.path.exists(self.path("headless")), "nothing is written without rank 0")

    def working_rank(self, process, rank):
        """The process of a rank of mpirun that computes already."""
        while process.poll() is None:
            time.sleep(0.01)
            for pid in children(process.pid):
                if rank_of(pid) == rank and is_ready(pid):
                    return pid
        self.fail(f"rank {rank} ended too soon")
        return None

    def test_a_job_that_was_killed_goes_on(self):
        parts = self.path("parts")
        one = self.one(*LONG)
        with subprocess.Popen(["mpirun", "-n", "2", TAUT, "map", *LONG, "--parts", parts],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=self.environment) as process:
            while process.poll() is None and not (os.path.isdir(parts) and len(os.listdir(parts)) > 30):
                time.sleep(0.002)
            for pid in children(process.pid):
                os.kill(pid, signal.SIGKILL)
            process.wait(300)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(self.made("resumed", *LONG, "--parts", parts, command=("mpirun", "-n", "2"),
                                   env=self.environment), one)

    def test_bad_input_is_said_once(self):
        said = self.ranks(2, "map", ROBOT1, "--cell", "0.004", "--merge", "--parts", self.path("parts"))
        self.assertEqual(said.returncode, 3, said.stderr)
        self.assertEqual(said.stderr.count("mpirun: got 2 processes and --merge, expected one of them"), 1)
        said = self.ranks(3, "map", self.path("none.yaml"))
        self.assertEqual(said.returncode, 3, said.stderr)
        self.assertEqual(said.stderr.count("none.yaml: could not read"), 1)


class Regress(InFolder):
    def setUp(self):
        super().setUp()
        self.cases = self.path("cases")
        os.makedirs(self.cases)
        for name in ("robot1-slice-qs1-qg", "robot1-slice-qs2-qg", "robot2-sphere-q1-q2"):
            shutil.copy(os.path.join(CASES, name + ".yaml"), self.cases)

    def found(self, *arguments, code=0, command=(), **options):
        said = run(*command, TAUT, "regress", self.cases, *arguments, "--json", **options)
        self.assertEqual(said.returncode, code, said.stdout + said.stderr)
        found = json.loads(said.stdout)
        for entry in found["cases"]:
            del entry["elapsed_seconds"]
        del found["elapsed_seconds"]
        return found

    def test_shards_make_the_result_of_one_process(self):
        one = self.found()
        parts = self.path("parts")
        self.assertEqual([entry["case"] for entry in self.found("--shard", "1/2", "--parts", parts)["cases"]],
                         ["robot1-slice-qs1-qg.yaml", "robot2-sphere-q1-q2.yaml"])
        said = run(TAUT, "regress", self.cases, "--merge", "--parts", parts)
        self.assertEqual(said.returncode, 3)
        self.assertIn("000001.taut-part: got no such file, and 1 of 3 parts missing", said.stderr)
        self.found("--shard", "2/2", "--parts", parts)
        self.assertEqual(self.found("--merge", "--parts", parts), one)
        # What is finished is not run again.
        before = os.stat(os.path.join(parts, "000000.taut-part")).st_mtime_ns
        self.assertEqual(self.found("--parts", parts), one)
        self.assertEqual(os.stat(os.path.join(parts, "000000.taut-part")).st_mtime_ns, before)
        # Another case is other work.
        with open(os.path.join(self.cases, "robot2-sphere-q1-q2.yaml"), "a", encoding="utf-8") as file:
            file.write("# changed\n")
        said = run(TAUT, "regress", self.cases, "--merge", "--parts", parts)
        self.assertEqual(said.returncode, 3)
        self.assertIn("got a part of other work, of which 'cases_sha256' is", said.stderr)

    def test_another_mesh_is_other_work(self):
        shutil.rmtree(self.cases)
        os.makedirs(self.cases)
        for name in ("inside-a-mesh.yaml", "sphere.stl"):
            shutil.copy(os.path.join(CASES, "bodies", name), self.cases)
        parts = self.path("parts")
        self.found("--parts", parts)
        with open(os.path.join(self.cases, "sphere.stl"), "r+b") as file:
            file.write(b"other")  # of the header, which means nothing
        said = run(TAUT, "regress", self.cases, "--parts", parts)
        self.assertEqual(said.returncode, 3, said.stdout)
        self.assertIn("got a part of other work, of which 'cases_sha256' is", said.stderr)

    def test_the_exit_code_of_all_is_that_of_the_merge(self):
        parts = self.path("parts")
        with open(os.path.join(self.cases, "robot1-slice-qs2-qg.yaml"), encoding="utf-8") as file:
            text = file.read()
        with open(os.path.join(self.cases, "robot1-slice-qs2-qg.yaml"), "w", encoding="utf-8") as file:
            file.write(re.sub(r"^expect:.*", "expect: refuted", text, flags=re.M))
        self.found("--shard", "1/2", "--parts", parts)
        self.found("--shard", "2/2", "--parts", parts, code=1)
        self.assertEqual(self.found("--merge", "--parts", parts, code=1)["as_declared"], 2)
        said = run(TAUT, "regress", self.cases, "--shard", "1/2", "--parts", parts, "--junit", self.path("x.xml"))
        self.assertEqual(said.returncode, 3)
        self.assertIn("--junit: got a file for a shard, expected it with --merge", said.stderr)

    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed (openmpi-bin)")
    def test_ranks_make_the_result_of_one_process(self):
        self.assertEqual(self.found(command=("mpirun", "-n", "2"), env=dict(os.environ, **MPI)), self.found())


def children(pid):
    with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
        return [int(child) for child in file.read().split()]


def is_there(pid):
    """Whether a process runs, or is stopped; one that ended and was not waited for does not."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def rank_of(pid):
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:
            return dict(entry.split(b"=", 1) for entry in file.read().split(b"\0") if b"=" in entry).get(
                b"OMPI_COMM_WORLD_RANK", b"").decode()
    except OSError:
        return ""


def is_ready(pid):
    """Whether it computes already: it has used some processor time on more than one thread."""
    try:
        threads = os.listdir(f"/proc/{pid}/task")
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:
            ticks = int(file.read().rsplit(")", 1)[1].split()[11])
    except OSError:
        return False
    return len(threads) > 2 and ticks > 15


if __name__ == "__main__":
    main()
