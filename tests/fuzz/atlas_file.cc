// SPDX-License-Identifier: GPL-3.0-or-later
// An atlas file is refused, or the query is planned and proved as without it: a file only says where to look. Its
// header is sealed again, so that what the tables hold is looked at.
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/input_error.h"
#include "planner/planner.h"

namespace {

constexpr std::size_t kHeader = 192;
constexpr std::size_t kChecksum = 16;

void seal(std::string& bytes) {
  if (bytes.size() < kHeader) return;
  std::memset(bytes.data() + kChecksum, 0, sizeof(std::uint64_t));
  std::uint64_t tables = 0;
  std::memcpy(&tables, bytes.data() + kChecksum + 8, sizeof tables);
  if (tables > bytes.size() - kHeader) return;
  const std::uint64_t seed = XXH3_64bits(bytes.data(), kHeader);
  const std::uint64_t digest = XXH3_64bits_withSeed(bytes.data() + kHeader, tables, seed);
  std::memcpy(bytes.data() + kChecksum, &digest, sizeof digest);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  static const Case the_case = load_case(TAUT_SOURCE_DIR "/cases/robot1-slice-qs1-qg.yaml");
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("taut_fuzz." + std::to_string(::getpid()) + ".atlas");
  std::string bytes(reinterpret_cast<const char*>(data), size);
  seal(bytes);
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    Planner planner(the_case, file);
    if (planner.plan({}, {}).proof.verdict != Verdict::kProved) __builtin_trap();
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): what bad input is for
  }
  std::filesystem::remove(file);
  return 0;
}
