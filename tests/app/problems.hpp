#pragma once
/// \file
/// Problems that several tests of the program run.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "program_runner.hpp"

namespace karcher::testing {

/// Fields and energy of a soft shell.
inline const std::string soft_shell = R"toml([fields.m]
manifold = "R3"
order = 2
[fields.Q]
manifold = "SO3"
order = 1
[[energies]]
type = "cosserat-shell"
deformation = "m"
rotation = "Q"
thickness = 0.1
young = 1.2
poisson = 0
mu_c = 0.5
L_c = 0.01
)toml";

/// A strip, clamped at the left, pulled up at the right; two load steps.
inline const std::string strip = R"toml(title = "A strip"
[parameters]
load = 2e-6
L = 2
[mesh]
generate = "rectangle"
size = ["L", 1]
cells = [4, 2]
)toml" + soft_shell + R"toml([[loads]]
type = "traction"
field = "m"
on = "right"
value = [0, 0, "load*t"]
[[dirichlet]]
field = "m"
on = "left"
value = ["x", "y", "z"]
[[dirichlet]]
field = "Q"
on = "left"
value = "identity"
[continuation]
steps = 2
[[probes]]
name = "tip"
field = "m"
at = [2, 0.5, 0]
quantity = "displacement"
[[probes]]
name = "turn"
field = "Q"
at = [2, 0.5, 0]
quantity = "rotation-vector"
)toml";

inline nlohmann::json summary(const Workshop& shop, const std::string& directory) {
  return nlohmann::json::parse(content(shop.directory() / directory / "summary.json"));
}

/// Runs a problem that must end well. \returns its summary
inline nlohmann::json run(const Workshop& shop, const std::string& problem, const std::string& arguments = "", const std::string& directory = "out") {
  shop.write("problem.toml", problem);
  const Outcome o = shop.karcher("run problem.toml -q -o " + directory + " " + arguments);
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  return o.code == 0 ? summary(shop, directory) : nlohmann::json();
}

/// What `check` says of a problem that it must refuse.
inline std::string refusal(const std::string& problem) {
  const Workshop shop;
  shop.write("problem.toml", problem);
  const Outcome o = shop.karcher("check problem.toml");
  EXPECT_EQ(o.code, 2) << problem;
  return o.err;
}

/// A single geodesic from the pole to a given angle; half way round the mean of the two ends is not unique. Ends in [continuation].
inline std::string arc(const std::string& angle) {
  return "[parameters]\nangle = \"" + angle + "\"\n" + R"toml([mesh]
generate = "interval"
cells = [1]
[fields.u]
manifold = "S2"
interpolation = "geodesic"
[[energies]]
type = "harmonic"
field = "u"
[[dirichlet]]
field = "u"
on = "left"
value = [0, 0, 1]
[[dirichlet]]
field = "u"
on = "right"
value = ["sin(angle)", 0, "cos(angle)"]
[continuation]
)toml";
}

}  // namespace karcher::testing
