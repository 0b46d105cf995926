// SPDX-License-Identifier: GPL-3.0-or-later
// A robot of CASPR is refused with an InputError, or it is made into a case that can be read. The input is the file of
// cables, a byte NUL, and the file of bodies.
#include "cli/caspr.h"

#include <cstdint>
#include <string>

#include "base/input_error.h"
#include "case/case_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = text.find('\0');
  ImportedCase made;
  try {
    made = case_from_caspr({{"cables.xml", text.substr(0, end)},
                            {"bodies.xml", end == std::string::npos ? "" : text.substr(end + 1)},
                            read_caspr_units("length=m,force=N"),
                            ""},
                           "fuzz");
  } catch (const InputError&) {
    return 0;
  }
  static_cast<void>(parse_case(made.text, "fuzz.yaml"));
  return 0;
}
