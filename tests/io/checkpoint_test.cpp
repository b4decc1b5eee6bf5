#include "karcher/io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/mesh/generators.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

ManifoldOps space_like(const std::string& name, int ambient) {
  ManifoldOps ops;
  ops.name = name;
  ops.ambient = ambient;
  return ops;
}
const ManifoldOps r3 = space_like("R3", 3), so3 = space_like("SO3", 4);

std::vector<Field> two_fields(int order = 2, double width = 1) {
  GeneratorOptions options;
  options.name = "rectangle";
  options.numbers = {{"size", {width, 1}}, {"cells", {2, 3}}};
  const auto mesh = std::make_shared<const Mesh>(generate(options));
  const auto space = std::make_shared<const Space>(mesh, mesh->region("all"), order);
  return {{"m", &r3, Rule::projection, space}, {"Q", &so3, Rule::projection, space}};
}

Checkpoint random_checkpoint(const std::vector<Field>& fields) {
  std::mt19937_64 random(11);
  Checkpoint c;
  c.load_step = 3;
  c.increment = 0.1 + 0.2;
  c.largest_gradient = 1e5 / 3;
  c.configuration.t = 1.0 / 3;
  c.summary = "{\"title\": \"x\"}";
  for (const Field& f : fields) {
    auto& values = c.configuration.values.emplace_back();
    while (values.size() < static_cast<std::size_t>(f.space->node_count() * f.manifold->ambient)) {
      const double x = std::bit_cast<double>(random());
      if (!std::isnan(x)) values.push_back(x);
    }
  }
  return c;
}

std::string refusal(const std::filesystem::path& file, const std::vector<Field>& fields, std::uint64_t identity) {
  try {
    read_checkpoint(file, fields, identity);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Checkpoint, BringsBackEveryBit) {
  const TemporaryDirectory directory;
  const auto fields = two_fields();
  const auto identity = Identity().add(std::span<const Field>(fields)).value();
  const Checkpoint c = random_checkpoint(fields);
  write_checkpoint(directory / "checkpoint.bin", c, fields, identity);
  const Checkpoint back = read_checkpoint(directory / "checkpoint.bin", fields, identity);
  EXPECT_EQ(back.load_step, 3);
  EXPECT_EQ(back.increment, c.increment);
  EXPECT_EQ(back.largest_gradient, c.largest_gradient);
  EXPECT_EQ(back.configuration.t, c.configuration.t);
  EXPECT_EQ(back.summary, c.summary);
  ASSERT_EQ(back.configuration.values.size(), 2U);
  for (std::size_t f = 0; f < 2; ++f) {
    ASSERT_EQ(back.configuration.values[f].size(), c.configuration.values[f].size());
    for (std::size_t i = 0; i < c.configuration.values[f].size(); ++i)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(back.configuration.values[f][i]), std::bit_cast<std::uint64_t>(c.configuration.values[f][i]));
  }
}

TEST(Checkpoint, TruncationIsRefusedWhereverItIs) {
  const TemporaryDirectory directory;
  const auto fields = two_fields(1);
  write_checkpoint(directory / "whole", random_checkpoint(fields), fields, 5);
  const std::string content = read_whole(directory / "whole");
  for (std::size_t size = 0; size < content.size(); size += size < 150 ? 1 : 7) {
    std::ofstream(directory / "part", std::ios::binary) << content.substr(0, size);
    const std::string sentence = refusal(directory / "part", fields, 5);
    EXPECT_TRUE(contains(sentence, size == 0 ? "not a checkpoint" : "truncated")) << size << ": " << sentence;
  }
}

TEST(Checkpoint, AFlippedByteIsRefusedWhereverItIs) {
  const TemporaryDirectory directory;
  const auto fields = two_fields(1);
  write_checkpoint(directory / "whole", random_checkpoint(fields), fields, 5);
  const std::string content = read_whole(directory / "whole");
  for (std::size_t i = 0; i < content.size(); i += i < 150 ? 1 : 7) {
    std::string damaged = content;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    std::ofstream(directory / "damaged", std::ios::binary) << damaged;
    EXPECT_NE(refusal(directory / "damaged", fields, 5), "accepted") << i;
  }
  std::ofstream(directory / "longer", std::ios::binary) << content << "x";
  EXPECT_TRUE(contains(refusal(directory / "longer", fields, 5), "damaged"));
}

TEST(Checkpoint, OtherVersionsAndOtherFilesAreRefusedByName) {
  const TemporaryDirectory directory;
  const auto fields = two_fields(1);
  write_checkpoint(directory / "whole", random_checkpoint(fields), fields, 5);
  std::string content = read_whole(directory / "whole");
  content[8] = 9;
  std::ofstream(directory / "version", std::ios::binary) << content;
  EXPECT_TRUE(contains(refusal(directory / "version", fields, 5), "has version 9; this program reads version 3"));
  std::ofstream(directory / "text") << "This is a letter, long enough to be a checkpoint.";
  EXPECT_TRUE(contains(refusal(directory / "text", fields, 5), "not a checkpoint of Karcher"));
  EXPECT_TRUE(contains(refusal(directory / "missing", fields, 5), "No such file"));
}

TEST(Checkpoint, NumbersThatNoRunHasAreDamage) {
  const TemporaryDirectory directory;
  const auto fields = two_fields();
  const auto of = [&](void (*spoil)(Checkpoint&)) {
    Checkpoint c = random_checkpoint(fields);
    spoil(c);
    write_checkpoint(directory / "c", c, fields, 5);
    return refusal(directory / "c", fields, 5);
  };
  EXPECT_EQ(of([](Checkpoint&) {}), "accepted");
  EXPECT_TRUE(contains(of([](Checkpoint& c) { c.load_step = -1; }), "is damaged"));
  EXPECT_TRUE(contains(of([](Checkpoint& c) { c.configuration.t = std::nan(""); }), "is damaged"));
  EXPECT_TRUE(contains(of([](Checkpoint& c) { c.increment = HUGE_VAL; }), "is damaged"));
  EXPECT_TRUE(contains(of([](Checkpoint& c) { c.largest_gradient = -1; }), "is damaged"));
}

TEST(Checkpoint, AnotherProblemIsRefusedAndSaysWhatDiffers) {
  const TemporaryDirectory directory;
  const auto fields = two_fields();
  write_checkpoint(directory / "c", random_checkpoint(fields), fields, 5);
  EXPECT_TRUE(
      contains(refusal(directory / "c", two_fields(1), 5), "it holds field m in R3 with 35 nodes, the problem has field m in R3 with 12 nodes"));
  EXPECT_TRUE(contains(refusal(directory / "c", {fields[0]}, 5), "it holds 2 fields, the problem has 1"));
  EXPECT_TRUE(contains(refusal(directory / "c", {fields[1], fields[0]}, 5), "the problem has field Q in SO3"));
  EXPECT_TRUE(contains(refusal(directory / "c", fields, 6), "mesh, energies, loads or boundary data have changed"));
}

TEST(Identity, TellsMeshesOrdersRulesAndTextsApart) {
  const auto of = [](const std::vector<Field>& fields) { return Identity().add(std::span<const Field>(fields)).value(); };
  EXPECT_EQ(of(two_fields()), of(two_fields()));
  EXPECT_NE(of(two_fields()), of(two_fields(1)));
  EXPECT_NE(of(two_fields()), of(two_fields(2, std::nextafter(1.0, 2.0))));
  auto geodesic = two_fields();
  geodesic[1].rule = Rule::geodesic;
  EXPECT_NE(of(two_fields()), of(geodesic));
  // A region of as many cells elsewhere.
  const auto moved = two_fields();
  Mesh mesh = moved[0].space->mesh();
  std::swap(mesh.regions.at("left").cells, mesh.regions.at("right").cells);
  const auto space = std::make_shared<const Space>(std::make_shared<const Mesh>(mesh), mesh.region("all"), 2);
  EXPECT_NE(of(two_fields()), of({{"m", &r3, Rule::projection, space}, {"Q", &so3, Rule::projection, space}}));
  EXPECT_NE(Identity().add("ab").add("c").value(), Identity().add("a").add("bc").value());
  EXPECT_EQ(Identity().add(-0.0).value(), Identity().add(0.0).value());
}

}  // namespace
}  // namespace karcher
