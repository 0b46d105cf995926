// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>

#include "base/input_error.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

/// A folder that goes when the test ends.
class Files : public ::testing::Test {
 protected:
  Files() {
    std::string name = (fs::temp_directory_path() / "taut-files-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Files() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path in_folder(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

TEST_F(Files, AppearWholeOrNotAtAll) {
  const fs::path path = in_folder("a");
  {
    NewFile file(path);
    file.write("half");
    file.finish();
    EXPECT_FALSE(fs::exists(path));
  }
  EXPECT_EQ(count(), 0U);
  write_whole({{path, "whole"}, {in_folder("b"), "too"}});
  EXPECT_EQ(read_whole(path), "whole");
  EXPECT_EQ(count(), 2U);
  EXPECT_THROW(write_whole({{path, "new"}, {in_folder("none/b"), "too"}}), InputError);
  EXPECT_EQ(read_whole(path), "whole");
  EXPECT_EQ(count(), 2U);
}

TEST_F(Files, AreRemovedFirstAndOnlyIfTheOthersCanBeWritten) {
  const std::array<fs::path, 2> old = {in_folder("path"), in_folder("never there")};
  write_whole({{old[0], "of before"}});
  EXPECT_THROW(write_whole({{in_folder("none/a"), "new"}}, old), InputError);
  EXPECT_EQ(read_whole(old[0]), "of before");
  write_whole({{in_folder("a"), "new"}}, old);
  EXPECT_FALSE(fs::exists(old[0]));
  fs::create_symlink("elsewhere", in_folder("path"));
  write_whole({{in_folder("elsewhere"), "of before"}});
  write_whole({{in_folder("a"), "newer"}, {old[0], "newer"}}, old);
  EXPECT_TRUE(fs::is_symlink(old[0]));
  EXPECT_EQ(read_whole(in_folder("elsewhere")), "newer");
}

TEST_F(Files, ASetIsOfOneWriter) {
  const std::array<fs::path, 3> paths = {in_folder("a"), in_folder("b"), in_folder("c")};
  for (int round = 0; round < 50; ++round) {
    const auto write = [&](const std::string& text) {
      write_whole({{paths[0], text}, {paths[1], text}, {paths[2], text}});
    };
    std::thread other(write, "other");
    write("this");
    other.join();
    for (const fs::path& path : paths) EXPECT_EQ(read_whole(path), read_whole(paths[0])) << round;
  }
}

TEST_F(Files, NoneIsReplacedWhereAFolderHasTheNameOfOne) {
  write_whole({{in_folder("a"), "before"}});
  fs::create_directory(in_folder("b"));
  EXPECT_THROW(write_whole({{in_folder("a"), "after"}, {in_folder("b"), "after"}}), InputError);
  EXPECT_EQ(read_whole(in_folder("a")), "before");
  EXPECT_EQ(count(), 2U);
}

TEST_F(Files, TwoOfOnePathAreWrittenAtOnce) {
  const fs::path path = in_folder("a");
  NewFile first(path);
  NewFile second(path);
  EXPECT_NE(first.temporary(), second.temporary());
  first.write("first");
  second.write("the second one");
  first.finish();
  second.finish();
  second.rename_into_place();
  EXPECT_EQ(read_whole(path), "the second one");
  first.rename_into_place();
  EXPECT_EQ(read_whole(path), "first");
}

TEST_F(Files, ThreadsThatWriteOnePathLeaveTheWholeOfOne) {
  const fs::path path = in_folder("a");
  constexpr std::size_t kSize = 300'000;
  std::atomic<int> wrong = 0;
  const auto write = [&](char letter) {
    for (int i = 0; i < 20; ++i) {
      try {
        write_whole({{path, std::string(kSize, letter)}});
        const std::string text = read_whole(path);
        if (text != std::string(kSize, text.at(0))) ++wrong;
      } catch (const InputError&) {
        ++wrong;
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (const char letter : {'a', 'b', 'c'}) threads.emplace_back(write, letter);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(count(), 1U);
}

TEST_F(Files, WhatKilledRunsLeftIsRemovedAndNothingElse) {
  const auto touch = [&](const std::string& name) { write_whole({{in_folder(name), "x"}}); };
  constexpr const char* kNoProcess = "2000000000";  // Linux has 2^22 at most
  const std::string left = std::string("a.") + kNoProcess + "-3.part";
  const std::vector<std::string> others = {"a." + std::to_string(::getpid()) + "-4000000000.part",
                                           std::string("b.") + kNoProcess + "-3.part",
                                           std::string("a.") + kNoProcess + ".part",
                                           std::string("a.") + kNoProcess + "-.part",
                                           std::string("a.") + kNoProcess + "-3x.part",
                                           "a.notes.part",
                                           "a.part"};
  touch(left);
  for (const std::string& name : others) touch(name);
  touch("a");
  EXPECT_FALSE(fs::exists(in_folder(left)));
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(in_folder(name))) << name;
}

}  // namespace
}  // namespace taut
