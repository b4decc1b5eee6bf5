#include "app/schema.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "karcher/manifold/any_manifold.hpp"
#include "karcher/problem/problem.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

const Default required;
Default described(std::string words) { return Default::by_reader(std::move(words)); }

std::string several(std::size_t size, const std::string& what) { return size == 1 ? what : fmt::format("{} {}s", size, what); }

KeyInfo text(std::string name, std::string type, Default standard, std::string description) {
  return {.name = std::move(name),
          .kind = KeyKind::text,
          .type = std::move(type),
          .standard = std::move(standard),
          .description = std::move(description)};
}
KeyInfo word(std::string name, std::string type, Default standard, std::vector<std::string> words, std::string description) {
  return {.name = std::move(name),
          .kind = KeyKind::word,
          .type = std::move(type),
          .standard = std::move(standard),
          .description = std::move(description),
          .words = std::move(words)};
}
KeyInfo flag(std::string name, bool standard, std::string description) {
  return {.name = std::move(name), .kind = KeyKind::flag, .type = "true or false", .standard = standard, .description = std::move(description)};
}
KeyInfo integer(std::string name, Default standard, int minimum, int maximum, std::string description) {
  return {.name = std::move(name),
          .kind = KeyKind::integer,
          .type = maximum < 10 ? fmt::format("{}..{}", minimum, maximum) : "whole number",
          .standard = std::move(standard),
          .description = std::move(description),
          .minimum = minimum,
          .maximum = maximum};
}
KeyInfo number(std::string name, double standard, std::string description, std::string unit = {}) {
  return {.name = std::move(name),
          .kind = KeyKind::number,
          .type = "number",
          .standard = standard,
          .description = std::move(description),
          .unit = std::move(unit)};
}
KeyInfo constant(std::string name, Default standard, std::size_t size, std::string description, std::string unit = {}) {
  return {.name = std::move(name),
          .kind = KeyKind::constant,
          .type = several(size, "number"),
          .standard = std::move(standard),
          .description = std::move(description),
          .unit = std::move(unit),
          .size = size};
}
KeyInfo expression(std::string name, Default standard, std::size_t size, std::string description, std::string unit = {}) {
  return {.name = std::move(name),
          .kind = KeyKind::expression,
          .type = several(size, "expression"),
          .standard = std::move(standard),
          .description = std::move(description),
          .unit = std::move(unit),
          .size = size};
}
KeyInfo point(std::string name, std::string type, Default standard, std::string description) {
  return {.name = std::move(name),
          .kind = KeyKind::point,
          .type = std::move(type),
          .standard = std::move(standard),
          .description = std::move(description)};
}
KeyInfo table(std::string name, std::string type, Default standard, std::string description) {
  return {.name = std::move(name),
          .kind = KeyKind::table,
          .type = std::move(type),
          .standard = std::move(standard),
          .description = std::move(description)};
}

std::vector<SectionInfo> make_schema() {
  const MeshSpec mesh;
  const RegionSpec region;
  const FieldSpec field;
  const TermSpec term;
  const ContinuationOptions continuation;
  const SolverOptions solver;
  const OutputSpec output;
  const int highest_degree = 30, many = 1000000;
  const std::vector<KeyInfo> term_keys{text("type", "name", required, "karcher list energies"),
                                       text("on", "region", term.on, "region of integration")};
  return {
      {"",
       "top level",
       "A problem: a mesh, fields on it, energies and loads, boundary data, a load parameter t, a solver, and what to write.",
       {text("title", "string", described("name of the file"), "headline of tables and pages"),
        table("parameters", "table", described("none"), "named numbers for expressions"), table("mesh", "table", required, "where the problem lives"),
        table("regions", "tables", described("none"), "parts of the mesh by predicate"),
        table("reference", "table", described("the mesh"), "stress-free configuration"), table("fields", "tables", required, "the unknown maps"),
        table("energies", "array of tables", required, "what is minimised"),
        table("loads", "array of tables", described("none"), "potentials that count with a minus sign"),
        table("dirichlet", "array of tables", described("none"), "boundary data"),
        table("continuation", "table", described("one step to t = 1"), "load steps"),
        table("solver", "table", described("trust region"), "method and tolerances"),
        table("quadrature", "table", described("by energy"), "degrees of quadrature"),
        table("exact", "tables", described("none"), "known solution, for errors"),
        table("probes", "array of tables", described("none"), "values at points"),
        table("output", "table", described("all results"), "what is written and where")}},
      {"parameters",
       "[parameters]",
       "Named numbers or expressions, evaluated in the order of the file; a parameter may use earlier ones, and also x, y, z and t. --set "
       "parameters.L=2 (or --set L=2) overrides one. A table is a series in "
       "time, the column of a CSV file, piecewise linear in t between its lines.",
       {text("csv", "path", required,
             "file with a line of names and lines of numbers, separated by commas (# begins a comment); relative to the problem file"),
        text("column", "string", required, "name of the column with the values"),
        text("time", "string", "t", "name of the column with t, which increases")}},
      {"mesh",
       "[mesh]",
       "A file or a generator. Generators and their arguments: karcher doc mesh.generate",
       {text("file", "path", required, "Gmsh MSH 2.2 or 4.1, ASCII or binary, cells of order 1 to 3; relative to the problem file"),
        text("generate", "name", required, "a generator instead of a file; its arguments are further keys of this table"),
        flag("periodic", true, "of a file: the nodes that its section $Periodic pairs are one node for fields"),
        integer("refine", mesh.refine, 0, 20, "uniform refinements; generated curved surfaces refine onto the exact surface")}},
      {"regions",
       "[regions.NAME]",
       "Entities of one dimension whose every node satisfies a predicate, or the node nearest to a point (on the refined mesh).",
       {integer("dim", described("must be given; 0 with near"), 0, 3, "0 nodes, 1 edges, 2 faces or surface cells, 3 cells"),
        expression("where", described("must be given, or near"), 1, "true (not 0) at every node of the entities"),
        constant("near", described("none"), 3, "instead of where: the one node (vertex of a cell) nearest to this point of the mesh", "length"),
        flag("boundary", region.boundary, "only entities on the boundary of the mesh")}},
      {"reference",
       "[reference]",
       "Stress-free configuration, if it is not the mesh itself.",
       {expression("position", required, 3, "its place, as function of the mesh point; its Lagrange interpolant gives tangents, normal and curvature",
                   "length"),
        integer("order", described("that of the deformation, else 2"), 1, 3, "Lagrange order of the interpolant")}},
      {"fields",
       "[fields.NAME]",
       "A map from a region into a manifold. Manifolds: karcher list manifolds",
       {text("manifold", "name", required, join_names(manifold_names(), " ")),
        integer("order", described("that of the mesh"), 1, 3, "Lagrange order"),
        word("interpolation", "projection or geodesic", described("projection where the manifold has it, else geodesic"), {"projection", "geodesic"},
             "rule that makes a function of nodal values; without meaning for R^n"),
        text("on", "region", field.on, "region that carries the field"),
        point("initial", "point",
              described("reference position for a deformation, normal for the director of a shell, else 0 for R^n, identity for groups and SPD, the "
                        "last axis for spheres and hyperbolic spaces"),
              "initial values: numbers or expressions, \"identity\" (SO3, SU2, SPD), \"reference\" (R^n: the reference position), \"normal\" (S2, on "
              "surfaces: the unit normal of the reference), \"exact\" (that of "
              "[exact]), {results = \"DIR\"}: below. SO3: a rotation vector (3 entries), a matrix by rows (9, projected) or a quaternion (4, w "
              "first); S^n: n+1 entries, "
              "normalised; SPD(n): n*n entries")}},
      {"fields.initial",
       "[fields.NAME.initial]",
       "Starts from a load step of earlier results, interpolated to this mesh by the place in the stress-free configuration: initial = {results = "
       "\"DIR\", step = 3}. What is "
       "measured from the initial values, such as supports that keep them and the stress-free frames of rods, has `values`.",
       {text("results", "path", required, "a directory of results with solution.pvd, relative to the problem file"),
        integer("step", described("the last one"), 0, 1000000000, "load step; 0: the start of that run"),
        text("field", "name", described("the field's own name"), "the field there"),
        point("values", "point", described("as without results"), "what `initial` is without results")}},
      {"energies", "[[energies]]", "An integral over a region of a density of some fields; further keys by type. Types: karcher list energies",
       term_keys},
      {"loads", "[[loads]]", "A potential that counts in the energy with a minus sign; further keys by type. Types: karcher list energies",
       term_keys},
      {"dirichlet",
       "[[dirichlet]]",
       "Fixes a field on a region; values may depend on t and are set anew for every load step.",
       {text("name", "name", described("the region and the field, or the region and the word for a support"),
             "of this condition, in what `check` lists"),
        text("field", "name", described("must be given; with a word for a support: the deformation and its rotation"), "the field"),
        text("on", "region", required, "where"),
        point("value", "point", described("must be given, or one of the next three"),
              "as `initial` of a field; in R^n also \"free\", \"initial\" or \"current\" for a component; \"initial\" fixes the initial value, "
              "\"current\" the one "
              "that is there when the condition sets in; {axis-free = \"e3\"} (SO3) fixes the director d_3 and leaves the rotation about it free "
              "(also e1, "
              "e2: axes of the body)"),
        word("support", "word", described("none"), {"clamped", "pinned"},
             "clamped holds deformation and rotation, pinned the deformation; the rotation is free"),
        word("symmetry", "axis", described("none"), {"x", "y", "z"},
             "normal of a mirror plane of the body: the deformation stays in the plane, the rotation is about the normal only, a director in the "
             "plane"),
        word("diaphragm", "axis", described("none"), {"x", "y", "z"},
             "normal of a plate that is rigid in its plane and weak out of it: the deformation moves along the normal only, the rotation is free"),
        constant("from", described("before the first load step"), 1, "the condition sets in: it holds in load steps that end at t > from"),
        constant("to", described("the last load step"), 1, "the condition ends: it holds in load steps that end at t <= to")}},
      {"continuation",
       "[continuation]",
       "Load steps t = from + k/steps (to - from), k = 1 .. steps, each from the result of the last.",
       {constant("from", continuation.from, 1, "before the first step"), constant("to", continuation.to, 1, "last step"),
        integer("steps", continuation.steps, 1, many, "number of steps"),
        flag("adaptive", continuation.adaptive, "a failed step is halved, an easy one is followed by a longer one"),
        number("smallest", continuation.smallest, "adaptive: give up when a step is shorter than this part of to - from")}},
      {"solver",
       "[solver]",
       "Riemannian trust region (docs/numerics.md).",
       {word("method", "name", solver.method, SolverOptions::methods(),
             "trust-region, or gradient-flow: one implicit Euler step of the L2 gradient flow for each load step, t is time"),
        word("subproblem", "name", solver.subproblem, SolverOptions::subproblems(), "direct: sparse L D L^T with inertia"),
        word("norm", "name", solver.norm, SolverOptions::norms(), "norm of steps"),
        number("gradient_tolerance", solver.gradient_tolerance, "stop when the dual norm of the gradient is below this times the largest seen"),
        number("absolute_gradient_tolerance", solver.absolute_gradient_tolerance, "or below this", "energy"),
        number("step_tolerance", solver.step_tolerance, "or when an accepted full Newton step is at most this long (0: never)"),
        integer("max_iterations", solver.max_iterations, 0, 1000 * many, "trial steps for each load step"),
        number("initial_radius", solver.initial_radius, "first radius of the trust region; 0: 1, in the norm of steps, which is free of units"),
        integer("max_corrections", solver.max_corrections, 0, many, "simplified Newton steps for each trial step"),
        flag("escape", solver.escape, "leave a saddle along a direction of negative curvature")}},
      {"quadrature",
       "[quadrature]",
       "Degree of exactness of quadrature, instead of each energy's default.",
       {integer("degree", described("by energy"), 0, highest_degree, "for all cells"),
        integer("line", described("degree"), 0, highest_degree, "for lines"),
        integer("triangle", described("degree"), 0, highest_degree, "for triangles"),
        integer("quadrilateral", described("degree"), 0, highest_degree, "for quadrilaterals"),
        integer("tetrahedron", described("degree"), 0, highest_degree, "for tetrahedra"),
        integer("hexahedron", described("degree"), 0, highest_degree, "for hexahedra")}},
      {"exact",
       "[exact.FIELD]",
       "Known solution: errors are reported by run, evaluate and converge. Differentiated automatically.",
       {point("value", "expressions", required, "as `initial` of the field, in ambient coordinates")}},
      {"probes",
       "[[probes]]",
       "A value at a reference point after every load step.",
       {text("name", "string", required, "key in summary.json"), text("field", "name", required, "the field"),
        constant("at", required, 3, "reference point", "length"),
        word("quantity", "name", "value", {"value", "displacement", "rotation-vector", "director1", "director2", "director3"},
             "value (ambient coordinates), displacement (R^n: value - reference position), rotation-vector, director1, director2, director3 (SO3)")}},
      {"output",
       "[output]",
       "What is written and where.",
       {text("directory", "path", described("the problem file without its ending"), "directory of results, relative to the problem file"),
        flag("vtu", output.vtu, "files for ParaView"), flag("report", output.report, "the page report.html"),
        integer("every", output.every, 1, many, "write the fields after every so many load steps, and after the last")}},
  };
}

}  // namespace

const std::vector<SectionInfo>& schema() {
  static const std::vector<SectionInfo> sections = make_schema();
  return sections;
}

const SectionInfo& section_info(const std::string& name) {
  for (const SectionInfo& s : schema())
    if (s.name == name) return s;
  throw std::logic_error("no section " + name);
}

const std::vector<KeyInfo>& formula_keys() {
  static const std::vector<KeyInfo> keys{
      {.name = "fields", .kind = KeyKind::texts, .type = "1 to 3 names", .standard = required, .description = "fields that the density depends on"},
      {.name = "density",
       .kind = KeyKind::formula,
       .type = "expression",
       .standard = required,
       .description = "in x, y, z, t, the parameters, and for a field u: u[0], u[1], ... its ambient coordinates; u[0].x, u[0].y, u[0].z their "
                      "derivatives along the axes, "
                      "on a curve or surface those of the gradient there; of rotations also u.k1[0..2], u.k2, u.k3, the body rates along the tangent "
                      "directions of the cell, "
                      "and u.d1[0..2], u.d2, u.d3, the directors"},
      {.name = "let",
       .kind = KeyKind::texts,
       .type = "array of texts",
       .standard = std::vector<Value>{},
       .description = "\"name = expression\", one after the other, for the density and the definitions that follow"},
      text("moves", "name", described("none"),
           "the one of the fields whose values are the places of the points: it starts at the reference position, pictures show it")};
  return keys;
}

std::vector<std::string> key_names(const std::vector<KeyInfo>& keys) {
  std::vector<std::string> names;
  for (const KeyInfo& k : keys) names.push_back(k.name);
  return names;
}

}  // namespace karcher::app
