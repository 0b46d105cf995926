// The checker says something of every certificate, also of those whose counts and digests are right. Nothing is accepted that was not
// among the seeds by another name: what the claims say is mutation_test.cc's to look at.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "certify/checker/check.h"
#include "tests/checker/fixtures.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut::checker;
  const std::string text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(check_certificate(text));
  nlohmann::json sealed = nlohmann::json::parse(text, nullptr, false);
  if (sealed.is_discarded() || !sealed.is_object()) return 0;
  try {
    seal(sealed);
  } catch (const std::exception&) {
    return 0;  // numbers that no digest is made of
  }
  if (check_certificate(sealed.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)).message.empty()) {
    __builtin_trap();
  }
  return 0;
}
