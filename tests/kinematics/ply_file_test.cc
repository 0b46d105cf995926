// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/ply_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "base/input_error.h"

namespace taut {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kPoints = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kData = "0 0 0\n1 0 0\n0 1 0.1\n3 0 1 2\n";

std::string text(const std::string& elements) { return "ply\nformat ascii 1.0\n" + elements + "end_header\n"; }

void expect_rejected(const std::string& bytes, const std::string& message) {
  EXPECT_THAT([&] { (void)read_ply(bytes); }, ThrowsMessage<InputError>(HasSubstr(message))) << bytes;
}

template <class T>
void append(std::string& bytes, T number, bool is_little_endian) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (!is_little_endian) std::ranges::reverse(raw);
  bytes.append(raw.begin(), raw.end());
}

/// A triangle with numbers of all types.
std::string binary(bool is_little_endian) {
  std::string bytes = std::string("ply\r\nformat binary_") + (is_little_endian ? "little" : "big") +
                      "_endian 1.0\r\ncomment end_header?\r\nelement vertex 3\r\nproperty uchar red\r\n"
                      "property float x\r\nproperty double y\r\nproperty list uint short marks\r\n"
                      "property float64 z\r\nelement face 1\r\nproperty int8 flag\r\n"
                      "property list uint uint16 vertex_index\r\nproperty ushort group\r\nelement edge 1\r\n"
                      "property int vertex1\r\nproperty uint vertex2\r\nend_header\r\n";
  for (int i = 0; i < 3; ++i) {
    append<std::uint8_t>(bytes, 255, is_little_endian);
    append<float>(bytes, 0.1F * static_cast<float>(i), is_little_endian);
    append<double>(bytes, 0.1 * i * i, is_little_endian);
    append<std::uint32_t>(bytes, 2, is_little_endian);
    append<std::int16_t>(bytes, -1, is_little_endian);
    append<std::int16_t>(bytes, 258, is_little_endian);
    append<double>(bytes, -3, is_little_endian);
  }
  append<std::int8_t>(bytes, -128, is_little_endian);
  append<std::uint32_t>(bytes, 3, is_little_endian);
  for (const int corner : {2, 1, 0}) append(bytes, static_cast<std::uint16_t>(corner), is_little_endian);
  append<std::uint16_t>(bytes, 7, is_little_endian);
  append<std::int32_t>(bytes, 0, is_little_endian);
  append<std::uint32_t>(bytes, 1, is_little_endian);
  return bytes;
}

TEST(PlyFile, HoldsTheNumbersOfItsText) {
  const PolygonSoup soup = read_ply(text("comment by hand\n" + kPoints + kFaces) + kData);
  ASSERT_EQ(soup.points.size(), 3U);
  EXPECT_THAT(soup.points[2], ElementsAre(0, 1, 0.1));
  EXPECT_THAT(soup.faces, ElementsAre(ElementsAre(0, 1, 2)));
}

TEST(PlyFile, OfBinary32NumbersInTextHoldsTheNearestOnes) {
  // Halfway between two of them and a little more; rounded to binary64 first, it would be halfway.
  const PolygonSoup soup = read_ply(text("element vertex 1\nproperty float x\nproperty float32 y\nproperty float z\n") +
                                    "0.1 +1.0000000596046447753906250000000000000001 -2\n");
  EXPECT_THAT(soup.points.at(0), ElementsAre(0.1F, std::nextafter(1.0F, 2.0F), -2));
}

TEST(PlyFile, OfNumbersThatAreTooSmallHoldsZero) {
  const PolygonSoup soup =
      read_ply(text("element vertex 1\nproperty float x\nproperty double y\nproperty float z\nproperty float nx\n") +
               "1e-50 -1e-400 1.5e-45 6e-80\n");
  EXPECT_THAT(soup.points.at(0), ElementsAre(0, 0, std::numeric_limits<float>::denorm_min()));
}

TEST(PlyFile, OfBytesInEitherOrderHoldsTheSame) {
  for (const bool is_little_endian : {true, false}) {
    const PolygonSoup soup = read_ply(binary(is_little_endian));
    ASSERT_EQ(soup.points.size(), 3U);
    EXPECT_THAT(soup.points[2], ElementsAre(0.1F * 2.0F, 0.1 * 2 * 2, -3));
    EXPECT_THAT(soup.faces, ElementsAre(ElementsAre(2, 1, 0)));
  }
}

TEST(PlyFile, ThatEndsTooEarlyIsRejected) {
  const std::string whole = binary(true);
  EXPECT_EQ(read_ply(whole + "\r\n").faces.size(), 1U);
  for (std::size_t size = 0; size < whole.size(); ++size) expect_rejected(whole.substr(0, size), "expected");
  expect_rejected(text(kPoints + kFaces), "which is no whole ply file");
  expect_rejected(text(kPoints + kFaces) + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "which is no whole ply file");
}

TEST(PlyFile, WithAStatedCountThatItDoesNotHoldTakesNoMemoryForIt) {
  const std::string all = "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n";
  expect_rejected(text(kPoints + "element face 1\nproperty list uint int vertex_indices\n") + all, "no whole ply file");
  expect_rejected(text(kPoints + "element face 18446744073709551615\nproperty list uint int vertex_indices\n") + kData,
                  "faces, expected at most 1000000");
  expect_rejected(text("element edge 18446744073709551615\nproperty int a\n" + kPoints + kFaces) + kData,
                  "no whole ply file");
  expect_rejected(text(kPoints + "element face 1000001\nproperty list uint int vertex_indices\n") + kData,
                  "a mesh of 1000001 faces, expected at most 1000000");
  // Nothing would ever be read of these.
  expect_rejected(text("element edge 18446744073709551615\n" + kPoints + kFaces) + kData, "have no properties");
  expect_rejected(text("element edge 18446744073709551616\nproperty int a\n" + kPoints + kFaces) + kData, "no count");
  expect_rejected(text("element edge -1\nproperty int a\n" + kPoints + kFaces) + kData, "no count of elements");
}

TEST(PlyFile, WithWhatIsNotKnownIsRejected) {
  expect_rejected(text(kPoints + "property int64 w\n" + kFaces) + kData, "numbers are of the type 'int64'");
  expect_rejected(text(kPoints + "property list float int w\n" + kFaces) + kData, "length of a list is no integer");
  expect_rejected(text("element vertex 3\nproperty doubles x\nproperty double y\nproperty double z\n" + kFaces) + kData,
                  "numbers are of the type 'doubles'");
  expect_rejected(text(kPoints + kFaces + "element tristrips 1\nproperty list int int vertex_indices\n") + kData,
                  "elements that are called 'tristrips'");
  expect_rejected(text("element vertex 3\nproperty float x\nproperty float y\n" + kFaces) + "0 0\n1 0\n0 1\n3 0 1 2\n",
                  "no floating-point number 'z'");
  expect_rejected(text("element vertex 3\nproperty float x\nproperty float y\nproperty int z\n" + kFaces) + kData,
                  "no floating-point number 'z'");
  expect_rejected(text("element vertex 3\nproperty double x y z\n" + kFaces) + kData, "'y' is not known");
  expect_rejected(text(kPoints + "end_headers\n" + kFaces) + kData, "'end_headers' is not known");
  expect_rejected(text("property int a\n" + kPoints + kFaces) + kData, "'property' is not known");
  expect_rejected(text(kPoints + "element face 1\nproperty list uchar int corners\n") + kData, "faces have no list");
  expect_rejected(text(kPoints + "element face 1\nproperty list uchar float vertex_index\n") + kData, "have no list");
  expect_rejected("ply\nformat ascii 2.0\n" + kPoints + kFaces + "end_header\n" + kData, "of the format 'ascii 2.0'");
  expect_rejected(text("format binary_little_endian 1.0\n" + kPoints + kFaces) + kData, "'format' is not known");
  expect_rejected("ply\n" + kPoints + kFaces + "end_header\n" + kData, "no whole ply file");
  expect_rejected("plx\nformat ascii 1.0\n" + kPoints + kFaces + "end_header\n" + kData, "no whole ply file");
}

TEST(PlyFile, WithThingsTwiceIsRejected) {
  expect_rejected(
      text("element vertex 3\nproperty int x\nproperty double x\nproperty double y\nproperty double z\n" + kFaces) +
          "0 0 0 0\n0 1 0 0\n0 0 1 0\n3 0 1 2\n",
      "property 'x' is there twice");
  expect_rejected(text(kPoints + "element vertices 1\nproperty int x\n" + kFaces) + "0 0 0\n1 0 0\n0 1 0\n7\n3 0 1 3\n",
                  "are there twice");
  expect_rejected(
      text(kPoints + kFaces + "property list uchar int vertex_index\n") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 2 1 0\n",
      "have no list of integers 'vertex_indices', or two");
  expect_rejected(text(kPoints + kFaces) + kData + "3 2 1 0\n", "holds more than its header says");
}

TEST(PlyFile, WithNumbersThatAreNoneIsRejected) {
  const std::string head = text(kPoints + kFaces);
  expect_rejected(head + "0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n", "'1,5' is no number");
  expect_rejected(head + "0 0 0\n1e-999x 0 0\n0 1 0\n3 0 1 2\n", "'1e-999x' is no number");
  expect_rejected(head + "0 0 0\n1e999 0 0\n0 1 0\n3 0 1 2\n", "'1e999' is no number");
  expect_rejected(head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n", "2.5 is no length of a list and no index");
  expect_rejected(head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "-2 is no length of a list and no index");
  expect_rejected(head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", "nan is no length of a list and no index");
  EXPECT_THAT([&] { (void)repaired(read_ply(head + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n")); },
              ThrowsMessage<InputError>(HasSubstr("point 2 is no number")));
}

}  // namespace
}  // namespace taut
