// Values over double: the grammar, and muParser as oracle, bit by bit.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <muParser.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "karcher/expression/symbols.hpp"

namespace karcher {
namespace {

const std::vector<std::string> variable_names{"x", "y", "z", "t"};
using Variables = std::array<double, 4>;
const Variables point{0.3, -0.7, 1.9, 0.4};

double value(const std::string& text, const Variables& at = point) {
  const Symbols symbols(variable_names);
  return symbols.link(symbols.compile(text)).evaluate<double>(at);
}

/// muParser as problem files knew it.
class Oracle {
 public:
  Oracle() {
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.DefineFun("pow", [](double a, double b) { return std::pow(a, b); });
    parser_.DefineFun("mod", [](double a, double b) { return std::fma(-b, std::floor(a / b), a); });
    parser_.DefineFun("floor", [](double a) { return std::floor(a); });
    parser_.DefineFun("ceil", [](double a) { return std::ceil(a); });
    for (std::size_t i = 0; i < 4; ++i) parser_.DefineVar(variable_names[i], &variables_[i]);
  }
  void define(const std::string& name, double constant) { parser_.DefineConst(name, constant); }
  void define(const std::string& name, double* value) { parser_.DefineVar(name, value); }
  void compile(const std::string& text) { parser_.SetExpr(text); }
  double operator()(const Variables& at) {
    variables_ = at;
    return parser_.Eval();
  }

 private:
  Variables variables_{};
  mu::Parser parser_;
};

/// Random expressions over x, y, z, t, the constants a, b and the definitions p, q.
class RandomExpression {
 public:
  explicit RandomExpression(unsigned seed) : random_(seed) {}

  std::string operator()(int depth) {
    const int kind = pick(depth > 0 ? 16 : 6);
    if (kind < 3) return name();
    if (kind < 6) return number();
    const std::string first = (*this)(depth - 1), second = (*this)(depth - 1);
    if (kind < 12) return fmt::format("({}{}{})", first, one_of({" + ", "-", "*", "/", " * ", "+"}), second);
    if (kind == 12)
      return fmt::format("{}{}{}{}", one_of({"-", "+"}), name(), one_of({"^", "*", "-", "^-"}), one_of({"0", "1", "2", "3", "4", "0.5", "z", "b"}));
    if (kind == 13) return fmt::format("({} ? {} : {})", condition(depth - 1), first, second);
    if (kind == 14) return fmt::format("{}({})", one_of({"min", "max", "sum", "avg"}), arguments(depth));
    if (pick(4) == 0) return fmt::format("{}({},{})", one_of({"atan2", "pow", "mod"}), first, second);
    return fmt::format("{}({})", one_of({"sin", "cos", "tan",  "asin",  "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
                                         "log", "ln",  "log2", "log10", "exp",  "sqrt", "abs",  "sign", "rint", "floor", "ceil"}),
                       first);
  }
  /// A sum without parentheses.
  std::string chain() {
    std::string s = fmt::format("{}{}", one_of({"", "-"}), term());
    for (int n = 1 + pick(5); n > 0; --n) s += fmt::format("{}{}", one_of({"+", "-", " - "}), term());
    return s;
  }

 private:
  std::string term() {
    std::string s = pick(2) ? name() : number();
    for (int n = pick(4); n > 0; --n) s += fmt::format("{}{}", one_of({"*", "/", "^"}), pick(2) ? name() : number());
    return s;
  }
  std::string condition(int depth) {
    const std::string c = fmt::format("{}{}{}", (*this)(depth - 1), one_of({"<", ">", "<=", ">=", "==", "!="}), (*this)(depth - 1));
    return pick(3) ? c : fmt::format("{}{}{}{}{}", c, one_of({"&&", "||"}), name(), one_of({"<", ">="}), number());
  }
  std::string arguments(int depth) {
    std::string s = (*this)(depth - 1);
    for (int n = pick(3); n > 0; --n) s += fmt::format(", {}", (*this)(depth - 1));
    return s;
  }
  std::string name() { return one_of({"x", "y", "z", "t", "a", "b", "p", "q", "pi", "_e", "x", "y"}); }
  std::string number() { return one_of({"0", "1", "2", "3", "4", "0.1", ".7", "1e-3", "2.5e2", "7.", "0.3", "1e+1", "(-0.0)", "(-3)"}); }
  std::string one_of(std::initializer_list<const char*> all) { return *(all.begin() + pick(static_cast<int>(all.size()))); }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  std::mt19937 random_;
};

bool same_bits(double a, double b) { return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

TEST(Expression, BindsAsDocumented) {
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-1^2*8"), 4);
  EXPECT_EQ(value("2*-3*4"), -24);
  EXPECT_EQ(value("8/4/2"), 1);
  EXPECT_EQ(value("1 - 2 - 3"), -4);
  EXPECT_EQ(value("--2 - -3"), 5);
  EXPECT_EQ(value("1 || 1 && 0"), 1);
  EXPECT_EQ(value("1 + 1 == 2 && 3 > 2"), 1);
  EXPECT_EQ(value("3 > 2 > 1"), 0);
  EXPECT_EQ(value("x > 0 ? y < 0 ? 5 : 6 : 7"), 5);
  EXPECT_EQ(value("x < 0 ? 1 : y < 0 ? 2 : 3"), 2);
  EXPECT_EQ(value("0 ? 1 : 2 + 3"), 5);
  EXPECT_EQ(value("1 + (0 ? 1 : 2)*3"), 7);
  EXPECT_EQ(value("min(1 ? 2 : 3, 4)"), 2);
}

TEST(Expression, ReadsNumbers) {
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("1."), 1);
  EXPECT_EQ(value("1e3 + 1.E-1 + 2.5e+2"), 1250.1);
  EXPECT_EQ(value("0.1"), 0.1);
  EXPECT_EQ(value("1e-400"), 0);
  EXPECT_EQ(value("4.9e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(Expression, TakesWhatIsNotZeroForTrue) {
  // Here muParser differs: it takes constants between -1 and 1 for false, others not.
  EXPECT_EQ(value("0.5 && 1"), 1);
  EXPECT_EQ(value("x && 1"), 1);
  EXPECT_EQ(value("0 || -0.1"), 1);
  EXPECT_EQ(value("0 || -0.0"), 0);
  EXPECT_EQ(value("0.5 ? 2 : 3"), 2);
}

TEST(Expression, KnowsItsFunctionsAndConstants) {
  EXPECT_EQ(value("sin(pi/6)"), std::sin(std::numbers::pi / 6));
  EXPECT_EQ(value("log(_e) + ln(_e) + _pi - pi"), 2);
  EXPECT_EQ(value("mod(-1, 3) + floor(1.7) + ceil(1.2) + pow(2, 3)"), 2 + 1 + 2 + 8);
  EXPECT_EQ(value("mod(0.5, 0.1)"), std::fma(-0.1, 5, 0.5));
  EXPECT_EQ(value("min(3, 1, 2) + 10*max(3, 1, 2) + 100*sum(3, 1, 2) + 1000*avg(3, 1, 2) + 10000*min(4)"), 1 + 30 + 600 + 2000 + 40000);
  EXPECT_EQ(value("rint(2.5) + 10*rint(-2.5) + 100*sign(-3) + 1000*sign(0) + 10000*abs(-2)"), 3 - 20 - 100 + 20000);
  EXPECT_EQ(value("atan2(1, -1)"), std::atan2(1, -1));
}

TEST(Expression, HasTheValuesOfMuParserBitByBit) {
  const double a = 0.5, b = 3;
  Symbols symbols(variable_names);
  symbols.define("a", a);
  symbols.define("b", b);
  symbols.define("p", symbols.compile("x*y - a"));
  symbols.define("q", symbols.compile("sqrt(z*z + p)"));
  const Program p = symbols.link(symbols.compile("p")), q = symbols.link(symbols.compile("q"));

  Oracle oracle;
  double p_value = 0, q_value = 0;
  oracle.define("a", a);
  oracle.define("b", b);
  oracle.define("p", &p_value);
  oracle.define("q", &q_value);

  const std::vector<Variables> points{point, {0, 0, 0, 0}, {-1.25, 2, -3e-5, 1}, {-0.0, 1, 7.7e8, 1e-9}};
  RandomExpression random(1);
  int finite = 0;
  for (int n = 0; n < 20000; ++n) {
    const std::string text = n % 2 ? random(4) : random.chain();
    const Program program = symbols.link(symbols.compile(text));
    oracle.compile(text);
    for (const Variables& at : points) {
      p_value = p.evaluate<double>(at);
      q_value = q.evaluate<double>(at);
      const double ours = program.evaluate<double>(at), theirs = oracle(at);
      finite += std::isfinite(theirs);
      ASSERT_TRUE(same_bits(ours, theirs)) << text << " = " << ours << ", muParser: " << theirs << " at " << at[0] << ", " << at[1] << ", " << at[2];
    }
  }
  EXPECT_GT(finite, 40000);
}

}  // namespace
}  // namespace karcher
