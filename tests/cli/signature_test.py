#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signed certificates through the command line, with keys that the openssl command makes.

Usage: signature_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import hashlib
import json
import os
import subprocess

from command_line import CHECK, InFolder, SOURCE, TAUT, main, run

CASE = os.path.join(SOURCE, "cases", "robot1-slice-qs1-qg.yaml")


def openssl(*arguments):
    subprocess.run(["openssl", *arguments], check=True, capture_output=True, timeout=60)


class Signature(InFolder):
    def setUp(self):
        super().setUp()
        for name in ("me", "other"):
            self.make_key(name)

    def make_key(self, name, *kind):
        openssl("genpkey", *(kind or ("-algorithm", "ed25519")), "-out", self.path(name + ".pem"))
        openssl("pkey", "-in", self.path(name + ".pem"), "-pubout", "-out", self.path(name + ".pub"))

    def plan(self, *options):
        planned = run(TAUT, "plan", CASE, "--out", self.out, *options)
        self.assertEqual(planned.returncode, 0, planned.stderr)
        return planned

    def check(self, *options):
        return run(CHECK, self.path("certificate.json"), CASE, *options)

    def load(self):
        with open(self.path("certificate.json"), encoding="utf-8") as file:
            return json.load(file)

    def test_the_checker_says_who_signed(self):
        self.plan()
        self.assertTrue(self.check().stdout.rstrip().endswith("; not signed"), self.check().stdout)
        self.assertIsNone(json.loads(self.check("--json").stdout)["signature"])
        planned = self.plan("--sign", self.path("me.pem"))
        self.assertEqual(planned.stderr, "")
        der = subprocess.run(["openssl", "pkey", "-pubin", "-in", self.path("me.pub"), "-outform", "DER"],
                             check=True, capture_output=True).stdout
        key = "signed by key SHA256:" + hashlib.sha256(der).hexdigest()
        self.assertTrue(self.check().stdout.rstrip().endswith(key + "; not trusted by anyone"), self.check().stdout)
        trusted = self.check("--trust", self.path("other.pub"), "--trust", self.path("me.pub"))
        self.assertEqual(trusted.returncode, 0, trusted.stdout + trusted.stderr)
        self.assertTrue(trusted.stdout.rstrip().endswith(key + "; trusted"), trusted.stdout)
        self.assertTrue(json.loads(self.check("--json", "--trust", self.path("me.pub")).stdout)["signature"]["trusted"])

    def test_only_trusted_signatures_are_accepted_where_that_is_asked(self):
        for options in ([], ["--sign", self.path("me.pem")]):
            self.plan(*options)
            rejected = self.check("--trust", self.path("other.pub"))
            self.assertEqual(rejected.returncode, 1, rejected.stdout + rejected.stderr)
            self.assertIn("signed", rejected.stdout)

    def test_openssl_verifies_the_message_that_the_documentation_names(self):
        self.plan("--sign", self.path("me.pem"))
        certificate = self.load()
        signature = certificate.pop("signature")
        with open(self.path("message"), "wb") as file:
            file.write(b"taut certificate " + certificate["footer"]["sha256"].encode())
        with open(self.path("value"), "wb") as file:
            file.write(bytes.fromhex(signature["value"]))
        openssl("pkeyutl", "-verify", "-pubin", "-inkey", self.path("me.pub"), "-rawin", "-in", self.path("message"),
                "-sigfile", self.path("value"))

    def test_a_signature_moved_to_another_certificate_is_malformed(self):
        self.plan("--sign", self.path("me.pem"))
        signature = self.load()["signature"]
        self.plan()
        certificate = self.load()
        certificate["generator"]["version"] += "x"
        del certificate["footer"]["sha256"]
        body = {key: value for key, value in certificate.items() if key != "footer"}
        canonical = json.dumps(body, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
        certificate["footer"]["sha256"] = hashlib.sha256(canonical.encode()).hexdigest()
        for added, code in (({}, 0), ({"signature": signature}, 3)):
            with open(self.path("certificate.json"), "w", encoding="utf-8") as file:
                json.dump(certificate | added, file, sort_keys=True)
            checked = self.check()
            self.assertEqual(checked.returncode, code, checked.stdout + checked.stderr)

    def test_a_report_is_made_of_a_signed_certificate(self):
        self.plan("--sign", self.path("me.pem"))
        self.assertEqual(run(TAUT, "report", self.path("certificate.json")).returncode, 0)

    def test_a_private_key_that_others_may_read_is_warned_of(self):
        os.chmod(self.path("me.pem"), 0o640)
        self.assertIn("warning", self.plan("--sign", self.path("me.pem")).stderr)

    def test_other_keys_are_bad_input_before_anything_is_planned(self):
        self.make_key("rsa", "-algorithm", "RSA")
        openssl("pkey", "-in", self.path("me.pem"), "-aes256", "-passout", "pass:secret",
                "-out", self.path("locked.pem"))
        for name, seen in (("rsa.pem", "a private key of type RSA"), ("locked.pem", "an encrypted private key"),
                           ("me.pub", "a public key"), ("none.pem", "No such file"), ("", "Is a directory")):
            with self.subTest(name=name):
                result = run(TAUT, "plan", CASE, "--out", self.path("never"), "--sign", self.path(name),
                             stdin=subprocess.DEVNULL)
                self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
                self.assertIn(seen, result.stderr)
                self.assertFalse(os.path.exists(self.path("never")))
        self.plan("--sign", self.path("me.pem"))
        for name in ("rsa.pub", "me.pem", "none.pub", ""):
            with self.subTest(trust=name):
                checked = self.check("--trust", self.path(name))
                self.assertEqual(checked.returncode, 3, checked.stdout + checked.stderr)
                self.assertTrue(checked.stderr.startswith("bad input: " + self.path(name)), checked.stderr)


if __name__ == "__main__":
    main()
