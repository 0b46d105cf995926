// SPDX-License-Identifier: GPL-3.0-or-later
// write_samples DIR: the reports of the sample certificates, for browser_test.sh.
#include <filesystem>
#include <fstream>

#include "reports/page/html_report.h"
#include "tests/reports/sample_certificates.h"

int main(int argc, char** argv) {
  if (argc != 2) return 3;
  const std::filesystem::path directory = argv[1];
  const auto write = [&](const char* name, const nlohmann::json& certificate) {
    std::ofstream(directory / name) << taut::html_report(taut::sample::scene(certificate));
  };
  write("proved.html", taut::sample::proved());
  write("refuted.html", taut::sample::refuted());
  write("singular.html", taut::sample::singular());
  write("undecided.html", taut::sample::undecided());
  write("bodies.html", taut::sample::with_bodies(taut::sample::proved()));
  write("contact.html", taut::sample::contact());
  write("no_path.html", taut::sample::no_path());
  write("no_path_of_query.html", taut::sample::no_path_of_query());
  write("hostile.html", taut::sample::hostile());
  std::ofstream(directory / "unchecked.html") << taut::html_report(taut::sample::unchecked(taut::sample::proved()));
}
