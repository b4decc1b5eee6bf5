#include "app/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "karcher/error.hpp"

namespace karcher::app {
namespace {

const Vec3<double> point{{0.3, -0.7, 1.9}};

double value(const std::string& text) { return Scope().compile(text, "key", {"file.toml", 1, 1})(point, 0.4); }

std::string refusal(const std::string& text, const Scope& scope = {}) {
  try {
    scope.compile(text, "load.value", {"file.toml", 7, 10})(point, 0.4);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Expression, BindsAsDocumented) {
  EXPECT_DOUBLE_EQ(value("-2^2"), -4);
  EXPECT_DOUBLE_EQ(value("2^3^2"), 512);
  EXPECT_DOUBLE_EQ(value("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(value("8/4/2"), 1);
  EXPECT_DOUBLE_EQ(value("0 || 1 && 0"), 0);
  EXPECT_DOUBLE_EQ(value("x > 0 ? y < 0 ? 5 : 6 : 7"), 5);
  EXPECT_DOUBLE_EQ(value("sin(pi/6)"), std::sin(std::numbers::pi / 6));
  EXPECT_DOUBLE_EQ(value("mod(-1, 3) + floor(1.7) + ceil(1.2) + pow(2, 3)"), 2 + 1 + 2 + 8);
  EXPECT_DOUBLE_EQ(value("x + 10*y + 100*z + 1000*t"), 0.3 - 7 + 190 + 400);
}

TEST(Expression, KnowsWhetherItIsConstant) {
  Scope scope;
  scope.define("L", Expression(2.0), {});
  scope.define("r", scope.compile("sqrt(x^2 + y^2)", "parameters.r", {}), {});
  scope.define("s", scope.compile("t * L", "parameters.s", {}), {});
  EXPECT_TRUE(scope.compile("L^2 + pi", "k", {}).is_constant());
  EXPECT_DOUBLE_EQ(scope.compile("L^2", "k", {}).constant(), 4);
  const Expression r = scope.compile("1 + r", "k", {}), s = scope.compile("s", "k", {});
  EXPECT_FALSE(r.is_constant());
  EXPECT_TRUE(r.uses_point());
  EXPECT_FALSE(r.uses_t());
  EXPECT_TRUE(s.uses_t());
  EXPECT_FALSE(s.uses_point());
  EXPECT_DOUBLE_EQ(r(point, 0), 1 + std::hypot(0.3, 0.7));
  EXPECT_DOUBLE_EQ(s(point, 0.25), 0.5);
}

TEST(Expression, NamesThePlaceOfASyntaxError) {
  EXPECT_NE(refusal("2*(x + 1").find("file.toml:7:18: "), std::string::npos) << refusal("2*(x + 1");
  EXPECT_NE(refusal("2*sni(x)").find("file.toml:7:12: "), std::string::npos) << refusal("2*sni(x)");
  EXPECT_NE(refusal("2*sni(x)").find("Did you mean \"sin\"?"), std::string::npos);
  Scope scope;
  scope.define("load", Expression(1.0), {});
  EXPECT_NE(refusal("laod*t", scope).find("Did you mean \"load\"?"), std::string::npos) << refusal("laod*t", scope);
  EXPECT_NE(refusal("").find("empty"), std::string::npos) << refusal("");
}

TEST(Expression, RefusesAssignmentsAndLists) {
  EXPECT_NE(refusal("x = 3").find("\"==\""), std::string::npos) << refusal("x = 3");
  EXPECT_NE(refusal("1, 2").find("not a list"), std::string::npos) << refusal("1, 2");
  EXPECT_EQ(refusal("x == 3 && y <= 1 || z >= 2 && x != 1"), "accepted");
}

TEST(Expression, RefusesValuesThatAreNotFiniteAndSaysWhere) {
  EXPECT_NE(refusal("1/(x - 0.3)").find("at (0.3, -0.7, 1.9)"), std::string::npos) << refusal("1/(x - 0.3)");
  EXPECT_NE(refusal("1/(x - 0.3)").find("load.value"), std::string::npos);
  EXPECT_NE(refusal("sqrt(-1)").find("must be finite"), std::string::npos) << refusal("sqrt(-1)");
}

TEST(Expression, AParameterThatIsNotFiniteIsNamedWithItsOwnPlace) {
  Scope scope;
  scope.define("p", scope.compile("1/x", "parameters.p", {"file.toml", 3, 6}), {"file.toml", 3, 1});
  scope.define("q", scope.compile("t*p", "parameters.q", {"file.toml", 4, 6}), {"file.toml", 4, 1});
  const Expression e = scope.compile("x > 0 ? q : y", "load.value", {"file.toml", 7, 10});
  EXPECT_DOUBLE_EQ(e(point, 3), 10);
  try {
    e({{0.0, 2.0, 0.0}}, 3);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "file.toml:3:6: parameters.p = \"1/x\" is inf at (0, 2, 0); it must be finite.");
  }
}

TEST(Expression, ATextThatIsTooLongIsNotPrinted) {
  const std::string message = refusal(std::string(1000001, '1'));
  EXPECT_NE(message.find("file.toml:7:10: "), std::string::npos);
  EXPECT_NE(message.find("it has 1000001 characters; 1000000 are the most."), std::string::npos);
  EXPECT_LT(message.size(), 1200u);
}

TEST(Expression, DerivativesAgreeWithDifferencesAndValues) {
  Scope scope;
  scope.define("a", Expression(1.3), {});
  scope.define("r2", scope.compile("x^2 + y^2", "r2", {}), {});
  const char* texts[] = {"2*x/(r2 + 1)",
                         "(r2 - 1)/(r2 + 1)",
                         "sin(a*x)*cos(y) + tan(z/3)",
                         "exp(-r2)*log(z + 2) + ln(z) + log2(z)*log10(z)",
                         "atan2(y, x) + atan(z)",
                         "asin(x/2) + acos(y/2)",
                         "sinh(x)*cosh(y) - tanh(z)",
                         "asinh(x) + acosh(z + 1) + atanh(y/2)",
                         "sqrt(r2 + z)^3",
                         "pow(z, 1.5) + z^x",
                         "abs(y)*sign(y) + rint(z)",
                         "min(x, y, z) + max(x, y*y)",
                         "sum(x, y, z) + avg(x, y)",
                         "x < 0.5 ? x^2*y : 1/(x - 0.3)",
                         "(x > 0 && y > 0) || z > 1 ? -x : x",
                         "-x^2*y",
                         "2^-x",
                         "mod(z, 1) + floor(x) + ceil(y)",
                         "t*x*y*z",
                         "+x - -y",
                         "1e-1*x + .5*y + 2.*z",
                         "x == 0.3 ? z : y",
                         "x != 0.3 ? z : y",
                         "(x <= y) + (x >= y)*z"};
  for (const char* text : texts) {
    const Expression e = scope.compile(text, "key", {"file.toml", 1, 1});
    const auto d = e.derivative(point, 0.7);
    EXPECT_NEAR(d.v, e(point, 0.7), 1e-14 * (1 + std::abs(d.v))) << text;
    for (int i = 0; i < 3; ++i) {
      const double h = 1e-5;
      Vec3<double> high = point, low = point;
      high[i] += h;
      low[i] -= h;
      if (std::string(text).find("==") != std::string::npos || std::string(text).find("!=") != std::string::npos ||
          std::string(text).find("1/(x") != std::string::npos)
        continue;
      EXPECT_NEAR(d.d[static_cast<std::size_t>(i)], (e(high, 0.7) - e(low, 0.7)) / (2 * h), 1e-8) << text << " in direction " << i;
    }
  }
}

TEST(Expression, DerivativesThatAreNotFiniteAreRefused) {
  const Expression e = Scope().compile("sqrt(x)", "exact.u.value.0", {"file.toml", 3, 4});
  EXPECT_THROW(e.derivative({{0.0, 0.0, 0.0}}, 0), InputError);
  EXPECT_DOUBLE_EQ(e({{0.0, 0.0, 0.0}}, 0), 0);
}

TEST(Scope, RefusesNamesThatMeanSomethingElse) {
  for (const char* name : {"x", "t", "pi", "sin", "mu-c", "2a", ""})
    EXPECT_THROW(Scope().define(name, Expression(1.0), {"file.toml", 1, 1}), InputError) << name;
  Scope scope;
  scope.define("a", Expression(1.0), {});
  EXPECT_THROW(scope.define("a", Expression(1.0), {"file.toml", 1, 1}), InputError);
}

}  // namespace
}  // namespace karcher::app
