// SPDX-License-Identifier: GPL-3.0-or-later
// taut: plans motions of cable-driven hexapods and proves them. Command line and exit codes; decides nothing itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/nearest.h"
#include "base/process.h"
#include "base/sanitize.h"
#include "certify/arithmetic/rounding.h"
#include "checker/arguments.h"
#include "cli/audit_command.h"
#include "cli/browser.h"
#include "cli/console.h"
#include "cli/doctor_command.h"
#include "cli/explain_command.h"
#include "cli/formal_command.h"
#include "cli/init_command.h"
#include "cli/map_command.h"
#include "cli/monitor_command.h"
#include "cli/output.h"
#include "cli/plan_command.h"
#include "cli/regress_command.h"
#include "cli/report_command.h"
#include "cli/sensitivity_command.h"
#include "cli/show_command.h"
#include "cli/wrap_command.h"
#include "reports/summary/explanations.h"

namespace taut {
namespace {

/// Whether JSON is expected on standard output. That of a report may go to a file instead.
bool wants_json(int argc, char** argv) {
  const std::vector<std::string_view> arguments(argv + 1, argv + argc);
  const bool is_for_a_file = arguments.front() == "report" && std::ranges::any_of(arguments, [](std::string_view text) {
                               return text == "--out" || text.starts_with("--out=");
                             });
  return !is_for_a_file && std::ranges::find(arguments, "--json") != arguments.end();
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* known : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(known->get_name());
  }
  return names;
}

/// "got the unknown option '--buget', did you mean '--budget'?": about the first argument that `command` does not take.
std::string unexpected(const CLI::App& command) {
  const std::vector<std::string> rest = command.remaining();
  const auto option = std::ranges::find_if(rest, [](const std::string& text) { return text.starts_with("-"); });
  if (option == rest.end()) {
    return rest.empty() ? "" : fmt::format("got '{}', expected no further argument", excerpt(rest.front()));
  }
  std::vector<std::string> known;
  for (const CLI::Option* taken : command.get_options()) {
    for (const std::string& name : taken->get_lnames()) known.push_back("--" + name);
  }
  const std::optional<std::string> nearest = nearest_word(*option, known);
  return fmt::format("got the unknown option '{}', {}", excerpt(*option),
                     nearest ? fmt::format("did you mean '{}'?", *nearest) : "expected one that --help lists");
}

/// "got 'pln', did you mean 'plan'? Expected a command: plan audit …"
std::string no_command(const CLI::App& app, const std::string& seen) {
  const std::vector<std::string> names = command_names(app);
  const std::string expected = fmt::format("xpected a command: {}", fmt::join(names, " "));
  if (seen.empty()) return "e" + expected;
  const std::optional<std::string> nearest = nearest_word(seen, names);
  return nearest ? fmt::format("got '{}', did you mean '{}'? E{}", excerpt(seen), *nearest, expected)
                 : fmt::format("got '{}', e{}", excerpt(seen), expected);
}

/// What is wrong with the command line.
std::string usage_message(const CLI::App& app, const CLI::Error& error, const std::string& first) {
  const CLI::App* command = nullptr;
  for (const CLI::App* known : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (known->parsed()) command = known;
  }
  if (command == nullptr && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return no_command(app, first);
  if (command != nullptr && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const std::string message = unexpected(*command); !message.empty()) return message;
  }
  return error.what();
}

/// A command, and what runs it when the command line has been read.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

template <class Arguments>
Command add_command(CLI::App& app, const char* name, const char* help, void (*add_options)(CLI::App&, Arguments&),
                    const std::function<int(const Arguments&)>& run) {
  CLI::App* const command = app.add_subcommand(name, help);
  const auto arguments = std::make_shared<Arguments>();
  add_options(*command, *arguments);
  return {command, [arguments, run] { return run(*arguments); }};
}

/// Errors without a code of their own get this one.
template <class Arguments>
std::function<int(const Arguments&)> with_error_code(ErrorCode code, int (*run)(const Arguments&)) {
  return [=](const Arguments& arguments) { return with_error_code(code, [&] { return run(arguments); }); };
}

/// The same, after the machine's rounding was tested.
template <class Arguments>
std::function<int(const Arguments&)> proving(ErrorCode code, int (*run)(const Arguments&)) {
  return [=](const Arguments& arguments) {
    rounding_self_test();
    return with_error_code(code, [&] { return run(arguments); });
  };
}

std::vector<Command> add_commands(CLI::App& app) {
  std::vector<Command> commands = {
      add_command<PlanArguments>(app, "plan", "plan, prove, write path.csv, certificate.json, report.html",
                                 add_plan_options, proving(ErrorCode::kCase, run_plan)),
      add_command<AuditArguments>(app, "audit", "prove or refute a path that something else made", add_audit_options,
                                  proving(ErrorCode::kPath, run_audit)),
      add_command<RegressArguments>(app, "regress", "run every case of a folder against what it declares",
                                    add_regress_options, with_error_code(ErrorCode::kRegress, run_regress)),
      add_command<InitArguments>(app, "init", "write a commented case to begin from, or a CASPR robot's",
                                 add_init_options, run_init),
  };
  commands.push_back({app.add_subcommand("doctor", "look whether this machine can be trusted with proofs"),
                      [] { return run_doctor(); }});
  commands.push_back(add_command<ReportArguments>(app, "report",
                                                  "write the report from the certificate alone: page, PDF or summary",
                                                  add_report_options, proving(ErrorCode::kCertificate, run_report)));
  commands.push_back(add_command<ExplainArguments>(app, "explain", "say what the code behind a message means: U3, E5",
                                                   add_explain_options, run_explain));
  commands.push_back(add_command<SensitivityArguments>(
      app, "sensitivity", "say what to change so that a path is proved, and what its margin depends on",
      add_sensitivity_options, proving(ErrorCode::kCase, run_sensitivity)));
  commands.push_back(add_command<ShowArguments>(app, "show", "print what a case was understood to say; draw the robot",
                                                add_show_options, with_error_code(ErrorCode::kCase, run_show)));
  commands.push_back(add_command<MapArguments>(app, "map",
                                               "prove which poses are feasible, of two or three free coordinates",
                                               add_map_options, proving(ErrorCode::kCase, run_map)));
  commands.push_back(add_command<MonitorArguments>(app, "monitor",
                                                   "hold measurements to a proved move while it is executed",
                                                   add_monitor_options, proving(ErrorCode::kCertificate, run_monitor)));
  commands.push_back(add_command<WrapArguments>(app, "wrap", "write a closed mesh around one that is not closed",
                                                add_wrap_options, with_error_code(ErrorCode::kCase, run_wrap)));
  commands.push_back(add_command<FormalArguments>(app, "formal",
                                                  "write a proved certificate as a theorem for Coq, and run Coq",
                                                  add_formal_options, proving(ErrorCode::kCertificate, run_formal)));
  return commands;
}

void add_usage_messages(CLI::App& app, int argc, char** argv) {
  app.failure_message([argc, argv](const CLI::App* failed, const CLI::Error& error) {
    const std::string message = usage_message(*failed, error, argc > 1 ? argv[1] : "");
    if (argc > 1 && wants_json(argc, argv)) {
      print_json(error_json(sanitize(argv[1]), sanitize(message), text(ErrorCode::kUse), kBadInputExit, {}));
    }
    std::string command;
    for (const CLI::App* known : failed->get_subcommands({})) {
      if (known->parsed()) command = " " + known->get_name();
    }
    return fmt::format("{} [{}]\nRun with --help for more information: {}{} --help\n", sanitize(message),
                       text(ErrorCode::kUse), failed->get_name(), command);
  });
}

int run(int argc, char** argv) {
  CLI::App app("Plans motions of cable-driven hexapods and proves what it plans.", "taut");
  app.set_version_flag("--version", std::string("taut ") + TAUT_VERSION);
  app.require_subcommand(1);
  add_usage_messages(app, argc, argv);
  app.footer(
      "Exit codes of plan and audit, whose verdict is the independent checker's: 0 proved, 1 refuted or no "
      "path, 2 undecided or unchecked, 3 bad input, 4 internal failure or untrustworthy machine. Of the others: 0 "
      "done, 1 rejected (report), not as expected (regress) or an alarm (monitor), 2 interrupted or unchecked, 3 and 4 "
      "likewise.");
  const std::vector<Command> commands = add_commands(app);
  checker::refuse_empty_arguments(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInputExit;
  }
  return std::ranges::find_if(commands, [](const Command& command) { return command.app->parsed(); })->run();
}

}  // namespace
}  // namespace taut

/// Runs before any initialisation, that of shared libraries included, which may fail for want of memory, too.
static void prepare() { taut::prepare_process("taut", taut::kInternalCode); }
[[gnu::section(".preinit_array"), gnu::used]] static void (*const prepare_first)() = prepare;

int main(int argc, char** argv) {
  const auto failed = [&](const std::string& message, const auto& code, int exit_code,
                          const taut::InputPlace& place = {}) {
    taut::complain(fmt::format("{} [{}]", message, code));
    if (argc > 1 && taut::wants_json(argc, argv)) {
      taut::print_json(taut::error_json(taut::sanitize(argv[1]), taut::sanitize(message), code, exit_code, place));
      std::fflush(stdout);
    }
    return exit_code;
  };
  try {
    const int code = taut::run(argc, argv);
    if (std::fflush(stdout) != 0 || !std::cout.flush()) throw std::runtime_error("could not write to standard output");
    return code;
  } catch (const taut::InputError& error) {
    return failed(error.what(), taut::text(error.code().value_or(taut::ErrorCode::kUse)), taut::kBadInputExit,
                  error.place());
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(error.what(), taut::text(taut::ErrorCode::kFile), taut::kBadInputExit);
  } catch (const taut::BrowserFailed& error) {
    return failed(error.what(), taut::kBrowserFailedCode, taut::kInternalExit);
  } catch (const taut::UntrustworthyMachine& error) {
    return failed(error.what(), taut::kUntrustworthyCode, taut::kInternalExit);
  } catch (const std::bad_alloc&) {
    taut::complain(fmt::format("internal failure: out of memory [{}]", taut::kInternalCode));
  } catch (const std::exception& error) {
    return failed(fmt::format("internal failure: {}", error.what()), taut::kInternalCode, taut::kInternalExit);
  }
  return taut::kInternalExit;
}
