// taut report: a certificate for people, on a page, on paper or in a log.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "reports/summary/report_options.h"

namespace taut {

struct ReportArguments {
  std::string certificate_path;
  std::string out;
  bool pdf = false, text = false, markdown = false, json = false;  ///< at most one; none: HTML
  std::optional<bool> check;                                       ///< nothing: where it takes a few seconds at most
  std::string document, revision, date;
};

void add_report_options(CLI::App& command, ReportArguments& arguments);

/// "--check" and "--no-check".
void add_check_option(CLI::App& command, std::optional<bool>& check);

/// @returns the exit code: 1 where the certificate was rejected. @throws as main expects.
[[nodiscard]] int run_report(const ReportArguments& arguments);

}  // namespace taut
