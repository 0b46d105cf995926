// SPDX-License-Identifier: GPL-3.0-or-later
// What the checker has proved: the only thing in taut that is a verdict.
//
// In the manner of LCF provers: a Theorem has no public constructor, and check() is the only function that can make
// one. Whoever is handed a Theorem therefore knows, by its type, that the checker has proved the claim; reports, exit
// codes and the library take a Theorem where they state a verdict, and nothing else.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace taut::checker {

struct CheckOptions;
struct CheckResult;

/// The claim of a certificate, proved by this checker. Copies are cheap.
class Theorem {
 public:
  enum class Verdict {
    kProved,   ///< the claim holds along the whole path; of legs, along each
    kRefuted,  ///< it does not: the witness violates a limit or is singular; of legs, on one of them
    kNoPath,   ///< no motion leads from one waypoint of the query to the next; there are no path, margins or witness
  };
  struct Counts {
    std::size_t segments = 0;
    std::size_t boxes = 0;  ///< of kNoPath: the cells that were proved to hold no feasible pose
    int bits = 0;           ///< the highest precision that was used
  };

  [[nodiscard]] Verdict verdict() const { return verdict_; }
  /// What was proved or refuted, in words; the checker has compared them with the words that the format prescribes.
  [[nodiscard]] const std::string& claim() const { return text("claim"); }
  /// Whether it is about legs, each of which has a theorem of its own (CheckResult::legs): then there are no problem,
  /// path, margins or witness of the whole.
  [[nodiscard]] bool is_of_legs() const { return certificate().contains("legs"); }
  [[nodiscard]] const nlohmann::json& problem() const {
    if (is_of_legs()) throw std::logic_error("a theorem of legs, each of which has a problem");
    return certificate()["problem"];
  }
  [[nodiscard]] const nlohmann::json& path() const { return part("path"); }
  /// Proved lower bounds, decimals as the certificate writes them; an empty object unless proved.
  [[nodiscard]] const nlohmann::json& margins() const { return part("margins"); }
  /// The violation; null unless refuted.
  [[nodiscard]] const nlohmann::json& witness() const { return part("witness"); }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// SHA-256 of the bytes that were checked, 64 lower-case hex digits.
  [[nodiscard]] const std::string& sha256() const { return sha256_; }
  /// What was read from these bytes, so that what is shown is what was checked. Of it `generator`, `illustration`,
  /// `source` and names are free text: no part of the theorem.
  /// @throws std::logic_error where CheckOptions::keeps_certificate was off; so do those above that show parts of it.
  [[nodiscard]] const nlohmann::json& certificate() const {
    if (certificate_ == nullptr) throw std::logic_error("a theorem without its certificate");
    return *certificate_;
  }

 private:
  friend CheckResult check(const std::string& bytes, const CheckOptions& options);
  Theorem(Verdict verdict, std::shared_ptr<const nlohmann::json> certificate, std::string sha256, Counts counts)
      : verdict_(verdict), certificate_(std::move(certificate)), sha256_(std::move(sha256)), counts_(counts) {}

  /// What only certificates of paths have.
  [[nodiscard]] const nlohmann::json& part(const char* key) const {
    if (verdict_ == Verdict::kNoPath || is_of_legs()) throw std::logic_error("a theorem without a path");
    return certificate()[key];
  }
  [[nodiscard]] const std::string& text(const char* key) const {
    return certificate()[key].get_ref<const std::string&>();
  }

  Verdict verdict_;
  std::shared_ptr<const nlohmann::json> certificate_;
  std::string sha256_;
  Counts counts_;
};

}  // namespace taut::checker
