#pragma once
/// \file
/// The makers behind the table of generators, one for each shape.

#include <string>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"

namespace karcher {

/// Arguments with all defaults filled in and checked.
class Arguments {
 public:
  explicit Arguments(GeneratorOptions options) : options_(std::move(options)) {}

  double number(const std::string& argument, std::size_t i = 0) const { return options_.numbers.at(argument)[i]; }
  int integer(const std::string& argument, std::size_t i = 0) const { return static_cast<int>(number(argument, i)); }
  Vec3<double> point(const std::string& argument) const {
    Vec3<double> p;
    const auto& values = options_.numbers.at(argument);
    for (std::size_t i = 0; i < values.size(); ++i) p[static_cast<int>(i)] = values[i];
    return p;
  }
  const std::string& word(const std::string& argument) const { return options_.words.at(argument); }
  bool triangles() const { return word("shape") == "triangle"; }
  int order() const { return integer("order"); }
  [[noreturn]] void refuse(const std::string& sentence) const { throw InputError("Mesh generator \"" + options_.name + "\": " + sentence); }

 private:
  GeneratorOptions options_;
};

namespace shapes {

Mesh interval(const Arguments&);
Mesh rectangle(const Arguments&);
Mesh box(const Arguments&);
Mesh cylinder(const Arguments&);
Mesh annulus(const Arguments&);
Mesh disc(const Arguments&);
Mesh sphere(const Arguments&);
Mesh torus(const Arguments&);
Mesh moebius(const Arguments&);
Mesh bottle(const Arguments&);
Mesh helicoid(const Arguments&);

}  // namespace shapes
}  // namespace karcher
