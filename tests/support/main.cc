// SPDX-License-Identifier: GPL-3.0-or-later
// gtest's main, with --file=NAME_test.cc: runs the tests that this file defines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

namespace {

/// The filter that selects the tests of `file`. Empty, with a message on stderr, where there is none, or where another
/// file has a test of the same name.
std::string filter_of(const std::string& file) {
  std::string filter;
  std::map<std::string, std::string> file_of;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      const std::string name = std::string(suite.name()) + "." + test.name();
      const std::string defined_in = std::filesystem::path(test.file()).filename();
      const auto [first, is_new] = file_of.try_emplace(name, defined_in);
      if (!is_new && first->second != defined_in) {
        std::fprintf(stderr, "%s is in %s and in %s\n", name.c_str(), first->second.c_str(), defined_in.c_str());
        return "";
      }
      if (defined_in == file) filter += name + ":";
    }
  }
  if (filter.empty()) std::fprintf(stderr, "no tests in %s\n", file.c_str());
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  const std::string option = "--file=";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (!argument.starts_with(option)) {
      std::fprintf(stderr, "unknown argument %s: expected --file=NAME_test.cc or an option of gtest\n", argv[i]);
      return 2;
    }
    const std::string filter = filter_of(argument.substr(option.size()));
    if (filter.empty()) return 2;
    testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
