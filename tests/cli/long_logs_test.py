#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs of a minute at 100 Hz in every format, and one that is too long for a report.

Usage: long_logs_test.py TAUT TAUT_CHECK SOURCE_DIR
"""
import logs_test
import ordinary_logs
from command_line import main


class LongLogs(logs_test.Logs):
    def test_every_format_is_audited_checked_and_reported(self):
        for name in ordinary_logs.LOGS:
            with self.subTest(log=name):
                self.check_log(name, 6001, 60)

    def test_longer_ones_have_a_report_on_request(self):
        said = self.taut("audit", self.crane, self.write_log("angles.csv", rows=20002))
        self.assertIn("Written to out/crane-audit-angles: path.csv, certificate.json\n", said)
        self.assertIn("No report is made of more than 20000 segments", said)
        self.taut("report", "out/crane-audit-angles/certificate.json")


if __name__ == "__main__":
    main()
