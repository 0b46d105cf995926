// taut-check CERTIFICATE [CASE] [--trust PUBKEY.pem]… [--json] [--quiet]: proves the claim of a certificate again.
//
// Results go to stdout; bad input is complained about on stderr, as wrong use is, and with --json on stdout too.
// Exit codes: 0 accepted, 1 rejected, 2 the certificate itself is undecided, 3 malformed input or wrong use,
// 4 this program failed.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "base/input_error.h"
#include "base/process.h"
#include "base/sanitize.h"
#include "case/case_file.h"
#include "checker/check.h"
#include "checker/errors.h"
#include "checker/signature.h"

namespace taut::checker {
namespace {

constexpr std::streamoff kMaxFileSize = std::streamoff{2} << 30;  ///< bytes; a certificate of 10^6 boxes has 10^8

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::vector<char> chunk(1 << 20);
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || file.gcount() > 0) {
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
    if (static_cast<std::streamoff>(text.size()) > kMaxFileSize) throw Malformed(path + ": larger than 2 GiB");
  }
  if (!file.eof()) throw Malformed(path + ": cannot be read");
  return text;
}

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAccepted: return "accepted";
    case Outcome::kRejected: return "rejected";
    case Outcome::kUndecided: return "undecided";
    case Outcome::kMalformed: return "malformed";
  }
  return "?";
}

int exit_code(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAccepted: return 0;
    case Outcome::kRejected: return 1;
    case Outcome::kUndecided: return 2;
    case Outcome::kMalformed: return 3;
  }
  return 4;
}

CheckResult check_file(const std::string& certificate_path, const std::string& case_path,
                       const std::vector<std::string>& key_paths) {
  CheckResult malformed;
  try {
    std::vector<std::string> trusted;
    for (const std::string& path : key_paths) trusted.push_back(read_public_key(read_file(path), path));
    const std::string text = read_file(certificate_path);
    if (case_path.empty()) return check_certificate(text, nullptr, trusted);
    const nlohmann::json problem = to_json(load_case(case_path).problem);
    return check_certificate(text, &problem, trusted);
  } catch (const Malformed& error) {
    malformed.message = error.what();
  } catch (const InputError& error) {
    malformed.message = error.what();
  }
  return malformed;
}

/// Who vouches for the file.
std::string describe_signer(const CheckResult& result) {
  if (result.signer.empty()) return "not signed";
  return "signed by key " + fingerprint(result.signer) + (result.is_trusted ? "; trusted" : "; not trusted by anyone");
}

int run(int argc, char** argv) {
  CLI::App app("Proves the claim of a certificate again, independently of the program that wrote it.", "taut-check");
  std::string certificate_path;
  std::string case_path;
  std::vector<std::string> key_paths;
  bool as_json = false;
  bool quiet = false;
  app.add_option("CERTIFICATE", certificate_path, "certificate.json")->required();
  app.add_option("CASE", case_path, "case that the certificate must be about (an audit's path is its own)");
  app.add_option("--trust", key_paths, "reject what is not signed by this Ed25519 public key (PEM); repeatable")
      ->allow_extra_args(false);
  app.add_flag("--json", as_json, "print one JSON object");
  app.add_flag("--quiet", quiet, "print nothing: the exit code says it");
  app.set_version_flag("--version", std::string("taut-check ") + TAUT_VERSION);
  app.footer("Exit codes: 0 accepted, 1 rejected, 2 the certificate says undecided, 3 malformed, 4 internal failure.");
  app.failure_message([](const CLI::App* /*failed*/, const CLI::Error& error) {
    return sanitize(error.what()) + "\nRun with --help for more information.\n";
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    if (!std::cout.flush()) throw std::runtime_error("could not write to standard output");
    return code == 0 ? 0 : 3;
  }

  const auto start = std::chrono::steady_clock::now();
  const CheckResult result = check_file(certificate_path, case_path, key_paths);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (as_json && !quiet) {
    nlohmann::json signature;
    if (!result.signer.empty()) {
      signature = {{"key", fingerprint(result.signer)}, {"public_key", result.signer}, {"trusted", result.is_trusted}};
    }
    const nlohmann::json report = {{"outcome", name(result.outcome)}, {"message", result.message},
                                   {"verdict", result.verdict},       {"audit", result.is_audit},
                                   {"segments", result.segments},     {"boxes", result.boxes},
                                   {"pieces", result.pieces},         {"bits", result.bits},
                                   {"signature", signature},          {"seconds", seconds}};
    std::cout << report.dump(2, ' ', true, nlohmann::json::error_handler_t::replace) << std::endl;
  } else if (!quiet && result.outcome != Outcome::kMalformed) {
    char time[32];
    std::snprintf(time, sizeof time, "%.2f s", seconds);
    std::cout << name(result.outcome) << ": " << sanitize(result.message) << ", " << time << "; "
              << describe_signer(result) << std::endl;
  }
  if (!quiet && result.outcome == Outcome::kMalformed) {
    std::cerr << name(result.outcome) << ": " << sanitize(result.message) << std::endl;
  }
  if (!std::cout) throw std::runtime_error("could not write to standard output");
  return exit_code(result.outcome);
}

}  // namespace
}  // namespace taut::checker

/// Before all other initialisation, which may fail for want of memory, too.
[[gnu::constructor(101)]] static void prepare() { taut::prepare_process("taut-check", ""); }

int main(int argc, char** argv) {
  try {
    return taut::checker::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "taut-check: internal failure: out of memory" << std::endl;
    return 4;
  } catch (const std::exception& error) {
    std::cerr << "taut-check: internal failure: " << taut::sanitize(error.what()) << std::endl;
    return 4;
  }
}
