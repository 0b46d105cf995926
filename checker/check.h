// SPDX-License-Identifier: GPL-3.0-or-later
// Is the claim of a certificate true? Proves it again, from the file alone.
//
// This checker shares with the prover the certificate's format and nothing else: own equations, own parser, own
// arithmetic, and no search. To believe "accepted", read in this order: theorem.h; in kernel/ (the mathematics)
// errors.h, ball.h, mean_value_form.h, expression.h, linear.h, surface.h, statement.h, loads.h, bodies.h,
// machine.h, zero.h, motion.h, moving.h, deviation.h, clearance.h, mesh_clearance.h, mesh_inside.h, box_proof.h,
// deviant.h and their .cc; witness.h, near_waypoints.h and confirm.cc (what is proved of which poses); then format/
// (that the numbers are those of the file); format/signature.h if it matters who wrote it. For legs: legs.h and .cc.
// For "no path": cell_form.h, outside.h and .cc in kernel/, then no_path.h and .cc.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "checker/kernel/errors.h"
#include "checker/theorem.h"

namespace taut::checker {

enum class Outcome {
  kAccepted,   ///< the claim, "proved", "refuted" or "no path", was proved again
  kRejected,   ///< well formed, but some statement could not be confirmed, or is not what was asked for
  kUndecided,  ///< well formed, and the certificate itself claims nothing
  kUnchecked,  ///< well formed, but the budget ran out: nothing is known of its claim
  kMalformed,  ///< unreadable, cut, altered, or no certificate
};

/// "accepted", "rejected", "undecided", "unchecked" or "malformed".
[[nodiscard]] const char* name(Outcome outcome);
/// "proved", "refuted" or "no path".
[[nodiscard]] const char* name(Theorem::Verdict verdict);

enum class Law;  // of kernel/statement.h, which this header leaves out as it needs Arb

/// A path that the certificate's must equal: its space, its law, and its waypoints bit for bit. Under the law of cable
/// lengths these are the lengths; the poses beside them, which only say in which assembly the robot is, must agree to
/// 1e-6 m and 1e-6. On constraints the normals, which lead to the motion between waypoints, must agree to 1e-9.
struct ExpectedPath {
  struct Row {
    std::vector<double> x;
    std::vector<int> half_turns;  ///< under a law of poses there are none to compare
    std::vector<double> normals;  ///< of the constraints at x, as in certificates, from floating point
    std::size_t line = 0;         ///< of the file, for messages
  };
  std::string name;  ///< of the file, for messages
  Law law{};
  nlohmann::json space;            ///< what the numbers of rows are, as in a certificate's `problem`
  std::vector<Row> waypoints;      ///< a single one is a path that stays there
  std::string sha256;              ///< of the file
  std::string certificate_sha256;  ///< that the file names as its certificate's; empty where it names none
};

/// A mesh as somebody has read it from its file, whose SHA-256 comes with it. The checker compares the digest, and
/// takes for granted that these are the file's points and faces.
struct SuppliedMesh {
  std::string sha256;
  std::vector<std::array<double, 3>> points;            ///< in the file's unit
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points
  std::vector<std::array<std::uint32_t, 2>> needles;    ///< segments that are no edge of a triangle
};
/// Looks for the file that a certificate names, with this digest. It may throw, and check() lets that pass.
using MeshSupplier = std::function<SuppliedMesh(const std::string& file, const std::string& sha256)>;

struct CheckOptions {
  /// Where not null: what the certificate's `problem` must equal; of a case of legs the array of their problems, which
  /// those of a certificate of legs must equal in their order, and one of which that of another certificate must equal.
  const nlohmann::json* problem = nullptr;
  const ExpectedPath* path = nullptr;        ///< where not null: what its `path` must equal
  std::optional<Theorem::Verdict> expect{};  ///< a claim of another verdict is rejected
  std::vector<std::string> trusted{};        ///< unless empty: public keys (signature.h), one of which must have signed
  unsigned threads = 0;                      ///< to prove with; 0: as many as there are cores
  std::optional<double> max_seconds{};       ///< budget; 0: read and compare, but prove nothing; nothing: no end
  MeshSupplier meshes{};                     ///< where the problem has meshes
  std::stop_token stop{};                    ///< asks to stop: looked at before each box
  /// Whether result and theorem hold what was read as JSON, for whoever shows it; takes many times the file's memory.
  bool keeps_certificate = true;
};

struct CheckResult {
  Outcome outcome = Outcome::kMalformed;
  std::string message = "nothing was checked";  ///< one line of printable ASCII, without the outcome itself
  std::optional<Theorem> theorem;               ///< present exactly where accepted
  /// What was read, unless malformed; of legs their whole. Where there is no theorem, nothing that it claims is known
  /// to be true.
  std::shared_ptr<const nlohmann::json> certificate;
  std::string sha256;                     ///< of the bytes
  std::string signer;                     ///< public key whose signature was verified, or empty
  std::vector<SuppliedMesh> meshes;       ///< that were supplied, each once, if `certificate` is kept
  bool is_trusted = false;                ///< whether the signer is one of those asked for
  bool is_audit = false;                  ///< the path itself is what was asked about
  std::vector<CheckResult> legs;          ///< of a certificate of legs: check() of the bytes of each, as far as it came
  Theorem::Counts counts;                 ///< as far as the check went
  std::vector<std::string> not_compared;  ///< "case", "path file", and what of these does not matter to it
};

/// SHA-256 of some bytes, 64 lower-case hex digits.
[[nodiscard]] std::string sha256(const std::string& bytes);

/// Proves a certificate again.
/// @param bytes  the whole file.
/// Never throws because of what the bytes say. @throws Interrupted where options.stop asked for it; any other
/// std::exception only where this program or machine fails.
/// Cost: in proportion to the size of the file; about a fifth of a millisecond a box, and with tolerances half a
/// millisecond for each part of the ways to deviations. Thread-safe.
[[nodiscard]] CheckResult check(const std::string& bytes, const CheckOptions& options = {});

}  // namespace taut::checker
