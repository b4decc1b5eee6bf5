// Names, definitions, messages, and texts that are long or deep.

#include "karcher/expression/symbols.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <muParser.h>

#include <array>
#include <random>
#include <thread>

namespace karcher {
namespace {

const std::vector<std::string> variable_names{"x", "y", "z", "t"};
const std::array<double, 4> point{0.3, -0.7, 1.9, 0.4};

struct Refusal {
  std::string sentence;
  std::size_t position = 0;
};

Refusal refusal(const std::string& text, const Symbols& symbols = Symbols(variable_names)) {
  try {
    symbols.compile(text);
  } catch (const FormulaError& e) {
    return {e.what(), e.position};
  }
  return {"accepted"};
}

void expect_refusal(const std::string& text, std::size_t position, const std::string& sentence) {
  const Refusal r = refusal(text);
  EXPECT_EQ(r.sentence, sentence) << text;
  EXPECT_EQ(r.position, position) << text;
}

TEST(Symbols, ReferToTextsThatAreNoExpressionByCharacter) {
  const std::string operand = "a number, a name, a function or \"(\"", operation = "an operator (\"*\" multiplies)";
  expect_refusal("", 0, "it is empty.");
  expect_refusal(" \n ", 0, "it is empty.");
  expect_refusal("2**3", 2, "\"*\" at character 3 is not expected; expected is " + operand + ".");
  expect_refusal("()", 1, "\")\" at character 2 is not expected; expected is " + operand + ".");
  expect_refusal("1 +", 3, "it ends after character 3; expected is " + operand + ".");
  expect_refusal("sin(x, ", 7, "it ends after character 7; expected is " + operand + ".");
  expect_refusal("2x", 1, "\"x\" at character 2 is not expected; expected is " + operation + ".");
  expect_refusal("x (y)", 2, "\"(\" at character 3 is not expected; expected is " + operation + ".");
  expect_refusal("1..2", 2, "\".2\" at character 3 is not expected; expected is " + operation + ".");
  expect_refusal("2*(x + 1", 8, "it ends after character 8; expected is \")\" for the \"(\" at character 3.");
  expect_refusal("sin(x", 5, "it ends after character 5; expected is \")\" for the \"(\" at character 4.");
  expect_refusal("x)", 1, "\")\" at character 2 has no \"(\" before it.");
  expect_refusal("x ? y", 5, "it ends after character 5; expected is \":\" for the \"?\" at character 3.");
  expect_refusal("(x ? y) : z", 6, "\")\" at character 7 is not expected; expected is \":\" for the \"?\" at character 4.");
  expect_refusal("x ? (y : z)", 7, "\":\" at character 8 is not expected; expected is \")\" for the \"(\" at character 5.");
  expect_refusal("1 : 2", 2, "\":\" at character 3 has no \"?\" before it.");
  expect_refusal("sum(x ? 1, 2 : 3)", 9, "\",\" at character 10 is not expected; expected is \":\" for the \"?\" at character 7.");
  expect_refusal("sin + 1", 0, "\"sin\" at character 1 is a function; \"(\" must follow it.");
  expect_refusal("sin()", 4, "\"sin\" takes 1 argument, not 0.");
  expect_refusal("1 + atan2(1)", 11, "\"atan2\" takes 2 arguments, not 1.");
  expect_refusal("sin(1, 2)", 8, "\"sin\" takes 1 argument, not 2.");
  expect_refusal("max()", 4, "\"max\" takes at least 1 argument, not 0.");
  expect_refusal("1e400", 0, "\"1e400\" at character 1 is too large for a number.");
  expect_refusal("x # y", 2, "\"#\" at character 3 means nothing in an expression.");
  expect_refusal("2*π", 2, "\"π\" at character 3 means nothing in an expression.");
  expect_refusal("x & y", 2, "\"&\" at character 3 is no operator; write \"&&\".");
  expect_refusal("!x", 0, "\"!\" at character 1 is no operator; write \"!=\" to compare, \"== 0\" to negate.");
  expect_refusal("x\a", 1, "there is a control character (0x07) at character 2.");
  expect_refusal("x = 3", 2, "\"=\" assigns; write \"==\" to compare.");
  expect_refusal("1, 2", 1, "one value is expected, not a list.");
  expect_refusal("min(1, 2), 3", 9, "one value is expected, not a list.");
  expect_refusal("2*(1, 2)", 4, "one value is expected, not a list.");
  expect_refusal("2*sni(x)", 2, "\"sni\" is not known. Did you mean \"sin\"? Names: x, y, z, t, pi.");
  expect_refusal("whatever", 0, "\"whatever\" is not known. Names: x, y, z, t, pi.");
  expect_refusal("x[0]", 0, "\"x[0]\" is not known. Names: x, y, z, t, pi.");
}

TEST(Symbols, AcceptWhatMuParserAccepts) {
  // Beside it: signs after signs, and spaces between a function and its parenthesis.
  const char* const pieces[] = {"x", "y", "1",  "2.5", "(", ")", "(", ")",    "+",    "-",    "*", "/",
                                "^", "<", "==", "&&",  "?", ":", ",", "sin(", "min(", "pow(", " "};
  const Symbols symbols(variable_names);
  mu::Parser parser;
  double x = 0.25, y = 3;
  parser.DefineVar("x", &x);
  parser.DefineVar("y", &y);
  parser.DefineFun("pow", [](double a, double b) { return std::pow(a, b); });
  std::mt19937 random(1);
  int accepted = 0, refused = 0;
  for (int n = 0; n < 10000; ++n) {
    std::string text;
    for (unsigned k = 1 + random() % 9; k > 0; --k) text += pieces[random() % std::size(pieces)];
    bool theirs = true;
    try {
      parser.SetExpr(text);
      parser.Eval();
      theirs = parser.GetNumResults() == 1;
    } catch (const mu::ParserError&) {
      theirs = false;
    }
    const Refusal ours = refusal(text, symbols);
    if (theirs) {
      EXPECT_EQ(ours.sentence, "accepted") << text;
      ++accepted;
    } else if (ours.sentence == "accepted") {
      std::string signs = text;
      std::erase(signs, ' ');
      const bool sign_after_sign = signs.find_first_of("+-") != signs.npos && std::adjacent_find(signs.begin(), signs.end(), [](char a, char b) {
                                                                                return (a == '+' || a == '-') && (b == '+' || b == '-');
                                                                              }) != signs.end();
      EXPECT_TRUE(sign_after_sign) << text;
    } else {
      EXPECT_LE(ours.position, text.size()) << text;
      ++refused;
    }
  }
  EXPECT_GT(accepted, 200);
  EXPECT_GT(refused, 4000);
}

TEST(Symbols, KnowWhatIsANameAndWhatIsTaken) {
  for (const char* name : {"a", "_a1", "mu_c", "u[0]", "u.x", "u[0].x", "u.k1[2]"})
    EXPECT_NO_THROW(Symbols(variable_names).add_variable(name)) << name;
  for (const char* name : {"", "2a", "mu-c", "a b", "u[", "u[x]", "u.", "u.1", "x", "pi", "_pi", "_e", "sin", "ä", "a "})
    EXPECT_THROW(Symbols(variable_names).add_variable(name), InputError) << name;
  EXPECT_THROW(Symbols(variable_names).define("u[0]", 1.0), InputError);
  EXPECT_TRUE(Symbols::is_name("mu_c"));
  EXPECT_FALSE(Symbols::is_name("u.x"));
  Symbols symbols(variable_names);
  symbols.define("a", 1.0);
  EXPECT_THROW(symbols.define("a", 2.0), InputError);
}

TEST(Symbols, ProgramsContainWhatTheyNeedOnce) {
  Symbols symbols(variable_names);
  symbols.define("unused", symbols.compile("sin(z)"));
  const std::uint32_t r = symbols.define("r", symbols.compile("sqrt(x*x + t)"));
  const std::uint32_t s = symbols.define("s", symbols.compile("r*r + r"));
  const Program p = symbols.link(symbols.compile("s + r + s"));
  EXPECT_EQ(p.inputs(), (std::vector<std::uint32_t>{0, 3}));
  ASSERT_EQ(p.definitions().size(), 2u);
  EXPECT_EQ(p.definitions()[0].symbol, r);
  EXPECT_EQ(p.definitions()[1].symbol, s);
  EXPECT_EQ(p.code().size(), 3u + 2u + 2u);

  std::vector<double> places(p.size());
  places[0] = 3;
  places[3] = 7;
  EXPECT_EQ(p.evaluate_in(places.data()), 20 + 4 + 20);
  EXPECT_EQ(places[0], 3);
  EXPECT_EQ(places[3], 7);
  EXPECT_EQ(places[p.definitions()[0].place], 4);
  EXPECT_EQ(places[p.definitions()[1].place], 20);

  // A copy that grows keeps the numbers.
  Symbols more = symbols;
  more.add_variable("u[0]");
  EXPECT_EQ(more.link(more.compile("u[0]*s")).evaluate<double>(std::array<double, 5>{3, 0, 0, 7, 10}), 200);
}

TEST(Symbols, DefinitionsMayBeOtherNames) {
  Symbols symbols(variable_names);
  symbols.define("a", symbols.compile("x"));
  symbols.define("b", symbols.compile("(a)"));
  symbols.define("c", symbols.compile("2"));
  const Program p = symbols.link(symbols.compile("b"));
  EXPECT_EQ(p.code().size(), 0u);
  EXPECT_EQ(p.evaluate<double>(point), 0.3);
  EXPECT_EQ(symbols.link(symbols.compile("c*b + a")).evaluate<double>(point), 2 * 0.3 + 0.3);
  EXPECT_TRUE(symbols.link(symbols.compile("c + 1")).inputs().empty());
}

TEST(Symbols, EvaluateEachDefinitionOnceHoweverOftenItIsUsed) {
  // Each the sum of all before it, 2^32 if nothing were shared.
  Symbols symbols(variable_names);
  std::string sum = "x";
  for (int i = 0; i < 34; ++i) {
    symbols.define(fmt::format("p{}", i), symbols.compile(sum));
    sum += fmt::format(" + p{}", i);
  }
  const Program p = symbols.link(symbols.compile("p33"));
  EXPECT_EQ(p.definitions().size(), 34u);
  EXPECT_LT(p.code().size(), 34u * 34u);
  EXPECT_EQ(p.evaluate<double>(std::array<double, 4>{1, 0, 0, 0}), 0x1p33);
  Dual<double, 1> one(1.0);
  one.d[0] = 1;
  const auto slope = p.evaluate<Dual<double, 1>>(std::array<Dual<double, 1>, 4>{one, 0, 0, 0});
  EXPECT_EQ(slope.v, 0x1p33);
  EXPECT_EQ(slope.d[0], 0x1p33);
}

TEST(Symbols, EvaluateHalvesOfHalves) {
  Symbols symbols(variable_names);
  symbols.define("p0", symbols.compile("x*x"));
  for (int i = 1; i <= 200; ++i) symbols.define(fmt::format("p{}", i), symbols.compile(fmt::format("0.5*p{} + 0.5*p{}", i - 1, i - 1)));
  const Program p = symbols.link(symbols.compile("p200"));
  EXPECT_EQ(p.evaluate<double>(point), 0.3 * 0.3);
  Dual<double, 1> x(0.3);
  x.d[0] = 1;
  EXPECT_EQ((p.evaluate<Dual<double, 1>>(std::array<Dual<double, 1>, 4>{x, 0, 0, 0}).d[0]), 0.6);
}

std::string repeated(const std::string& piece, int n) {
  std::string s;
  for (int i = 0; i < n; ++i) s += piece;
  return s;
}

TEST(Symbols, CompileTextsOfAnyDepth) {
  const Symbols symbols(variable_names);
  const int n = 100000;
  const auto program = [&](const std::string& text) { return symbols.link(symbols.compile(text)); };
  EXPECT_EQ(program(repeated("(", n) + "x" + repeated(")", n)).evaluate<double>(point), 0.3);
  EXPECT_EQ(program(repeated("-", n) + "x").evaluate<double>(point), 0.3);
  EXPECT_EQ(program("x^0" + repeated("^1", n)).evaluate<double>(point), 1);
  EXPECT_NEAR(program("x" + repeated(" + y*z", n)).evaluate<double>(point), 0.3 - 0.7 * 1.9 * n, 1e-6);
  EXPECT_EQ(program(repeated("abs(", n) + "y" + repeated(")", n)).evaluate<double>(point), 0.7);
  EXPECT_EQ(program(repeated("x < 0 ? 1 : ", 50000) + "2").evaluate<double>(point), 2);
  EXPECT_EQ(program(repeated("x > 0 ? ", 50000) + "3" + repeated(" : 2", 50000)).evaluate<double>(point), 3);
  EXPECT_EQ(program(repeated("x*y + (", 50000) + "x" + repeated(")", 50000)).size(), 4u + 50000u);
  const Program sum = program("x" + repeated(" + y*z", n));
  EXPECT_LE(sum.size(), 4u + 2u);
  Dual<double, 1> x(0.3);
  x.d[0] = 1;
  EXPECT_EQ((sum.evaluate<Dual<double, 1>>(std::array<Dual<double, 1>, 4>{x, 1, 1, 0}).d[0]), 1);
}

TEST(Symbols, CompileChainsOfDefinitionsOfAnyLength) {
  Symbols symbols(variable_names);
  symbols.define("p0", symbols.compile("x"));
  for (int i = 1; i <= 50000; ++i) symbols.define(fmt::format("p{}", i), symbols.compile(fmt::format("p{} + y", i - 1)));
  EXPECT_EQ(symbols.link(symbols.compile("p50000")).evaluate<double>(std::array<double, 4>{3, 1, 0, 0}), 50003);
}

TEST(Symbols, RefuseTextsThatAreTooLong) {
  const std::string longest(Symbols::longest_text - 1, ' ');
  EXPECT_EQ(refusal(longest + "1").sentence, "accepted");
  EXPECT_EQ(refusal(longest + "11").sentence, "it has 1000001 characters; 1000000 are the most.");
}

TEST(Program, ThreadsMayShareIt) {
  Symbols symbols(variable_names);
  symbols.define("r", symbols.compile("x*x + 1"));
  const Program p = symbols.link(symbols.compile("r > 2 ? r*x : -r"));
  std::array<bool, 4> right{};
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      bool all = true;
      for (int n = 0; n < 20000; ++n) {
        const double x = k + n * 1e-3, r = x * x + 1;
        const double value = p.evaluate<double>(std::array<double, 4>{x, 0, 0, 0});
        all = all && std::abs(value - (r > 2 ? r * x : -r)) <= 1e-12 * std::abs(value);
      }
      right[static_cast<std::size_t>(k)] = all;
    });
  for (std::thread& t : threads) t.join();
  for (const bool all : right) EXPECT_TRUE(all);
}

}  // namespace
}  // namespace karcher
