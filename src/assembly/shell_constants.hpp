#pragma once
/// \file
/// The parameters of the Cosserat shell at a point, checked where they are evaluated.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/energy/parameter.hpp"
#include "karcher/error.hpp"

namespace karcher {

inline std::string shell_place(const Vec3<double>& x) { return fmt::format("at ({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]); }

/// The parameters by their places in the formula.
struct ShellConstants {
  ParameterValue thickness, mu, lambda, mu_c, internal_length;
  std::array<ParameterValue, 3> b;
  std::array<ParameterValue, 2> prestretch;

  explicit ShellConstants(const ParameterValues& values) {
    const auto get = [&](const char* key) {
      const auto found = values.find(key);
      if (found == values.end()) throw InputError(fmt::format("cosserat-shell needs the parameter {}.", key));
      return found->second;
    };
    thickness = get("thickness");
    mu = get("mu");
    lambda = get("lambda");
    mu_c = get("mu_c");
    internal_length = get("L_c");
    b = {get("b[0]"), get("b[1]"), get("b[2]")};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto found = values.find(fmt::format("prestretch[{}]", i));
      prestretch[i] = found == values.end() ? ParameterValue(1.0) : found->second;
    }
  }
  std::array<const ParameterValue*, 10> all() const {
    return {&thickness, &mu, &lambda, &mu_c, &internal_length, &b[0], &b[1], &b[2], &prestretch[0], &prestretch[1]};
  }
  bool vary() const {
    return std::ranges::any_of(all(), [](const ParameterValue* p) { return static_cast<bool>(p->function); });
  }
  bool depend_on_t() const {
    return std::ranges::any_of(all(), [](const ParameterValue* p) { return p->depends_on_t; });
  }
  /// \throws InputError where a value is out of range.
  ShellMaterial<double> operator()(const Vec3<double>& x, double t) const {
    const ShellMaterial<double> m{thickness(x, t), mu(x, t), lambda(x, t), mu_c(x, t), internal_length(x, t), {b[0](x, t), b[1](x, t), b[2](x, t)}};
    const auto require = [&](bool good, const char* name, double value, const char* rule) {
      if (!good || !std::isfinite(value))
        throw InputError(fmt::format("cosserat-shell: {} = {:.6g} {}; it must be {}.", name, value, shell_place(x), rule));
    };
    require(m.thickness > 0, "thickness", m.thickness, "positive");
    require(m.mu > 0, "mu", m.mu, "positive");
    require(3 * m.lambda + 2 * m.mu > 0, "lambda", m.lambda, "finite, and 3 lambda + 2 mu positive");
    require(m.mu_c >= 0, "mu_c", m.mu_c, "zero or positive");
    require(m.internal_length > 0, "L_c", m.internal_length, "positive");
    for (double c : m.b) require(c >= 0, "a coefficient of b", c, "zero or positive");
    return m;
  }
  bool prestretched() const { return !prestretch[0].is(1) || !prestretch[1].is(1); }
  std::array<double, 2> prestretch_at(const Vec3<double>& x, double t) const {
    std::array<double, 2> e{};
    for (std::size_t i = 0; i < 2; ++i) {
      e[i] = prestretch[i](x, t);
      if (!(e[i] > 0) || !std::isfinite(e[i]))
        throw InputError(fmt::format("cosserat-shell: prestretch = {:.6g} {}; it must be positive.", e[i], shell_place(x)));
    }
    return e;
  }
};

}  // namespace karcher
