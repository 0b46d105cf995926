// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/path_audit.h"

#include <utility>

#include "app/tolerance_table.h"
#include "base/input_error.h"
#include "certificate/certificate.h"

namespace taut {
namespace {

/// The first violation; what a refuted certificate has as its witness.
nlohmann::json witness_json(const Audit& audit) {
  for (const AuditStretch& stretch : audit.stretches) {
    if (stretch.inner) return stretch.inner_json.first;
  }
  return nullptr;
}

}  // namespace

const std::map<std::string, Interpolation>& audit_laws() {
  static const std::map<std::string, Interpolation> all = {{"straight", Interpolation::kStraight},
                                                           {"geodesic", Interpolation::kGeodesic},
                                                           {"cable-lengths", Interpolation::kCableLengths}};
  return all;
}

AuditRequest resolved(AuditRequest request, const Case& the_case, const std::string& case_path) {
  if (!request.path.name.empty()) return request;
  if (!the_case.audit) {
    throw InputError(case_path + ": got no PATH and no key 'audit', expected a path to audit", {case_path});
  }
  const auto& named = *the_case.audit;
  request.path = (std::filesystem::path(case_path).parent_path() / named.file).string();
  if (!request.law && !named.interpolation.empty()) request.law = audit_laws().at(named.interpolation);
  request.allow_repeats = request.allow_repeats || named.allow_repeats;
  return request;
}

PathAudit audit_path(PathSource& source, const PathAuditOptions& options, const WriteText& certificate,
                     const WriteText& csv, const AuditProgress& progress, const std::stop_token& stop) {
  ProofOptions proof_options;
  proof_options.max_bits = options.max_bits;
  const Prover prover(source.problem(), proof_options);
  CertificateStream stream(options.folder, source.problem(), source.law());
  PathAudit result;
  result.audit = audit(prover, source, stream, csv, progress, stop);
  const Audit& audit = result.audit;
  if (audit.interrupted) return result;

  CertificateStream::Ending ending;
  if (audit.verdict == Verdict::kProved && source.problem().tolerances && audit.segments <= kMostReported) {
    result.tolerance_limits = tolerance_limits(source.problem(), source.whole_path(), stop);
    result.audit.interrupted = stop.stop_requested();
    if (audit.interrupted) return result;
    ending.illustration = {{"kind", "audit"}, {"tolerance_limits", to_json(result.tolerance_limits)}};
  }
  result.witness = witness_json(audit);
  ending.verdict = audit.verdict;
  ending.margins = audit.margins;
  ending.witness = result.witness;
  ending.undecided = undecided_json(audit);
  ending.source = source.source();
  CertificateStream::Sign sign;
  if (options.key != nullptr) sign = [&](const std::string& digest) { return options.key->signature(digest); };
  stream.finish(ending, certificate, sign);
  return result;
}

}  // namespace taut
