// Problem files with one mistake each: the message names file, line and column and what is wrong, the exit code is 2, and nothing is written.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "program_runner.hpp"

namespace karcher::testing {
namespace {

const std::string good = R"(title = "A strip"

[parameters]
load = 1.0

[mesh]
generate = "rectangle"
size = [2, 1]
cells = [2, 1]
shape = "quadrilateral"

[regions.middle]
dim = 2
where = "x > 0.9"

[fields.m]
manifold = "R3"
order = 1

[fields.Q]
manifold = "SO3"
order = 1
interpolation = "projection"
initial = "identity"

[[energies]]
type = "cosserat-shell"
on = "all"
deformation = "m"
rotation = "Q"
thickness = 0.1
mu = 1
lambda = 1
mu_c = 1
L_c = 0.1

[[loads]]
type = "volume"
field = "m"
value = [0, 0, "load*t"]

[[dirichlet]]
field = "m"
on = "left"
value = ["x", "y", "z"]

[solver]
max_iterations = 50
)";

/// The good file with `from` replaced by `to`.
std::string with(const std::string& from, const std::string& to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string repeated(const std::string& text, int times) {
  std::string s;
  for (int i = 0; i < times; ++i) s += text;
  return s;
}

/// p0 = 1, and each parameter of the 2000 others is the one before and x.
std::string chain_of_parameters() {
  std::string s = "p0 = 1\n";
  for (int i = 1; i <= 5000; ++i) s += fmt::format("p{} = \"p{} + x\"\n", i, i - 1);
  return s;
}

struct Mistake {
  const char* name;
  std::string file;
  std::string place;                  ///< ":line:column: " after the name of the file, or empty
  std::vector<std::string> contains;  ///< parts of the message
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

std::vector<Mistake> mistakes() {
  return {
      {"UnknownKey", with("thickness", "thicknes"), ":31:1: ", {"\"thicknes\"", "Did you mean \"thickness\"?", "Allowed: type, on, deformation"}},
      {"UnknownSection", with("[solver]", "[solvr]"), ":47:2: ", {"\"solvr\"", "Did you mean \"solver\"?"}},
      {"UnknownKeyOfTheMesh", with("cells = ", "cell = "), ":9:1: ", {"\"cell\"", "Did you mean \"cells\"?"}},
      {"UnknownKeyOfTheSolver", with("max_iterations", "max_iteration"), ":48:1: ", {"Did you mean \"max_iterations\"?", "gradient_tolerance"}},
      {"WrongType",
       with("max_iterations = 50", "max_iterations = \"many\""),
       ":48:18: ",
       {"solver.max_iterations must be a whole number, not a string"}},
      {"WrongTypeOfAField", with("[fields.m]\nmanifold = \"R3\"", "[fields.m]\nmanifold = 3"), ":17:12: ", {"fields.m.manifold must be a string"}},
      {"MissingKey", with("mu_c = 1\n", ""), ":26:1: ", {"energies.0 lacks the key \"mu_c\""}},
      {"UnknownEnergy", with("cosserat-shell", "cosserat-shel"), ":27:8: ", {"Did you mean \"cosserat-shell\"?"}},
      {"LoadAmongEnergies", with("type = \"cosserat-shell\"", "type = \"volume\""), ":27:8: ", {"belongs under [[loads]]"}},
      {"UnknownManifold", with("\"SO3\"", "\"SO2\""), ":21:12: ", {"\"SO2\"", "SO3"}},
      {"UnknownGenerator", with("\"rectangle\"", "\"rectangel\""), ":7:12: ", {"Did you mean \"rectangle\"?"}},
      {"UnknownField", with("rotation = \"Q\"", "rotation = \"R\""), ":30:12: ", {"there is no field \"R\"", "Fields: m, Q"}},
      {"UnknownRegion", with("on = \"left\"", "on = \"lefd\""), ":44:6: ", {"\"lefd\"", "Did you mean \"left\"?", "top"}},
      {"UnknownRegionOfAnEnergy", with("on = \"all\"", "on = \"midle\""), ":28:6: ", {"Did you mean \"middle\"?"}},
      {"RegionOfBoth",
       with("where = \"x > 0.9\"", "where = \"x > 0.9\"\nnear = [2, 0, 0]"),
       ":15:8: ",
       {"regions.middle has both \"where\" and \"near\""}},
      {"RegionWithoutEither", with("where = \"x > 0.9\"", ""), ":12:1: ", {"regions.middle lacks the key \"where\" (or \"near\")"}},
      {"CellNearAPoint", with("where = \"x > 0.9\"", "near = [2, 0, 0]"), ":13:7: ", {"regions.middle.dim is 2, but \"near\" selects a node"}},
      {"NodesEquallyNear",
       with("dim = 2\nwhere = \"x > 0.9\"", "near = [2, 0.5, 0]"),
       ":12:10: ",
       {"the nodes at (2, 0, 0) and (2, 1, 0) are equally"}},
      {"NodeFarAway",
       with("dim = 2\nwhere = \"x > 0.9\"", "near = [20, 0, 0]"),
       ":12:10: ",
       {"is at (2, 0, 0), 18 away, which is more than the size"}},
      {"EmptyRegion", with("x > 0.9", "x > 9"), ":12:10: ", {"middle", "no "}},
      {"FieldUsedTwice", with("rotation = \"Q\"", "rotation = \"m\""), ":30:12: ", {"m", "R3"}},
      {"FieldDefinedTwice", with("[fields.Q]", "[fields.m]"), ":20:", {"this is not TOML"}},
      {"MeshFileMissing",
       with("generate = \"rectangle\"\nsize = [2, 1]\ncells = [2, 1]\nshape = \"quadrilateral\"", "file = \"nowhere.msh\""),
       ":7:8: ",
       {"nowhere.msh"}},
      {"ExpressionWithASyntaxError", with("\"load*t\"", "\"load*(t\""), ":40:24: ", {"load*(t", "loads.0.value.2"}},
      {"ExpressionWithAnUnknownName", with("\"load*t\"", "\"laod*t\""), ":40:17: ", {"\"laod\" is not known", "Did you mean \"load\"?"}},
      {"NonFiniteNumber", with("thickness = 0.1", "thickness = nan"), ":31:13: ", {"energies.0.thickness must be finite"}},
      {"NonFiniteExpression", with("\"x\", \"y\", \"z\"", "\"x/x\", \"y\", \"z\""), ":45:11: ", {"dirichlet.0.value.0", "nan", "at (0, 0, 0)"}},
      {"ValueOutOfRange", with("thickness = 0.1", "thickness = -0.1"), ":31:13: ", {"energies.0.thickness is -0.1; it must be greater than 0"}},
      {"WrongNumberOfEntries", with("[0, 0, \"load*t\"]", "[0, \"load*t\"]"), ":40:9: ", {"loads.0.value takes 3"}},
      {"NotARotation", with("\"identity\"", "[1, 2]"), ":24:11: ", {"fields.Q.initial has 2 entries", "rotation vector"}},
      {"NameWithAControlCharacter",
       with("[regions.middle]", "[regions.\"mid\\u001bdle\"]"),
       ":12:10: ",
       {"the name of the region \"mid\\x1bdle\" has control characters."}},
      {"NameWithAZero",
       with("[regions.middle]", "[regions.\"a\\u0000b\"]"),
       ":12:10: ",
       {"the name of the region \"a\\x00b\" has control characters."}},
      {"NameTooLong", with("[regions.middle]", "[regions." + std::string(101, 'a') + "]"), ":12:10: ", {"has more than 100 characters."}},
      {"FieldWithoutAName", with("[solver]", "[fields.\"\"]\nmanifold = \"R1\"\n[solver]"), ":47:9: ", {"the name of the field \"\" is empty."}},
      {"TitleOfSeveralLines", with("\"A strip\"", "\"A\\nstrip\""), ":1:", {"title must be one line without control characters."}},
      {"PathWithAZero",
       with("generate = \"rectangle\"\nsize = [2, 1]\ncells = [2, 1]\nshape = \"quadrilateral\"", "file = \"block.msh\\u0000x\""),
       ":7:8: ",
       {"mesh.file must be one line without control characters."}},
      {"DirectoryThatCannotBe",
       good + "[output]\ndirectory = \"" + std::string(300, 'd') + "\"\n",
       ":50:13: ",
       {"the directory of results, ", " cannot be: File name too long."}},
      {"TextTooLong", with("on = \"left\"", "on = \"" + std::string(4001, 'a') + "\""), ":44:6: ", {"dirichlet.0.on has more than 4000 characters."}},
      {"ParameterWithALongName",
       with("load = 1.0", "load = 1.0\n" + std::string(500000, 'p') + " = 1\na = \"" + std::string(500000, 'q') + "\""),
       ":5:1: ",
       {"has more than 100 characters."}},
      {"UnknownNameOfALongName", with("load = 1.0", "load = 1.0\na = \"" + std::string(500000, 'q') + "\""), ":5:6: ", {"is not known."}},
      {"ParametersThatMakeEachOtherLong",
       with("load = 1.0", "load = 1.0\n" + chain_of_parameters()),
       ":4477:10: ",
       {"up to parameters.p4472, the expressions of the file have more than 10000000 operations"}},
      {"KeyOfManyParts", good + "[" + repeated("a.", 200000) + "a]\n", ":49:21: ", {"a key of more than 10 parts is none of a problem file."}},
      {"KeyOfManyPartsBehindStrings",
       with("\"A strip\"", "\"\"\"a \\\" b\"\"\"\"\"") + "'\"'." + repeated("a.", 200000) + "a = 1 # \"\n",
       ":49:22: ",
       {"a key of more than 10 parts is none of a problem file."}},
      {"ProbeWhoseDistanceOverflows",
       good + "\n[[probes]]\nname = \"far\"\nfield = \"m\"\nat = [0, 1e308, 0]\n",
       ":53:",
       {"lies outside the region \"all\"", "at a distance of 1e+308."}},
      {"MeshThatCannotBeNumbered",
       with("cells = [2, 1]", "refine = 20\ncells = [2, 1]"),
       ":6:1: ",
       {"The mesh, refined 20 times,", "are not numbered."}},
      {"MeshFileThatIsADirectory",
       with("generate = \"rectangle\"\nsize = [2, 1]\ncells = [2, 1]\nshape = \"quadrilateral\"", "file = \".\""),
       ":7:8: ",
       {"is a directory."}},
      {"StringWithoutQuotes", with("\"SO3\"", "SO3"), ":", {"this is not TOML", "A string stands in quotes: manifold = \"SO3\"."}},
      {"UnitBehindANumber",
       with("dim = 2", "dim = 2 mm"),
       ":13:",
       {"this is not TOML", "Numbers have no units here: state all of them in one system"}},
      {"UnitInAFormula",
       with("thickness = 0.1", "thickness = \"210 GPa\""),
       ":",
       {"\"GPa\" at character 5 is not expected", "numbers have no units here"}},
      {"FormulaWithoutQuotes", with("dim = 2", "dim = 2*3"), ":13:", {"this is not TOML", "A formula stands in quotes: dim = \"2*3\"."}},
      {"FieldsAsAnArray",
       with("[fields.Q]", "[[fields]]"),
       ":",
       {"this is not TOML", "Every one of the fields is a table with its name: [fields.NAME]."}},
      {"NameWithBrackets", with("\"SO3\"", "\"SO(3)\""), ":", {"There is no manifold \"SO(3)\". Did you mean \"SO3\"?"}},
      {"Syntax", with("dim = 2", "dim = = 2"), ":13:", {"this is not TOML"}},
      {"NoMesh", with("[mesh]", "[regions.mesh]"), "", {"lacks the key \"mesh\""}},
      {"ComponentOfARotation",
       with("field = \"m\"\non = \"left\"\nvalue = [\"x\", \"y\", \"z\"]", "field = \"Q\"\non = \"left\"\nvalue = [0, \"free\", 0]"),
       ":45:13: ",
       {"axis-free"}},
      {"ConflictingData",
       good + "\n[[dirichlet]]\nfield = \"m\"\non = \"bottom\"\nvalue = [\"x\", 0.5, 0]\n",
       ":50:1: ",
       {"dirichlet.1 and dirichlet.0", "different values at (0, 0, 0)", "0.5"}},
      {"ParameterWithAForbiddenName", with("load = 1.0", "t = 1.0"), ":4:1: ", {"\"t\""}},
      {"TooManyRefinements", with("[mesh]", "[mesh]\nrefine = -1"), ":7:10: ", {"mesh.refine must be from 0"}},
      {"UnknownMethod", with("max_iterations = 50", "method = \"newton\""), ":48:10: ", {"newton", "trust-region"}},
      {"ProjectionWherePointsHaveNone",
       with("[solver]", "[fields.P]\nmanifold = \"SPD3\"\ninterpolation = \"projection\"\n[solver]"),
       ":49:17: ",
       {"geodesic", "closest point"}},
      {"ProjectionOntoAHyperbolicSpace",
       with("[solver]", "[fields.P]\nmanifold = \"H3\"\ninterpolation = \"projection\"\n[solver]"),
       ":49:17: ",
       {"geodesic", "closest point"}},
      {"UnknownInterpolation", with("\"projection\"", "\"projektion\""), ":23:17: ", {"Did you mean \"projection\"?", "geodesic"}},
      {"RegionThatTheMeshHas", with("[regions.middle]", "[regions.left]"), ":12:10: ", {"\"left\"", "already"}},
      {"RegionOfATooHighDimension", with("dim = 2", "dim = 3"), ":12:10: ", {"dim is 3", "dimension 2"}},
      {"TwoPairsOfModuli", with("mu = 1\n", "mu = 1\nyoung = 1\npoisson = 0\n"), ":32:6: ", {"young and poisson", "one pair or the other"}},
      {"IncompressibleModuli", with("mu = 1\nlambda = 1\n", "young = 1\npoisson = 0.5\n"), ":33:11: ", {"energies.0.poisson is 0.5", "1/2"}},
      {"NonFiniteParameter", with("load = 1.0", "load = \"log(-1)\""), ":4:9: ", {"parameters.load", "must be finite"}},
      {"NonFiniteLoadAtTheLastLoadStep", with("load*t", "1/(1-t)"), ":40:17: ", {"loads.0.value.2", "must be finite"}},
      {"NonFiniteReference",
       with("[fields.m]", "[reference]\nposition = [\"log(x)\", \"y\", \"z\"]\n[fields.m]"),
       ":17:14: ",
       {"reference.position.0", "at (0, 0, 0)", "must be finite"}},
      {"InitialValuesThatArePoints", with("\"identity\"", "\"reference\""), ":24:11: ", {"reference position is no point of SO3"}},
      {"NoInitialDirection",
       with("[solver]", "[fields.n]\nmanifold = \"S2\"\ninitial = [\"x\", \"y\", 0]\n[[energies]]\ntype = \"harmonic\"\nfield = \"n\"\n[solver]"),
       ":49:11: ",
       {"fields.n.initial", "at (0, 0, 0)"}},
      {"DegreeOfQuadratureTooHigh", with("[solver]", "[quadrature]\ndegree = 99\n[solver]"), ":48:10: ", {"from 0 to 30", "99"}},
      {"NoLoadSteps", with("[solver]", "[continuation]\nsteps = 0\n[solver]"), ":48:9: ", {"continuation.steps", "from 1"}},
      {"FlowWithoutTime", with("max_iterations = 50", "method = \"gradient-flow\"\n[continuation]\nfrom = 1"), ":48:10: ", {"time interval"}},
      {"ProbesOfOneName",
       good + "[[probes]]\nname = \"tip\"\nfield = \"m\"\nat = [2, 1, 0]\n[[probes]]\nname = \"tip\"\nfield = \"Q\"\nat = [2, 1, 0]\n",
       ":54:8: ",
       {"\"tip\"", "strip.toml:52:6"}},
      {"UnusedField", with("[solver]", "[fields.P]\nmanifold = \"SPD3\"\n[solver]"), ":47:9: ", {"no energy uses the field \"P\""}},
      {"UnknownQuantity",
       good + "[[probes]]\nname = \"tip\"\nfield = \"m\"\nat = [2, 0.5, 0]\nquantity = \"displacment\"\n",
       ":53:12: ",
       {"Did you mean \"displacement\"?"}},
      {"ProbeOutside", good + "[[probes]]\nname = \"tip\"\nfield = \"m\"\nat = [3, 0.5, 0]\n", ":52:6: ", {"outside"}},
      {"RegionOfTheWrongDimension", with("on = \"all\"", "on = \"left\""), ":28:6: ", {"dimension 2", "\"left\" has dimension 1"}},
      {"ADate", with("title = \"A strip\"", "title = 2020-01-01"), ":1:9: ", {"dates"}},
  };
}

class BadInput : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadInput, IsToldOnceWithItsPlaceAndNothingIsWritten) {
  const Mistake& mistake = GetParam();
  const Workshop shop;
  shop.write("strip.toml", mistake.file);
  const auto before = shop.files();
  const Outcome o = shop.karcher("run strip.toml");
  EXPECT_EQ(o.code, 2) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find("strip.toml" + mistake.place), std::string::npos) << "expected place " << mistake.place << " in: " << o.err;
  for (const std::string& part : mistake.contains) EXPECT_NE(o.err.find(part), std::string::npos) << "expected " << part << " in: " << o.err;
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_EQ(shop.files(), before);
}

INSTANTIATE_TEST_SUITE_P(Files, BadInput, ::testing::ValuesIn(mistakes()), [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(BadInput, OnTwoRanksIsToldOnce) {
  const Workshop shop;
  shop.write("strip.toml", with("thickness", "thicknes"));
  const Outcome o = shop.karcher("run strip.toml -n 2");
  EXPECT_EQ(o.code, 2) << o.err;
  EXPECT_EQ(o.err.find("strip.toml:31:1: "), o.err.rfind("strip.toml:31:1: ")) << o.err;
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_EQ(shop.files().size(), 1u);
}

TEST(BadInput, AShellThatIsTooThickForItsCurvatureIsToldWithTheCurvatureOnAnyNumberOfRanks) {
  std::string text = with("generate = \"rectangle\"\nsize = [2, 1]\ncells = [2, 1]\nshape = \"quadrilateral\"",
                          "generate = \"cylinder\"\nradius = 0.04\ncells = [6, 2]\norder = 2");
  text.replace(text.find("order = 1"), 9, "order = 2");  // a reference of order 1 is flat
  text.replace(text.find("x > 0.9"), 7, "z > 0.4");
  text.replace(text.find("\"left\""), 6, "\"bottom\"");
  for (const char* arguments : {"run strip.toml", "run strip.toml -n 2"}) {
    const Workshop shop;
    shop.write("strip.toml", text);
    const Outcome o = shop.karcher(arguments);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("strip.toml:26:1: "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("curvature"), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_EQ(shop.files().size(), 1u);
  }
}

// Neighbouring nodes half a turn apart have no unique mean.
const std::string far_apart = R"toml([mesh]
generate = "rectangle"
cells = [4, 4]
shape = "quadrilateral"

[fields.u]
manifold = "S2"
interpolation = "geodesic"
initial = ["cos(4*pi*x)", "sin(4*pi*x)", 0]

[[energies]]
type = "harmonic"
field = "u"
)toml";

TEST(BadInput, InitialValuesTooFarApartAreToldWithTheCellByEveryVerbThatEvaluatesOnAnyNumberOfRanks) {
  for (const char* arguments : {"run far.toml", "run far.toml -n 2", "evaluate far.toml --json", "check far.toml", "converge far.toml --levels 1",
                                "run far.toml --set 'fields.u.manifold=\"SO3\"' --set 'fields.u.initial=[0, 0, \"4*pi*x\"]'",
                                "run far.toml --set 'fields.u.manifold=\"SO3\"' --set 'fields.u.initial=[0, 0, \"4*pi*x\"]' --set "
                                "fields.u.interpolation=projection"}) {
    const Workshop shop;
    shop.write("far.toml", far_apart);
    const Outcome o = shop.karcher(arguments);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_NE(o.err.find("far.toml:11:1: "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("harmonic in the cell around (0.125, "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("too far apart"), std::string::npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_EQ(shop.files().size(), 1u);
  }
}

TEST(BadInput, MeshFilesThatCannotBeReadAreNamedInTheProblemFileAndByThemselves) {
  const std::string file = with("generate = \"rectangle\"\nsize = [2, 1]\ncells = [2, 1]\nshape = \"quadrilateral\"", "file = \"block.msh\"");
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n";
  const std::string rest = "$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n";
  const std::string infinite = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 nan 0\n3 1 1 0\n4 0 1 0\n" + rest;
  const std::string truncated = head, unreadable = head + "$EndNodes\n$Elements\n1\n1 16 2 1 1 1 2 3 4 1 2 3 4\n$EndElements\n";
  for (const std::string& mesh : {truncated, unreadable, infinite, std::string("no mesh at all")}) {
    const Workshop shop;
    shop.write("strip.toml", file);
    shop.write("block.msh", mesh);
    const auto before = shop.files();
    const Outcome o = shop.karcher("run strip.toml");
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("strip.toml:7:8: "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("block.msh"), std::string::npos) << o.err;
    EXPECT_EQ(shop.files(), before);
  }
}

TEST(BadInput, AMeshThatDoesNotFitIntoMemoryIsRefusedBeforeItIsMade) {
  const Workshop shop;
  shop.write("strip.toml", good);
  const auto refused = [&](const std::string& size, const std::string& limit, const std::string& reason) {
    const Outcome o = shop.karcher("check strip.toml --set " + size, limit);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("strip.toml:6:1: "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find(reason), std::string::npos) << o.err;
  };
  for (const char* size : {"mesh.cells=[200000,200000]", "mesh.refine=20"}) refused(size, "", "more than 2.1e+09 are not numbered.");
#ifndef __SANITIZE_ADDRESS__  // which wants 15 TB of addresses
  for (const char* size : {"mesh.cells=[20000,20000]", "mesh.refine=14"})
    refused(size, "ulimit -v 8000000;", "GB of memory; this process may have 8.19 GB.");
#endif
}

TEST(BadInput, ADeviceIsNoProblemFile) {
  const Workshop shop;
  const Outcome o = shop.karcher("check /dev/zero");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("The file /dev/zero has more than 10000000 bytes."), std::string::npos) << o.err;
}

TEST(BadInput, OverridesAreNamedInMessages) {
  const Workshop shop;
  shop.write("strip.toml", good);
  EXPECT_NE(shop.karcher("run strip.toml --set energies.0.thicknes=1").err.find("--set energies.0.thicknes=1: "), std::string::npos);
  EXPECT_NE(shop.karcher("run strip.toml --set energies.3.thickness=1").err.find("has 1 entries"), std::string::npos);
  EXPECT_NE(shop.karcher("run strip.toml --set energies.0.thickness=-1").err.find("--set energies.0.thickness=-1: "), std::string::npos);
  EXPECT_EQ(shop.karcher("run strip.toml --set nonsense").code, 2);
  EXPECT_NE(shop.karcher("run strip.toml -o strip.toml").err.find("--output: the directory of results"), std::string::npos);
}

TEST(BadInput, WrongCommandLinesAreInputErrors) {
  const Workshop shop;
  EXPECT_EQ(shop.karcher("").code, 2);
  EXPECT_NE(shop.karcher("").err.find("solve a problem and write its results"), std::string::npos);
  EXPECT_EQ(shop.karcher("rum problem.toml").code, 2);
  EXPECT_EQ(shop.karcher("run").code, 2);
  EXPECT_EQ(shop.karcher("run nowhere.toml").code, 2);
  EXPECT_NE(shop.karcher("run nowhere.toml").err.find("nowhere.toml"), std::string::npos);
  EXPECT_EQ(shop.karcher("list manyfolds").code, 2);
  EXPECT_NE(shop.karcher("list manyfolds").err.find("Did you mean \"manifolds\"?"), std::string::npos);
  EXPECT_NE(shop.karcher("doc solver.methd").err.find("Did you mean \"solver.method\"?"), std::string::npos);
}

}  // namespace
}  // namespace karcher::testing
