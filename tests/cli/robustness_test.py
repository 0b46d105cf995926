#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the outside world does to taut: kill -9, full and read-only disks, no terminal, no memory, two at once.

Whatever it is, a result that is there is whole, and what was there before is replaced by a whole one or not at all.

Usage: robustness_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import json
import os
import random
import shutil
import stat
import subprocess
import time
import unicodedata
import unittest

from command_line import CASES, CHECK, InFolder, TAUT, main, run, text_of

CASE = os.path.join(CASES, "robot1-slice-qs-qg.yaml")
AUDITED = os.path.join(CASES, "audits", "robot1-planned.yaml")
RESULTS = ("certificate.json", "controller.csv", "path.csv", "report.html")


def may_mount():
    return os.geteuid() == 0 and subprocess.run(["unshare", "--mount", "true"], capture_output=True,
                                                check=False).returncode == 0


class Robustness(InFolder):
    def assert_whole(self, folder):
        """Every result that is there is whole."""
        for name in RESULTS:
            path = os.path.join(folder, name)
            if not os.path.exists(path):
                continue
            text = text_of(path)
            if name == "certificate.json":
                self.assertIn("footer", json.loads(text))
                self.assertEqual(run(CHECK, path).returncode, 0)
            self.assertTrue(text.endswith("</html>\n") if name == "report.html" else text.endswith("\n"), name)

    def test_a_kill_at_any_moment_leaves_whole_files(self):
        begin = time.monotonic()
        self.assertEqual(run(TAUT, "plan", CASE, "--out", self.path("whole")).returncode, 0)
        usual = time.monotonic() - begin
        chance = random.Random(20261121)
        ended = set()
        for number in range(40):
            command = [TAUT, "plan", CASE] if number % 2 else [TAUT, "audit", AUDITED]
            with subprocess.Popen([*command, "--out", self.path("out")], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as process:
                time.sleep(chance.uniform(0, 1.2 * usual))
                process.kill()
                ended.add(process.wait())
            if os.path.exists(self.path("out")) and number % 8 == 7:
                self.assert_whole(self.path("out"))
        self.assertIn(-9, ended)
        self.assert_whole(self.path("out"))
        left = [name for name in os.listdir(self.path("out")) if not name.endswith(".part")]
        self.assertLessEqual(set(left), set(RESULTS))
        self.assertEqual(run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out")).returncode, 0)
        self.assert_whole(self.path("out"))
        run(TAUT, "audit", AUDITED, "--out", self.path("out"))
        self.assertLessEqual(set(os.listdir(self.path("out"))), set(RESULTS), "what was left behind is removed")

    def test_two_at_once_in_one_folder_leave_whole_files(self):
        processes = [subprocess.Popen([TAUT, "plan", CASE, "--out", self.path("out")], stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL) for _ in range(6)]
        self.assertEqual([process.wait(timeout=120) for process in processes], [0] * 6)
        self.assertEqual(set(os.listdir(self.path("out"))), set(RESULTS))
        self.assert_whole(self.path("out"))

    @unittest.skipUnless(may_mount(), "takes the right to mount")
    def test_a_full_disk_is_said_and_keeps_what_was_there(self):
        self.assertEqual(run(TAUT, "plan", CASE, "--out", self.path("before")).returncode, 0)
        certificate = self.path("before", "certificate.json")
        size = os.path.getsize(certificate)
        # Room for one certificate and not for a second beside it.
        script = ('mount -t tmpfs -o size="$4" tmpfs "$1" && cp "$2" "$1/" && "$3" plan "$5" --out "$1"; code=$?; '
                  'cmp "$2" "$1/certificate.json" || exit 99; ls "$1"; exit $code')
        os.mkdir(self.path("disk"))
        ran = run("unshare", "--mount", "bash", "-c", script, "bash", self.path("disk"), certificate, TAUT,
                  str(size + 40_000), CASE)
        self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
        self.assertIn("No space left on device", ran.stderr)
        self.assertTrue(ran.stdout.endswith("\ncertificate.json\n"), ran.stdout)
        self.assertTrue(ran.stdout.startswith("Load: "), ran.stdout)

    @unittest.skipUnless(may_mount(), "takes the right to mount")
    def test_a_read_only_folder_is_said(self):
        script = 'mount -t tmpfs tmpfs "$1" && mkdir "$1/out" && mount -o remount,ro "$1" && shift && exec "$@"'
        os.mkdir(self.path("disk"))
        for command in (["plan", CASE], ["audit", AUDITED]):
            ran = run("unshare", "--mount", "bash", "-c", script, "bash", self.path("disk"), TAUT, *command, "--out",
                      self.path("disk", "out"))
            self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
            self.assertIn("Read-only file system", ran.stderr)

    def test_pipes_are_not_replaced_and_links_are_followed(self):
        planned = run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out"))
        self.assertEqual(planned.returncode, 0, planned.stderr)
        certificate = self.path("out", "certificate.json")
        os.mkfifo(self.path("pipe"))
        refused = run(TAUT, "report", certificate, "--text", "--out", self.path("pipe"))
        self.assertEqual(refused.returncode, 3, refused.stdout + refused.stderr)
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))
        real = self.write("real.txt", "")
        os.symlink(real, self.path("link"))
        self.assertEqual(run(TAUT, "report", certificate, "--text", "--out", self.path("link")).returncode, 0)
        self.assertTrue(os.path.islink(self.path("link")))
        self.assertIn("PROVED", text_of(real).upper())

    def test_a_file_where_the_folder_should_be_is_said(self):
        self.write("out", "mine")
        ran = run(TAUT, "plan", CASE, "--out", self.path("out"))
        self.assertEqual(ran.returncode, 3)
        self.assertIn(self.path("out") + ": could not make the directory", ran.stderr)
        self.assertEqual(text_of(self.path("out")), "mine")

    def test_closed_standard_streams_do_no_harm(self):
        out = self.path("out")
        ran = subprocess.run(["bash", "-c", '"$1" plan "$2" --out "$3" <&- 2>&-', "bash", TAUT, CASE, out],
                             capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(ran.returncode, 0)
        self.assert_whole(out)
        # No standard output: the result can't be said, the files are whole and hold nothing but themselves.
        for closed in (">&-", ">&- 2>&-", "<&- >&- 2>&-"):
            shutil.rmtree(out)
            ran = subprocess.run(["bash", "-c", f'"$1" plan "$2" --out "$3" {closed}', "bash", TAUT, CASE, out],
                                 capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(ran.returncode, 4)
            self.assertIn("could not write to standard output" if "2>" not in closed else "", ran.stderr)
            self.assert_whole(out)

    def test_closed_standard_streams_change_no_exit_code(self):
        """Except that results which can't be written are a failure: 4."""
        self.assertEqual(run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out")).returncode, 0)
        certificate = self.path("out", "certificate.json")
        for program, arguments, usual in ((TAUT, ["show", CASE], 0), (TAUT, ["doctor"], 0), (TAUT, ["--help"], 0),
                                          (TAUT, ["plan", "nothing.yaml"], 3), (TAUT, ["--nothing"], 3),
                                          (TAUT, ["report", certificate, "--text"], 0), (CHECK, [certificate], 0),
                                          (CHECK, ["--help"], 0), (CHECK, ["nothing.json"], 3)):
            for closed in ("<&-", ">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"):
                with self.subTest(arguments=arguments, closed=closed):
                    ran = subprocess.run(["bash", "-c", f'program=$1; shift; "$program" "$@" {closed}', "bash", program,
                                          *arguments], capture_output=True, timeout=120, check=False)
                    self.assertEqual(ran.returncode, 4 if usual == 0 and ">&- " in closed + " " and closed != "2>&-"
                                     else usual, ran.stderr)

    @unittest.skipIf("TAUT_SANITIZED" in os.environ, "sanitizers take terabytes of addresses")
    def test_little_memory_is_a_failure_and_no_other_verdict(self):
        codes = set()
        for megabytes in range(24, 64, 4):
            ran = subprocess.run(["bash", "-c", 'ulimit -v "$1"; shift; exec "$@"', "bash", str(megabytes << 10), TAUT,
                                  "plan", CASE, "--out", self.path("out")],
                                 capture_output=True, timeout=120, check=False)
            codes.add(ran.returncode)
            self.assertNotIn(ran.returncode, (1, 2), ran.stdout)
            if os.path.exists(self.path("out")):
                self.assert_whole(self.path("out"))
        self.assertGreater(len(codes), 1, "some were too little, and some enough")

    @unittest.skipIf("TAUT_SANITIZED" in os.environ, "sanitizers take terabytes of addresses")
    def test_no_amount_of_memory_makes_it_abort(self):
        self.assertEqual(run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out")).returncode, 0)
        commands = ([TAUT, "plan", CASE, "--out", self.path("out")],
                    [CHECK, self.path("out", "certificate.json")])
        for command in commands:
            def ends_with(kilobytes, command=command):
                limited = ["bash", "-c", 'ulimit -c 0; ulimit -v "$1"; shift; exec "$@"', "bash", str(kilobytes),
                           *command]
                return subprocess.run(limited, capture_output=True, timeout=120, check=False).returncode
            too_little, enough = 4 << 10, 256 << 10
            while enough - too_little > 1024:
                middle = (too_little + enough) // 2
                if ends_with(middle) == 0:
                    enough = middle
                else:
                    too_little = middle
            step = enough // 80
            codes = {kilobytes: ends_with(kilobytes) for kilobytes in range(enough // 2, enough, step)}
            # 127: the loader had not enough to begin with.
            self.assertLessEqual(set(codes.values()), {0, 4, 126, 127}, codes)
            self.assertIn(4, codes.values())

    def test_names_that_no_file_can_have_are_bad_input(self):
        self.assertEqual(run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out")).returncode, 0)
        certificate = self.path("out", "certificate.json")
        os.symlink("loop", self.path("loop"))
        for ending in (".yaml", ".svg"):
            os.symlink("loop" + ending, self.path("loop" + ending))
        long_name = self.path("x" * 300)
        for name, reason in ((self.path("loop"), "Too many levels of symbolic links"),
                             (long_name, "File name too long")):
            for arguments in (["report", certificate, "--text", "--out", name], ["report", certificate, "--out", name],
                              ["report", name], ["plan", CASE, "--out", name], ["plan", CASE, "--save-atlas", name],
                              ["plan", CASE, "--sign", name], ["audit", AUDITED, name, "--out", self.path("audit")],
                              ["audit", AUDITED, "--out", name], ["show", name], ["show", CASE, "--out", name + ".svg"],
                              ["init", name + ".yaml"], ["regress", name],
                              ["regress", os.path.dirname(AUDITED), "--junit", name]):
                with self.subTest(arguments=arguments):
                    ran = run(TAUT, *arguments, cwd=self.out)
                    self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
                    self.assertRegex(ran.stderr, r"^taut: .*\[E\d\]\n$")
                    self.assertIn(reason, ran.stderr)
            self.assertEqual(run(CHECK, name).returncode, 3)

    def test_a_folder_for_temporary_files_that_is_none_is_bad_input(self):
        self.assertEqual(run(TAUT, "plan", CASE, "--no-report", "--out", self.path("out")).returncode, 0)
        nowhere = {**os.environ, "TMPDIR": self.path("nowhere")}
        for arguments in (["report", self.path("out", "certificate.json"), "--pdf"], ["regress", CASE]):
            ran = run(TAUT, *arguments, env=nowhere)
            self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
            self.assertIn(f"TMPDIR: got '{self.path('nowhere')}', expected a folder for temporary files", ran.stderr)

    def test_devices_are_not_read_to_their_end(self):
        for arguments in (["plan", CASE, "--sign", "/dev/zero"], ["audit", AUDITED, "--sign", "/dev/zero"],
                          ["report", "/dev/zero"], ["show", "/dev/zero"], ["plan", "/dev/zero"],
                          ["audit", AUDITED, "/dev/zero"], ["regress", CASE, "--baseline", "/dev/zero"]):
            with self.subTest(arguments=arguments):
                limited = ["bash", "-c", 'ulimit -v 800000; exec "$@"', "bash", TAUT, *arguments]
                ran = run(*(limited if "TAUT_SANITIZED" not in os.environ else limited[4:]), cwd=self.out)
                self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
                self.assertIn("/dev/zero", ran.stderr)

    def assert_steers_nothing(self, ran):
        """What was printed is UTF-8 without control and format characters."""
        for text in (ran.stdout.decode("utf-8"), ran.stderr.decode("utf-8")):
            steering = {c for c in text if c != "\n" and unicodedata.category(c) in ("Cc", "Cf", "Zl", "Zp")}
            self.assertEqual(steering, set(), text)

    def test_names_cannot_steer_a_terminal(self):
        hostile = "\x1b[31m\u202e\u200b\u0085\u2028".encode() + b"\x9b\xff\xe2\x80"
        folder = os.path.join(self.out.encode(), hostile)
        os.mkdir(folder)
        nothing = hostile + b"."
        case = os.path.join(folder, b"case.yaml")
        with open(case, "wb") as file:
            file.write("# A case \u202e with a description \x9b.\n".encode() + text_of(CASE).encode())
        out = os.path.join(folder, b"out")
        certificate = os.path.join(out, b"certificate.json")
        for expected, arguments in (
                (0, ["plan", case, "--out", out]), (0, ["plan", case, "--no-report", "--out", out, "--json"]),
                (0, ["plan", case, "--no-report", "--out", out, "--save-atlas", os.path.join(folder, b"atlas")]),
                (0, ["audit", case, os.path.join(out, b"path.csv"), "--out", out + b"2"]),
                (0, ["audit", case, os.path.join(out, b"path.csv"), "--out", out + b"2", "--json"]),
                (0, ["show", case]), (0, ["show", case, "--out", case + b".svg"]),
                (0, ["report", certificate, "--text"]), (0, ["report", certificate, "--markdown"]),
                (0, ["report", certificate]), (0, ["regress", folder, "--junit", os.path.join(folder, b"junit")]),
                (0, ["init", os.path.join(folder, b"new.yaml")]), (3, ["init", case]), (3, ["plan", nothing]),
                (3, ["audit", case, nothing]), (3, ["report", nothing]), (3, ["report", case]), (3, ["show", nothing]),
                (3, ["regress", nothing]), (3, ["plan", case, "--sign", nothing]), (3, ["explain", nothing]),
                (3, [nothing]), (3, ["plan", case, "--budget", nothing]), (3, ["plan", case, b"--" + nothing]),
                (3, ["audit", case, "--interpolation", nothing]), (3, ["audit", case, "--bits", nothing]),
                (3, ["regress", case, "--tolerance", nothing]), (3, ["report", certificate, "--document", nothing])):
            with self.subTest(arguments=arguments):
                ran = subprocess.run([TAUT, *arguments], capture_output=True, timeout=300, check=False, cwd=self.out)
                self.assertEqual(ran.returncode, expected, ran.stdout + ran.stderr)
                self.assert_steers_nothing(ran)
        for expected, arguments in ((0, [certificate, case]), (3, [nothing]), (3, [case]), (3, [certificate, nothing]),
                                    (3, [certificate, "--trust", nothing]), (3, [certificate, b"--" + nothing])):
            with self.subTest(arguments=arguments):
                ran = subprocess.run([CHECK, *arguments], capture_output=True, timeout=300, check=False, cwd=self.out)
                self.assertEqual(ran.returncode, expected, ran.stdout + ran.stderr)
                self.assert_steers_nothing(ran)

    def test_progress_is_for_terminals_only(self):
        self.assertEqual(run(TAUT, "audit", AUDITED, "--out", self.path("out")).stderr, "")
        said = subprocess.run(["script", "-qec", f"{TAUT} regress {os.path.join(CASES, 'tutorial')}", "/dev/null"],
                              capture_output=True, timeout=120, check=True, stdin=subprocess.DEVNULL)
        self.assertRegex(said.stdout, rb"\r\x1b\[K\d of \d cases")


if __name__ == "__main__":
    main()
