// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/formal_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "app/recheck.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "certificate/certificate_reader.h"
#include "cli/console.h"
#include "cli/output.h"
#include "cli/subprocess.h"
#include "formal/export.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPackages = "coq libcoq-coquelicot libcoq-interval libcoq-mathcomp-algebra libcoq-mathcomp-analysis";

/// The file to write; coqc wants a name that is an identifier.
fs::path target(const FormalArguments& arguments) {
  const fs::path source = arguments.certificate_path;
  if (!arguments.out.empty()) {
    const fs::path out = arguments.out;
    const std::string stem = out.stem().string();
    const bool is_name = !stem.empty() && std::isalpha(static_cast<unsigned char>(stem[0])) != 0 &&
                         std::ranges::all_of(stem, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (out.extension() != ".v" || !is_name) {
      throw InputError(ErrorCode::kUse,
                       fmt::format("--out: got '{}', expected a name of letters, digits and _ that ends in .v",
                                   excerpt(arguments.out)));
    }
    require_another(out, source);
    return out;
  }
  std::string stem = source.stem().string();
  std::ranges::replace_if(stem, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  if (stem.empty() || std::isalpha(static_cast<unsigned char>(stem[0])) == 0) stem = "path_" + stem;
  return source.parent_path() / (stem + ".v");
}

/// Whether there is a program of that name in PATH.
bool is_installed(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    std::error_code ignored;
    if (fs::is_regular_file(fs::path(rest.substr(0, colon)) / program, ignored)) return true;
    rest.erase(0, colon + 1);
  }
  return false;
}

/// Where the compiled library is; nothing where it has no checker.
std::optional<fs::path> coq_library() {
  const char* const named = std::getenv("TAUT_FORMAL_DIR");
  if (named == nullptr || *named == '\0') return std::nullopt;
  std::error_code ignored;
  if (fs::is_regular_file(fs::path(named) / "Verify.vo", ignored)) return fs::path(named);
  return std::nullopt;
}

/// Runs coqc; the exit code.
int compile(const fs::path& file, const std::stop_token& stop) {
  if (!is_installed("coqc")) {
    complain(fmt::format("coqc is not installed, so Coq has proved nothing. Debian's packages: {}", kPackages));
    return kUndecidedExit;
  }
  const std::optional<fs::path> library = coq_library();
  if (!library) {
    complain("TAUT_FORMAL_DIR names no folder with Verify.vo, so Coq has proved nothing.");
    return kUndecidedExit;
  }
  const FinishedProgram coq = run_program({"coqc", "-Q", library->string(), "Taut", file.string()}, stop);
  if (coq.interrupted) return report_interruption("formal", "interrupted: Coq has proved nothing", false);
  if (coq.exit_code != 0) {
    complain(fmt::format("Coq refused {}: {}", sanitize(file.string()), sanitize(excerpt(coq.err))));
    return kRefutedExit;
  }
  fmt::print(
      "Checked by Coq's kernel in {:.1f} s: everywhere along the path, for every wrench of the load, exactly one\n"
      "list of tensions balances it, and all tensions and lengths are strictly within their limits.\n{}",
      coq.seconds, coq.out);
  return kProvedExit;
}

}  // namespace

void add_formal_options(CLI::App& command, FormalArguments& arguments) {
  command.add_option("CERTIFICATE", arguments.certificate_path, "certificate.json")->required();
  command.add_option("--out", arguments.out, "file to write (default: beside the certificate, with its name and .v)");
  CLI::Option_group* instance = command.add_option_group("instance", "How Coq computes; default: --exact");
  instance->add_flag("--exact", arguments.exact, "with integers, on no axioms but those of the real numbers");
  instance->add_flag("--fast", arguments.fast, "with the processor's floating point, which Coq then trusts");
  instance->require_option(0, 1);
  command.add_flag("--no-coq", arguments.no_coq, "write the file, and do not run coqc");
}

int run_formal(const FormalArguments& arguments) {
  const fs::path file = target(arguments);
  const Interruption interruption;
  const std::string bytes = read_whole(arguments.certificate_path);
  const checker::CheckResult checked = recheck(bytes, kCheckSeconds, interruption.token());
  const auto interrupted = [] { return report_interruption("formal", "interrupted: nothing was written", false); };
  if (interruption.token().stop_requested()) return interrupted();
  if (checked.outcome == checker::Outcome::kMalformed) {
    throw InputError(ErrorCode::kCertificate,
                     fmt::format("{}: got {}, expected a certificate", arguments.certificate_path, checked.message),
                     {arguments.certificate_path});
  }
  if (!checked.theorem || checked.theorem->verdict() != checker::Theorem::Verdict::kProved) {
    complain(fmt::format("{}: {}. Only a path that is proved is written for Coq.", arguments.certificate_path,
                         sentence(checked)));
    return checked.outcome == checker::Outcome::kUnchecked ? kUndecidedExit : kRefutedExit;
  }
  const Certificate certificate = read_certificate(parse_certificate(bytes, arguments.certificate_path));
  formal::require_in_scope(certificate);
  std::optional<std::vector<std::vector<formal::Box>>> boxes;
  {
    ProgressLine line(true);
    boxes = formal::find_boxes(
        certificate,
        [&](std::size_t done, std::size_t all, std::size_t count) {
          line.show([&] { return fmt::format("boxes: {} on {} of {} segments", count, done, all); });
        },
        interruption.token());
  }
  if (!boxes) return interrupted();
  std::size_t count = 0;
  for (const auto& segment : *boxes) count += segment.size();
  write_whole({{file, formal::coq_file(certificate, *boxes,
                                       arguments.fast ? formal::Instance::kFast : formal::Instance::kExact)}});
  fmt::print("Written: {} ({} boxes)\n", sanitize(file.string()), count);
  return arguments.no_coq ? kProvedExit : compile(file, interruption.token());
}

}  // namespace taut
