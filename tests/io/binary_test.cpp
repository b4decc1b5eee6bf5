#include "io/binary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "karcher/error.hpp"

namespace karcher {
namespace {

TEST(Binary, BringsBackWhatWasWrittenInTheOrderOfItsBytes) {
  BinaryWriter writer;
  writer.number<std::uint32_t>(0x04030201);
  writer.text("abc");
  writer.numbers<double>(std::vector<double>{-0.0, std::numeric_limits<double>::denorm_min()});
  writer.numbers<double>(std::vector<double>{});
  EXPECT_EQ(writer.bytes().substr(0, 7),
            "\x01\x02\x03\x04"
            "abc");
  BinaryReader reader(writer.bytes(), "short");
  EXPECT_EQ(reader.number<std::uint32_t>(), 0x04030201U);
  EXPECT_EQ(reader.text(3), "abc");
  const std::vector<double> numbers = reader.numbers<double>(2);
  EXPECT_TRUE(std::signbit(numbers[0]));
  EXPECT_EQ(numbers[1], std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(reader.left(), 0U);
  EXPECT_TRUE(reader.numbers<double>(0, 3).empty());
  EXPECT_EQ(reader.text(0), "");
}

TEST(Binary, RefusesByTheCallersSentenceWhateverIsLongerThanTheRest) {
  const std::string bytes(16, '\0');
  const auto refusal = [&](auto read) -> std::string {
    BinaryReader reader(bytes, "The list is too short.");
    try {
      read(reader);
    } catch (const InputError& e) {
      EXPECT_EQ(reader.left(), 16U) << "nothing is taken";
      return e.what();
    }
    return "accepted";
  };
  constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<double>(2); }), "accepted");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<float>(2, 2); }), "accepted");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<double>(3); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<float>(2, 3); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.text(17); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.text(huge); }), "The list is too short.");
  // Their products are 0, 16 and 2 modulo 2^64.
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<float>(std::uint64_t{1} << 62); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<double>((std::uint64_t{1} << 61) + 2); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<std::uint8_t>(6148914691236517206U, 3); }), "The list is too short.");
  EXPECT_EQ(refusal([](BinaryReader& r) { r.numbers<float>(1, huge); }), "The list is too short.");
}

TEST(Binary, CheckSumIsThatOfZlib) { EXPECT_EQ(check_sum("123456789"), 0xCBF43926U); }  // the check value in catalogues of CRC-32

}  // namespace
}  // namespace karcher
