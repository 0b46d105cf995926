// SPDX-License-Identifier: GPL-3.0-or-later
// taut: plans motions of cable-driven hexapods and proves them. Command line and exit codes; decides nothing itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "base/input_error.h"
#include "base/process.h"
#include "base/sanitize.h"
#include "certify/arithmetic/rounding.h"
#include "checker/arguments.h"
#include "cli/audit_command.h"
#include "cli/console.h"
#include "cli/doctor_command.h"
#include "cli/explain_command.h"
#include "cli/init_command.h"
#include "cli/pdf.h"
#include "cli/plan_command.h"
#include "cli/regress_command.h"
#include "cli/report_command.h"
#include "cli/sensitivity_command.h"
#include "cli/show_command.h"

namespace taut {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Plans motions of cable-driven hexapods and proves what it plans.", "taut");
  app.set_version_flag("--version", std::string("taut ") + TAUT_VERSION);
  app.require_subcommand(1);
  app.failure_message([argc, argv](const CLI::App* failed, const CLI::Error& error) {
    std::string message = error.what();
    std::string command;
    for (const CLI::App* known : failed->get_subcommands({})) {
      if (known->parsed()) command = " " + known->get_name();
    }
    if (command.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
      message = argc > 1 ? fmt::format("got '{}', expected a command:", argv[1]) : "expected a command:";
      for (const CLI::App* known : failed->get_subcommands({})) message += " " + known->get_name();
    }
    return fmt::format("{} [{}]\nRun with --help for more information: {}{} --help\n", sanitize(message),
                       text(ErrorCode::kUse), failed->get_name(), command);
  });
  app.footer(
      "Exit codes of plan and audit, whose verdict is the independent checker's: 0 proved, 1 refuted, 2 undecided or "
      "unchecked, 3 bad input, 4 internal failure or untrustworthy machine. Of the others: 0 done, 1 rejected (report) "
      "or not as expected (regress), 2 interrupted or unchecked, 3 and 4 likewise.");

  PlanArguments plan_arguments;
  CLI::App* plan_command = app.add_subcommand("plan", "plan, prove, write path.csv, certificate.json, report.html");
  add_plan_options(*plan_command, plan_arguments);

  AuditArguments audit_arguments;
  CLI::App* audit_command = app.add_subcommand("audit", "prove or refute a path that something else made");
  add_audit_options(*audit_command, audit_arguments);

  RegressArguments regress_arguments;
  CLI::App* regress_command = app.add_subcommand("regress", "run every case of a folder against what it declares");
  add_regress_options(*regress_command, regress_arguments);

  std::string new_path;
  CLI::App* init_command = app.add_subcommand("init", "write a commented case to begin from");
  init_command->add_option("FILE", new_path, "case file to write")->required();
  CLI::App* doctor_command = app.add_subcommand("doctor", "look whether this machine can be trusted with proofs");

  ReportArguments report_arguments;
  CLI::App* report_command =
      app.add_subcommand("report", "write the report from the certificate alone: page, PDF or summary");
  add_report_options(*report_command, report_arguments);

  ExplainArguments explain_arguments;
  CLI::App* explain_command = app.add_subcommand("explain", "say what the code behind a message means: U3, E5");
  add_explain_options(*explain_command, explain_arguments);

  SensitivityArguments sensitivity_arguments;
  CLI::App* sensitivity_command =
      app.add_subcommand("sensitivity", "say what to change so that a path is proved, and what its margin depends on");
  add_sensitivity_options(*sensitivity_command, sensitivity_arguments);

  ShowArguments show_arguments;
  CLI::App* show_command = app.add_subcommand("show", "print what a case was understood to say; draw the robot");
  add_show_options(*show_command, show_arguments);

  checker::refuse_empty_arguments(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInputExit;
  }
  if (*plan_command) {
    rounding_self_test();
    return with_error_code(ErrorCode::kCase, [&] { return run_plan(plan_arguments); });
  }
  if (*audit_command) {
    rounding_self_test();
    return with_error_code(ErrorCode::kPath, [&] { return run_audit(audit_arguments); });
  }
  if (*sensitivity_command) {
    rounding_self_test();
    return with_error_code(ErrorCode::kCase, [&] { return run_sensitivity(sensitivity_arguments); });
  }
  if (*show_command) return with_error_code(ErrorCode::kCase, [&] { return run_show(show_arguments); });
  if (*explain_command) return run_explain(explain_arguments);
  if (*init_command) return run_init(new_path);
  if (*doctor_command) return run_doctor();
  if (*regress_command) return with_error_code(ErrorCode::kRegress, [&] { return run_regress(regress_arguments); });
  rounding_self_test();
  return with_error_code(ErrorCode::kCertificate, [&] { return run_report(report_arguments); });
}

}  // namespace
}  // namespace taut

/// Runs before any initialisation, that of shared libraries included, which may fail for want of memory, too.
static void prepare() { taut::prepare_process("taut", taut::kInternalCode); }
[[gnu::section(".preinit_array"), gnu::used]] static void (*const prepare_first)() = prepare;

int main(int argc, char** argv) {
  const auto failed = [](const std::exception& error, const auto& code, int exit_code) {
    taut::complain(fmt::format("{} [{}]", error.what(), code));
    return exit_code;
  };
  try {
    const int code = taut::run(argc, argv);
    if (std::fflush(stdout) != 0 || !std::cout.flush()) throw std::runtime_error("could not write to standard output");
    return code;
  } catch (const taut::InputError& error) {
    return failed(error, taut::text(error.code().value_or(taut::ErrorCode::kUse)), taut::kBadInputExit);
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(error, taut::text(taut::ErrorCode::kFile), taut::kBadInputExit);
  } catch (const taut::BrowserFailed& error) {
    return failed(error, taut::kBrowserFailedCode, taut::kInternalExit);
  } catch (const taut::UntrustworthyMachine& error) {
    return failed(error, taut::kUntrustworthyCode, taut::kInternalExit);
  } catch (const std::bad_alloc&) {
    taut::complain(fmt::format("internal failure: out of memory [{}]", taut::kInternalCode));
  } catch (const std::exception& error) {
    taut::complain(fmt::format("internal failure: {} [{}]", error.what(), taut::kInternalCode));
  }
  return taut::kInternalExit;
}
