// SPDX-License-Identifier: GPL-3.0-or-later
// A case file is refused with an InputError, or it is a problem that can be written down and modelled.
#include "case/case_file.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "base/input_error.h"
#include "case/case_of_legs.h"
#include "kinematics/pose_sampler.h"
#include "problem/problem.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  try {
    const Case read = parse_case_of_legs(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml").whole;
    static_cast<void>(to_json(read.problem).dump());
    const PoseSampler sampler(read.problem);
    static_cast<void>(sampler);
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): what bad input is for
  }
  return 0;
}
