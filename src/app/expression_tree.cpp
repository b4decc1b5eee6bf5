#include "app/expression_tree.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "karcher/error.hpp"

namespace karcher::app {
namespace {

using Arguments = std::vector<Slope>;
using Variables = std::array<Slope, 4>;

struct Constant : Node {
  double value;
  explicit Constant(double v) : value(v) {}
  Slope operator()(const Variables&) const override { return Slope(value); }
};

struct Variable : Node {
  std::size_t index;
  explicit Variable(std::size_t i) : index(i) {}
  Slope operator()(const Variables& variables) const override { return variables[index]; }
};

struct Call : Node {
  Slope (*function)(const Arguments&);
  std::vector<Tree> arguments;
  Call(Slope (*f)(const Arguments&), std::vector<Tree> a) : function(f), arguments(std::move(a)) {}
  Slope operator()(const Variables& variables) const override {
    Arguments values;
    for (const Tree& a : arguments) values.push_back((*a)(variables));
    return function(values);
  }
};

/// c ? a : b evaluates one branch only, so that a branch may be singular where the other holds.
struct Conditional : Node {
  Tree condition, yes, no;
  Conditional(Tree c, Tree a, Tree b) : condition(std::move(c)), yes(std::move(a)), no(std::move(b)) {}
  Slope operator()(const Variables& variables) const override { return (*condition)(variables).v != 0 ? (*yes)(variables) : (*no)(variables); }
};

Slope power(const Slope& a, const Slope& b) {
  const bool constant_exponent = b.d == std::array<double, 3>{};
  const double value = std::pow(a.v, b.v);
  if (constant_exponent) return b.v == 0 ? Slope(1.0) : chain(a, value, b.v * std::pow(a.v, b.v - 1));
  Slope result = chain(b, value, value * std::log(a.v));
  const double da = b.v * std::pow(a.v, b.v - 1);
  for (std::size_t i = 0; i < 3; ++i) result.d[i] += da * a.d[i];
  return result;
}

Slope arc_tangent(const Slope& a, const Slope& b) {
  const double r2 = a.v * a.v + b.v * b.v;
  Slope result(std::atan2(a.v, b.v));
  for (std::size_t i = 0; i < 3; ++i) result.d[i] = (b.v * a.d[i] - a.v * b.d[i]) / r2;
  return result;
}

Slope sum(const Arguments& a) {
  Slope s(0.0);
  for (const Slope& x : a) s += x;
  return s;
}

Slope truth(bool b) { return Slope(b ? 1.0 : 0.0); }

struct Function {
  std::string name;
  Slope (*evaluate)(const Arguments&);
};

const std::vector<Function>& functions() {
  static const std::vector<Function> all{
      {"sin", [](const Arguments& a) { return chain(a[0], std::sin(a[0].v), std::cos(a[0].v)); }},
      {"cos", [](const Arguments& a) { return chain(a[0], std::cos(a[0].v), -std::sin(a[0].v)); }},
      {"tan", [](const Arguments& a) { return chain(a[0], std::tan(a[0].v), 1 + std::tan(a[0].v) * std::tan(a[0].v)); }},
      {"asin", [](const Arguments& a) { return chain(a[0], std::asin(a[0].v), 1 / std::sqrt(1 - a[0].v * a[0].v)); }},
      {"acos", [](const Arguments& a) { return chain(a[0], std::acos(a[0].v), -1 / std::sqrt(1 - a[0].v * a[0].v)); }},
      {"atan", [](const Arguments& a) { return chain(a[0], std::atan(a[0].v), 1 / (1 + a[0].v * a[0].v)); }},
      {"atan2", [](const Arguments& a) { return arc_tangent(a[0], a[1]); }},
      {"sinh", [](const Arguments& a) { return chain(a[0], std::sinh(a[0].v), std::cosh(a[0].v)); }},
      {"cosh", [](const Arguments& a) { return chain(a[0], std::cosh(a[0].v), std::sinh(a[0].v)); }},
      {"tanh", [](const Arguments& a) { return chain(a[0], std::tanh(a[0].v), 1 - std::tanh(a[0].v) * std::tanh(a[0].v)); }},
      {"asinh", [](const Arguments& a) { return chain(a[0], std::asinh(a[0].v), 1 / std::sqrt(a[0].v * a[0].v + 1)); }},
      {"acosh", [](const Arguments& a) { return chain(a[0], std::acosh(a[0].v), 1 / std::sqrt(a[0].v * a[0].v - 1)); }},
      {"atanh", [](const Arguments& a) { return chain(a[0], std::atanh(a[0].v), 1 / (1 - a[0].v * a[0].v)); }},
      {"log", [](const Arguments& a) { return chain(a[0], std::log(a[0].v), 1 / a[0].v); }},
      {"ln", [](const Arguments& a) { return chain(a[0], std::log(a[0].v), 1 / a[0].v); }},
      {"log2", [](const Arguments& a) { return chain(a[0], std::log2(a[0].v), 1 / (a[0].v * std::numbers::ln2)); }},
      {"log10", [](const Arguments& a) { return chain(a[0], std::log10(a[0].v), 1 / (a[0].v * std::numbers::ln10)); }},
      {"exp", [](const Arguments& a) { return chain(a[0], std::exp(a[0].v), std::exp(a[0].v)); }},
      {"sqrt", [](const Arguments& a) { return chain(a[0], std::sqrt(a[0].v), 0.5 / std::sqrt(a[0].v)); }},
      {"abs", [](const Arguments& a) { return a[0].v >= 0 ? a[0] : -a[0]; }},
      {"sign", [](const Arguments& a) { return Slope(a[0].v < 0   ? -1.0
                                                     : a[0].v > 0 ? 1.0
                                                                  : 0.0); }},
      {"rint", [](const Arguments& a) { return Slope(std::floor(a[0].v + 0.5)); }},
      {"floor", [](const Arguments& a) { return Slope(std::floor(a[0].v)); }},
      {"ceil", [](const Arguments& a) { return Slope(std::ceil(a[0].v)); }},
      {"mod", [](const Arguments& a) { return a[0] - std::floor(a[0].v / a[1].v) * a[1]; }},
      {"pow", [](const Arguments& a) { return power(a[0], a[1]); }},
      {"min", [](const Arguments& a) { return *std::min_element(a.begin(), a.end(), [](const Slope& p, const Slope& q) { return p.v < q.v; }); }},
      {"max", [](const Arguments& a) { return *std::max_element(a.begin(), a.end(), [](const Slope& p, const Slope& q) { return p.v < q.v; }); }},
      {"sum", sum},
      {"avg", [](const Arguments& a) { return (1.0 / static_cast<double>(a.size())) * sum(a); }},
  };
  return all;
}

class Parser {
 public:
  Parser(const std::string& text, const std::function<Tree(const std::string&)>& named) : text_(text), named_(named) {}

  Tree whole() {
    Tree tree = conditional();
    skip();
    if (at_ < text_.size()) wrong();
    return tree;
  }

 private:
  Tree conditional() {
    Tree condition = disjunction();
    if (!accept("?")) return condition;
    Tree yes = conditional();
    expect(":");
    Tree no = conditional();
    return std::make_shared<Conditional>(std::move(condition), std::move(yes), std::move(no));
  }
  Tree disjunction() {
    Tree left = conjunction();
    while (accept("||")) left = call([](const Arguments& a) { return truth(a[0].v != 0 || a[1].v != 0); }, {left, conjunction()});
    return left;
  }
  Tree conjunction() {
    Tree left = comparison();
    while (accept("&&")) left = call([](const Arguments& a) { return truth(a[0].v != 0 && a[1].v != 0); }, {left, comparison()});
    return left;
  }
  Tree comparison() {
    Tree left = addition();
    while (true) {
      if (accept("<="))
        left = call([](const Arguments& a) { return truth(a[0].v <= a[1].v); }, {left, addition()});
      else if (accept(">="))
        left = call([](const Arguments& a) { return truth(a[0].v >= a[1].v); }, {left, addition()});
      else if (accept("=="))
        left = call([](const Arguments& a) { return truth(a[0].v == a[1].v); }, {left, addition()});
      else if (accept("!="))
        left = call([](const Arguments& a) { return truth(a[0].v != a[1].v); }, {left, addition()});
      else if (accept("<"))
        left = call([](const Arguments& a) { return truth(a[0].v < a[1].v); }, {left, addition()});
      else if (accept(">"))
        left = call([](const Arguments& a) { return truth(a[0].v > a[1].v); }, {left, addition()});
      else
        return left;
    }
  }
  Tree addition() {
    Tree left = multiplication();
    while (true) {
      if (accept("+"))
        left = call([](const Arguments& a) { return a[0] + a[1]; }, {left, multiplication()});
      else if (accept("-"))
        left = call([](const Arguments& a) { return a[0] - a[1]; }, {left, multiplication()});
      else
        return left;
    }
  }
  Tree multiplication() {
    Tree left = sign();
    while (true) {
      if (accept("*"))
        left = call([](const Arguments& a) { return a[0] * a[1]; }, {left, sign()});
      else if (accept("/"))
        left = call([](const Arguments& a) { return a[0] / a[1]; }, {left, sign()});
      else
        return left;
    }
  }
  /// -a^b is -(a^b), and a sign may follow ^ .
  Tree sign() {
    if (accept("-")) return call([](const Arguments& a) { return -a[0]; }, {sign()});
    if (accept("+")) return sign();
    Tree base = primary();
    if (!accept("^")) return base;
    return call([](const Arguments& a) { return power(a[0], a[1]); }, {base, sign()});
  }
  Tree primary() {
    skip();
    if (accept("(")) {
      Tree inside = conditional();
      expect(")");
      return inside;
    }
    if (at_ < text_.size() && (digit(text_[at_]) || text_[at_] == '.')) return number();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    const std::string name = text_.substr(begin, at_ - begin);
    if (name.empty()) wrong();
    static const std::map<std::string, std::size_t> variables{{"x", 0}, {"y", 1}, {"z", 2}, {"t", 3}};
    if (const auto v = variables.find(name); v != variables.end()) return std::make_shared<Variable>(v->second);
    if (name == "pi" || name == "_pi") return constant_tree(std::numbers::pi);
    if (name == "_e") return constant_tree(std::numbers::e);
    if (Tree known = named_(name)) return known;
    for (const Function& f : functions()) {
      if (f.name != name) continue;
      expect("(");
      std::vector<Tree> arguments{conditional()};
      while (accept(",")) arguments.push_back(conditional());
      expect(")");
      return call(f.evaluate, std::move(arguments));
    }
    wrong();
  }
  Tree number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [end, code] = std::from_chars(first, text_.data() + text_.size(), value);
    if (code != std::errc()) wrong();
    at_ += static_cast<std::size_t>(end - first);
    return constant_tree(value);
  }

  static Tree call(Slope (*f)(const Arguments&), std::vector<Tree> arguments) { return std::make_shared<Call>(f, std::move(arguments)); }
  static bool digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool accept(std::string_view token) {
    skip();
    if (text_.compare(at_, token.size(), token) != 0) return false;
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token) {
    if (!accept(token)) wrong();
  }
  [[noreturn]] void wrong() const {
    throw InputError("The expression \"" + text_ + "\" cannot be differentiated: it is not understood at character " + std::to_string(at_ + 1) + ".");
  }

  const std::string& text_;
  const std::function<Tree(const std::string&)>& named_;
  std::size_t at_ = 0;
};

}  // namespace

Tree parse_tree(const std::string& text, const std::function<Tree(const std::string&)>& named) { return Parser(text, named).whole(); }

Tree constant_tree(double value) { return std::make_shared<Constant>(value); }

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Function& f : functions()) all.push_back(f.name);
    return all;
  }();
  return names;
}

}  // namespace karcher::app
