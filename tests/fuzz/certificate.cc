// SPDX-License-Identifier: GPL-3.0-or-later
// The checker gives a result for every certificate, also if its counts and digests are right. Nothing is accepted that
// was not among the seeds by another name: what the claims say is mutation_test.cc's to look at.
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

/// The checker's result, within a small budget: inputs differ in how they are read and in the first boxes, so that long
/// proofs need not be checked to the end.
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
