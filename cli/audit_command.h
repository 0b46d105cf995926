// `taut audit`: its arguments, what it writes and what it says (docs/audits.md).
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace taut {

struct AuditArguments {
  std::string case_path;
  std::string path;  ///< empty: the case's
  std::string law;   ///< empty: the file's own
  std::string out;
  std::string key;   ///< file of the private key that signs, or empty
  long bits = 4096;  ///< of the prover's last rung
  bool allow_repeats = false;
  bool json = false;
  std::optional<bool> check;  ///< by the independent checker; nothing: where it takes a few seconds at most
};

void add_audit_options(CLI::App& command, AuditArguments& arguments);

/// @returns the exit code. @throws InputError
[[nodiscard]] int run_audit(const AuditArguments& arguments);

}  // namespace taut
