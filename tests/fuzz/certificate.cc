// SPDX-License-Identifier: GPL-3.0-or-later
// The checker says something of every certificate, also of those whose counts and digests are right. Nothing is accepted that was not
// among the seeds by another name: what the claims say is mutation_test.cc's to look at.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <thread>

#include "checker/check.h"
#include "tests/checker/fixtures.h"

namespace {

/// What the checker says. Not to the end of long proofs: what is read and what the first boxes are is what inputs differ in.
std::string said_of(const std::string& text) {
  using namespace taut::checker;
  constexpr std::chrono::milliseconds kMost{20};
  std::stop_source stop;
  std::mutex mutex;
  std::condition_variable_any done;
  const std::jthread clock([&](const std::stop_token& finished) {
    std::unique_lock lock(mutex);
    done.wait_for(lock, finished, kMost, [] { return false; });
    stop.request_stop();
  });
  try {
    return taut::checker::check(text, {.stop = stop.get_token()}).message;
  } catch (const Interrupted&) {
    return "it takes longer";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut::checker;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (said_of(text).empty()) __builtin_trap();
  nlohmann::json sealed = nlohmann::json::parse(text, nullptr, false);
  if (sealed.is_discarded() || !sealed.is_object()) return 0;
  try {
    seal(sealed);
  } catch (const std::exception&) {
    return 0;  // numbers that no digest is made of
  }
  if (said_of(sealed.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)).empty()) __builtin_trap();
  return 0;
}
