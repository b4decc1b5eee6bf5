// Energies that are formulas, through the program: the numbers of the compiled ones, undefined values, and what is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/problem_file.hpp"
#include "karcher/error.hpp"
#include "problems.hpp"

namespace karcher::testing {
namespace {

using nlohmann::json;

/// A straight rod along z, clamped at z = 0; its far end turns by t.
const std::string rod = R"toml([parameters]
stiffness = "70 + 10*z"
bending = 2
[mesh]
generate = "interval"
axis = "z"
length = 2
cells = [4]
[fields.m]
manifold = "R3"
order = 2
[fields.R]
manifold = "SO3"
order = 2
[fields.other]
manifold = "R1"
[[dirichlet]]
field = "m"
on = "front"
value = "initial"
[[dirichlet]]
field = "R"
on = "front"
value = "initial"
[[dirichlet]]
field = "R"
on = "back"
value = [0, "t", 0]
[continuation]
steps = 2
[quadrature]
line = 5
[[energies]]
type = "harmonic"
field = "other"
)toml";
const std::string compiled = R"toml([[energies]]
type = "cosserat-rod"
deformation = "m"
rotation = "R"
A = ["stiffness", 90, 100]
K = ["bending", 1, 0.7]
)toml";
const std::string written = R"toml([[energies]]
type = "expression"
fields = ["m", "R"]
moves = "m"
let = ["v1 = m[0].z*R.d1[0] + m[1].z*R.d1[1] + m[2].z*R.d1[2]",
       "v2 = m[0].z*R.d2[0] + m[1].z*R.d2[1] + m[2].z*R.d2[2]",
       "v3 = m[0].z*R.d3[0] + m[1].z*R.d3[1] + m[2].z*R.d3[2] - 1"]
density = """
  (stiffness*v1^2 + 90*v2^2 + 100*v3^2
   + bending*R.k1[0]^2 + R.k1[1]^2 + 0.7*R.k1[2]^2)/2"""
)toml";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}
/// The rod with one thing changed in its formula.
std::string rod_with(const std::string& from, const std::string& to) { return rod + replaced(written, from, to); }

TEST(ExpressionEnergy, BendsARodAsTheCompiledOne) {
  const Workshop shop;
  const json a = run(shop, rod + compiled, "", "compiled"), b = run(shop, rod + written, "", "written");
  ASSERT_EQ(a["load_steps"].size(), b["load_steps"].size());
  for (std::size_t k = 0; k < a["load_steps"].size(); ++k) {
    const double energy = a["load_steps"][k]["energy"];
    EXPECT_GT(energy, 0.01);
    EXPECT_NEAR(b["load_steps"][k]["energy"], energy, 1e-9 * energy);
    EXPECT_EQ(b["load_steps"][k]["negative_eigenvalues"], 0);
  }
  EXPECT_TRUE(b["energies"].contains("expression")) << b["energies"];
}

TEST(ExpressionEnergy, IsPartOfWhatARunThatGoesOnMustShare) {
  const Workshop shop;
  run(shop, rod + written);
  EXPECT_EQ(shop.karcher("run problem.toml -q --resume -o out").code, 0);
  shop.write("problem.toml", rod_with("0.7*R", "0.8*R"));
  EXPECT_EQ(shop.karcher("run problem.toml -q --resume -o out").code, 2);
}

TEST(ExpressionEnergy, IsTheSameOnTwoRanks) {
  const Workshop shop;
  const json one = run(shop, rod + written), two = run(shop, rod + written, "-n 2", "two");
  EXPECT_NEAR(two["energy"], one["energy"], 1e-12 * std::abs(one["energy"].get<double>()));
}

TEST(ExpressionEnergy, IsListedCheckedAndExplained) {
  const Workshop shop;
  shop.write("problem.toml", rod + written);
  const Outcome o = shop.karcher("check problem.toml --derivatives");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("expression           of m, R on all"), std::string::npos) << o.out;
  EXPECT_NE(shop.karcher("list energies").out.find("expression "), std::string::npos);
  EXPECT_NE(shop.karcher("doc energies.expression").out.find("density (expression, must be given)"), std::string::npos);
}

/// A function on an interval that starts at 1.
const std::string scalar = R"toml([mesh]
generate = "interval"
cells = [2]
[fields.u]
manifold = "R1"
initial = ["1"]
[[dirichlet]]
field = "u"
on = "left"
value = ["1"]
[[energies]]
type = "expression"
fields = ["u"]
)toml";

TEST(ExpressionEnergy, DoesNotStepWhereItIsNotDefined) {
  // int u'^2/2 - log u + 6 u: the first Newton step from u = 1 leaves the domain of log.
  const Workshop shop;
  const json result = run(shop, scalar + "density = \"u[0].x^2/2 - log(u[0]) + 6*u[0]\"\n");
  EXPECT_EQ(result["load_steps"][0]["negative_eigenvalues"], 0) << result["load_steps"][0];
}

TEST(ExpressionEnergy, IsRefusedWhereItIsNotDefinedAtTheStart) {
  // The last is finite, but its slope is not.
  for (const std::string density : {"u[0].x^2 + log(u[0] - 1.5)", "u[0].x^2 + u[0]/0", "u[0].x^2 + sqrt(u[0] - 1)"}) {
    const std::string said = refusal(scalar + "density = \"" + density + "\"\n");
    EXPECT_NE(said.find("problem.toml:11:1: the energy of the initial configuration is not defined: expression in the cell around (0.25, 0, 0): "),
              std::string::npos)
        << said;
  }
}

/// What the reader says of a problem, which it must refuse.
std::string said_of(const Workshop& shop, const std::string& problem) {
  try {
    app::read_problem(shop.write("problem.toml", problem));
    ADD_FAILURE() << problem;
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

struct Refused {
  std::string from, to, place;
  std::vector<std::string> said;
};

TEST(ExpressionEnergy, RefusesWhatIsWrongAtItsPlace) {
  const Workshop shop;
  const std::string fields = "fields = [\"m\", \"R\"]", moves = "moves = \"m\"", v1 = "v1 = m[0].z*", square = "stiffness*v1^2";
  for (const Refused& r : std::vector<Refused>{
           {fields, "fields = []", ":38:10: ", {"energies.1.fields takes one to three fields, not 0."}},
           {fields, "fields = [\"m\", \"R\", \"other\", \"m\"]", ":38:10: ", {"takes one to three fields, not 4."}},
           {fields, "fields = [\"m\", \"Q\"]", ":38:16: ", {"there is no field \"Q\".", "Fields: m, R, other."}},
           {fields, "fields = [\"m\", \"R\", \"m\"]", ":38:21: ", {"names the field \"m\" twice"}},
           {fields, "fields = [\"m\", 1]", ":38:16: ", {"energies.1.fields.1 must be a string, not a whole number."}},
           {fields,
            "fields = [\"m\", \"R\", \"other\"]",
            ":43:11: ",
            {"energies.1.density does not use the field \"other\": the field \"other\" has values in R1: other[0], "}},
           {moves, "moves = \"R\"", ":39:9: ", {"the values of \"R\" are points of SO3, not places"}},
           {moves, "moves = \"other\"", ":39:9: ", {"energies.1.moves must be one of the fields, not \"other\"."}},
           {moves, "move = \"m\"", ":39:1: ", {"in energies.1: unknown key \"move\". Did you mean \"moves\"?"}},
           {moves, "moves = \"m\"\non = 7", ":40:6: ", {"energies.1.on must be a string"}},
           {v1, "m[3].z*", ":40:8: ", {"energies.1.let.0 is \"m[3].z*", "it must be \"name = expression\""}},
           {v1, "v1 = m[3].z*", ":40:14: ", {"\"m[3].z\" is not known; the field \"m\" has values in R3: m[0] to m[2], with derivatives m[0].x"}},
           {v1, "v1 = m[0].w*", ":40:14: ", {"\"m[0].w\" is not known"}},
           {v1, "v1 = v2*", ":40:14: ", {"\"v2\" is defined by energies.1.let.1, but a definition uses earlier ones only."}},
           {v1, "v1 = v1*", ":40:14: ", {"\"v1\" is defined by energies.1.let.0, but a definition uses earlier ones only."}},
           {v1, "z = m[0].z*", ":40:9: ", {"energies.1.let.0: the name \"z\" means something else already."}},
           {v1, "bending = m[0].z*", ":40:9: ", {"the name \"bending\" means something else"}},
           {v1, "other = m[0].z*", ":40:9: ", {"the name \"other\" means something else"}},
           {v1, "R = m[0].z*", ":40:9: ", {"the name \"R\" means something else"}},
           {v1, "sin = m[0].z*", ":40:9: ", {"the name \"sin\" means something else"}},
           {v1, "v2 = m[0].z*", ":41:9: ", {"energies.1.let.1: the name \"v2\" means something else"}},
           {v1, "R.k4 = m[0].z*", ":40:9: ", {"\"R.k4\" is no name"}},
           {square, "stiffness*v1^*", ":44:17: ", {"\"*\" at character"}},
           {square, "other[0]*v1", ":44:4: ", {"the field \"other\" is none of the fields of this energy."}},
           {square, "stifness*v1", ":44:4: ", {"\"stifness\" is not known. Did you mean \"stiffness\"?"}},
           {square,
            "R.d4[0]",
            ":44:4: ",
            {"\"R.d4[0]\" is not known; the field \"R\" has values in SO3: R[0] to R[3], ", "directors R.d1[0..2], R.d2, R.d3."}},
           {"R.k1[1]", "m.k1[1]", ":45:26: ", {"\"m.k1[1]\" is not known; the field \"m\""}},
           {"R.k1[1]", "R", ":45:26: ", {"\"R\" is not known; the field \"R\" has values in SO3: R[0] to R[3]"}},
       }) {
    const std::string said = said_of(shop, rod_with(r.from, r.to));
    EXPECT_NE(said.find("problem.toml" + r.place), std::string::npos) << r.to << "\n" << said;
    for (const std::string& part : r.said) EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
  }
  EXPECT_NE(said_of(shop, replaced(rod_with(fields, "fields = [\"m\", \"R-\"]"), "[fields.R]", "[fields.R-]")).find("cannot be used in formulas"),
            std::string::npos);
  EXPECT_NE(said_of(shop, replaced(rod + written, "stiffness = ", "m = 1\nstiffness = ")).find("\"m\" means something else in expressions"),
            std::string::npos);
}

TEST(ExpressionEnergy, RefusesAFormulaWhoseDerivativesWouldTakeAllMemory) {
  std::string problem = "[mesh]\ngenerate = \"interval\"\n", density = "a[0] + b[0] + c[0]";
  for (const char* field : {"a", "b", "c"}) problem += "[fields." + std::string(field) + "]\nmanifold = \"SPD3\"\n";
  for (int i = 0; i < 100000; ++i) density += "+a[0]^2";
  const std::string said =
      said_of(Workshop(), problem + "[[energies]]\ntype = \"expression\"\nfields = [\"a\", \"b\", \"c\"]\ndensity = \"" + density + "\"\n");
  EXPECT_NE(said.find(":12:12: up to energies.0.density, the expressions of the file have more than 10000000 operations"), std::string::npos) << said;
}

TEST(ExpressionEnergy, RefusesWhatItsRegionDoesNotHave) {
  const std::string said = refusal(rod_with("R.k1[1]", "R.k2[1]"));
  for (const char* part :
       {"problem.toml:45:26: ", "\"R.k2[1]\" is not known on a region of dimension 1; the field \"R\"", "body rates R.k1[0..2], directors"})
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
  EXPECT_NE(refusal(replaced(rod + written, "\"70 + 10*z\"", "\"1/(z - z)\"")).find("parameters.stiffness = \"1/(z - z)\" is inf"),
            std::string::npos);
}

}  // namespace
}  // namespace karcher::testing
