// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/formal_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "certificate/certificate_reader.h"
#include "cli/console.h"
#include "cli/output.h"
#include "cli/subprocess.h"
#include "cli/terminal.h"
#include "formal/export.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPackages =
    "coq libcoq-coquelicot libcoq-interval libcoq-mathcomp-algebra libcoq-mathcomp-analysis";

bool is_module_name(const std::string& stem) {
  return !stem.empty() && std::isalpha(static_cast<unsigned char>(stem[0])) != 0 &&
         std::ranges::all_of(stem, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// The file to write; coqc wants a name that is an identifier.
fs::path target(const FormalArguments& arguments) {
  const fs::path source = arguments.certificate_path;
  if (arguments.out.empty()) {
    std::string stem = source.stem().string();
    std::ranges::replace_if(
        stem, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    if (!is_module_name(stem)) stem = "path_" + stem;
    return source.parent_path() / (stem + ".v");
  }
  const fs::path out = arguments.out;
  if (out.extension() != ".v" || !is_module_name(out.stem().string())) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--out: got '{}', expected a name of letters, digits and _ that ends in .v",
                                 excerpt(arguments.out)));
  }
  require_another(out, source);
  return out;
}

/// Whether PATH has a program of that name.
bool is_installed(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::stringstream folders(path == nullptr ? "" : path);
  std::error_code ignored;
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (fs::is_regular_file(fs::path(folder) / program, ignored)) return true;
  }
  return false;
}

/// The folder with the checker in Coq: the one that was asked for, or that of the installation or of the sources.
fs::path library(const FormalArguments& arguments) {
  std::error_code ignored;
  if (!arguments.library.empty()) {
    if (fs::is_regular_file(fs::path(arguments.library) / "Verify.v", ignored)) return arguments.library;
    throw InputError(ErrorCode::kUse,
                     fmt::format("--library: got '{}', expected a folder with Verify.v", excerpt(arguments.library)));
  }
  const fs::path here = fs::canonical(own_program(), ignored).parent_path();
  fs::path sources = here / "../../../formal";
  for (const fs::path& folder : {here / "../share/taut/formal", sources}) {
    if (fs::is_regular_file(folder / "Verify.v", ignored)) return folder.lexically_normal();
  }
  return sources.lexically_normal();
}

/// Why coqc can't be run; empty where it can.
std::string why_no_coq(const fs::path& library) {
  if (!is_installed("coqc")) return fmt::format("coqc is not installed. Debian's packages: {}", kPackages);
  std::error_code ignored;
  if (fs::is_regular_file(library / "Verify.vo", ignored)) return {};
  return fmt::format(
      "the checker in Coq is not compiled. {} compiles it, in some three minutes; 'build --into FOLDER', "
      "then 'taut formal --library FOLDER', where you may not write there",
      sanitize((library / "build").string()));
}

/// The names in what Coq's Print Assumptions prints.
std::vector<std::string> axioms(const std::string& printed) {
  std::vector<std::string> names;
  std::stringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == ' ' || line.starts_with("Axioms:")) continue;
    names.push_back(sanitize(line.substr(0, line.find(' '))));
  }
  return names;
}

void print_theorem(const Certificate& certificate, const FinishedProgram& coq, const FormalArguments& arguments) {
  const char* const machines =
      certificate.problem.tolerances ? "machine and pose within the tolerances and every " : "";
  const char* const held = certificate.path.interpolation == Interpolation::kCableLengths
                               ? "there is exactly one pose in the path's tube with the path's lengths, and there, "
                               : "";
  print_wrapped(
      fmt::format("Checked by Coq's kernel in {:.1f} s: everywhere along the path of {}, {}for every {}wrench of the "
                  "load, exactly one list of tensions balances it, and all tensions and all lengths are strictly "
                  "within their limits.\n",
                  coq.seconds, plural(certificate.path.segments(), "segment"), held, machines));
  print_wrapped(
      "This is the theorem 'feasible' at the end of the file, about the numbers at its head (docs/formal.md). It does "
      "not say how large the margins are, that parameters stay in their ranges, that the path leads where the query "
      "asked, or who signed.\n");
  const std::vector<std::string> names = axioms(coq.out);
  print_wrapped(
      arguments.fast
          ? fmt::format("It rests on {} axioms, among them those of the processor's floating point.\n", names.size())
          : fmt::format("It rests on these axioms: {}.\n", fmt::join(names, ", ")));
}

/// A folder that goes with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(make_temporary_folder("taut-formal")) {}
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Has coqc read what was written, beside which it would leave four more files. The exit code.
int run_coq(const Certificate& certificate, const fs::path& file, const std::string& text,
            const FormalArguments& arguments, const std::stop_token& stop) {
  const fs::path folder = library(arguments);
  if (const std::string why = why_no_coq(folder); !why.empty()) {
    complain(fmt::format("Coq has proved nothing: {}.", why));
    return kUndecidedExit;
  }
  const TemporaryFolder temporary;
  const fs::path copy = temporary.path() / file.filename();
  write_whole({{copy, text}});
  const FinishedProgram coq = run_program({"coqc", "-q", "-Q", folder.string(), "Taut", copy.string()}, stop);
  if (coq.interrupted) return report_interruption("formal", "interrupted: Coq has proved nothing", false);
  if (coq.exit_code != 0) {
    throw std::runtime_error(fmt::format("Coq refused {}: {}", file.string(), excerpt(coq.err)));
  }
  print_theorem(certificate, coq, arguments);
  return kProvedExit;
}

/// @throws InputError unless it states a path that is proved, in terms that Coq is told.
Certificate read_proved(const std::string& bytes, const std::string& name) {
  return with_error_code(ErrorCode::kCertificate, name, [&] {
    Certificate certificate = read_certificate(parse_certificate(bytes, name));
    if (certificate.verdict != Verdict::kProved) {
      throw InputError(
          fmt::format("got the verdict '{}', expected a path that is proved", taut::name(certificate.verdict)));
    }
    formal::require_in_scope(certificate);
    return certificate;
  });
}

}  // namespace

void add_formal_options(CLI::App& command, FormalArguments& arguments) {
  command.add_option("CERTIFICATE", arguments.certificate_path, "certificate.json of a path that is proved")
      ->required();
  command.add_option("--out", arguments.out, "file to write (default: beside the certificate, with its name and .v)");
  command.add_flag("--fast", arguments.fast,
                   "let Coq compute with the processor's floating point, which it then trusts; much faster");
  command.add_flag("--no-coq", arguments.no_coq, "write the file, and do not run coqc");
  command.add_option("--boxes", arguments.boxes, "also write the boxes alone, which taut-verify reads (formal/build)");
  command.add_option("--library", arguments.library, "folder with the compiled checker in Coq (formal/build)");
  add_max_seconds_option(command, arguments.max_seconds);
}

int run_formal(const FormalArguments& arguments) {
  const fs::path file = target(arguments);
  if (!arguments.boxes.empty()) {
    require_another(arguments.boxes, arguments.certificate_path);
    require_another(arguments.boxes, file);
  }
  const Interruption interruption;
  const std::string bytes = read_whole(arguments.certificate_path);
  const Certificate certificate = read_proved(bytes, arguments.certificate_path);
  const checker::CheckResult checked = recheck(bytes, arguments.max_seconds, interruption.token());
  const auto interrupted = [] { return report_interruption("formal", "interrupted: nothing was written", false); };
  if (interruption.token().stop_requested()) return interrupted();
  if (checked.outcome == checker::Outcome::kUnchecked) {
    complain(fmt::format("{}: {} Nothing was written.", arguments.certificate_path, sentence(checked)));
    return kUndecidedExit;
  }
  if (!checked.theorem || checked.theorem->verdict() != checker::Theorem::Verdict::kProved) {
    throw InputError(
        ErrorCode::kCertificate,
        fmt::format("{}: {}, expected a certificate that is accepted", arguments.certificate_path, sentence(checked)),
        {arguments.certificate_path});
  }
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
  const std::string text = formal::coq_file(certificate, checked.sha256, *boxes,
                                            arguments.fast ? formal::Instance::kFast : formal::Instance::kExact);
  std::vector<FileContent> files = {{file, text}};
  if (!arguments.boxes.empty()) files.push_back({arguments.boxes, formal::boxes_file(certificate, *boxes)});
  write_whole(files);
  fmt::print("{}\nWritten: {} ({} boxes)\n", sentence(checked), sanitize(file.string()), count);
  std::fflush(stdout);
  return arguments.no_coq ? kProvedExit : run_coq(certificate, file, text, arguments, interruption.token());
}

}  // namespace taut
