#include "karcher/catalogue/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "karcher/error.hpp"
#include "karcher/manifold/every_manifold.hpp"

namespace karcher {
namespace {

const EnergyInfo& info_of(const std::string& type) {
  for (const auto* catalogue : {&energy_catalogue(), &load_catalogue()})
    for (const EnergyInfo& info : *catalogue)
      if (info.type == type) return info;
  throw InputError("no " + type);
}

TEST(Catalogue, ListsEveryEntryOnceAndLoadsApart) {
  std::vector<std::string> names;
  for (const EnergyInfo& info : energy_catalogue()) {
    EXPECT_FALSE(info.load) << info.type;
    EXPECT_EQ(info.term_name(), info.type);
    names.push_back(info.type);
  }
  for (const char* type : {"chiral-skyrmion", "cosserat-plate", "cosserat-rod", "cosserat-shell", "expression", "frank-oseen", "harmonic",
                           "hyperelastic", "l2-distance", "reissner-mindlin"})
    EXPECT_EQ(std::count(names.begin(), names.end(), type), 1) << type;
  std::vector<std::string> loads;
  for (const EnergyInfo& info : load_catalogue()) {
    EXPECT_TRUE(info.load) << info.type;
    EXPECT_EQ(info.term_name(), info.type + "-load");
    loads.push_back(info.type);
  }
  EXPECT_EQ(loads, (std::vector<std::string>{"volume", "traction", "line", "point", "pressure", "moment"}));
}

TEST(Catalogue, HasHarmonicMapsIntoEveryManifoldAndRodsForDirectorsWithoutAHead) {
  EXPECT_EQ(info_of("harmonic").fields[0].manifolds, accepted(EveryManifold{}));
  EXPECT_TRUE(info_of("frank-oseen").fields[0].headless);
  EXPECT_FALSE(info_of("chiral-skyrmion").fields[0].headless);
  EXPECT_TRUE(info_of("cosserat-shell").fields[0].moves);
}

TEST(Catalogue, NamesTheNearestOfAnUnknownName) {
  try {
    make_term("volume-lod", TermInput{});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("There is no energy or load \"volume-lod\". Did you mean \"volume-load\"?"), std::string::npos)
        << error.what();
  }
}

TEST(Catalogue, AsksForEveryModulusOfACosseratShellAndKnowsBothCouplings) {
  const EnergyInfo& info = info_of("cosserat-shell");
  EXPECT_TRUE(info.lame);
  ASSERT_EQ(info.fields.size(), 2u);
  EXPECT_EQ(info.fields[0].key, "deformation");
  EXPECT_EQ(info.fields[1].key, "rotation");
  for (const Parameter& p : info.parameters) EXPECT_EQ(p.default_value.has_value(), p.name == "b" || p.name == "prestretch") << p.name;
  EXPECT_EQ(info.choices.at(0).values, (std::vector<std::string>{"default", "birsan-2021"}));
}

}  // namespace
}  // namespace karcher
