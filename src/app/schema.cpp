#include "app/schema.hpp"

#include <stdexcept>

#include "karcher/manifold/any_manifold.hpp"
#include "karcher/text.hpp"

namespace karcher::app {

const std::vector<SectionInfo>& schema() {
  static const std::vector<SectionInfo> sections{
      {"",
       "top level",
       "A problem: a mesh, fields on it, energies and loads, boundary data, a load parameter t, a solver, and what to write.",
       {{"title", "string", "name of the file", "headline of tables and pages"},
        {"parameters", "table", "none", "named numbers for expressions"},
        {"mesh", "table", "-", "where the problem lives"},
        {"regions", "tables", "none", "parts of the mesh by predicate"},
        {"reference", "table", "the mesh", "stress-free configuration"},
        {"fields", "tables", "-", "the unknown maps"},
        {"energies", "array of tables", "-", "what is minimised"},
        {"loads", "array of tables", "none", "potentials that count with a minus sign"},
        {"dirichlet", "array of tables", "none", "boundary data"},
        {"continuation", "table", "one step to t = 1", "load steps"},
        {"solver", "table", "trust region", "method and tolerances"},
        {"quadrature", "table", "by energy", "degrees of quadrature"},
        {"exact", "tables", "none", "known solution, for errors"},
        {"probes", "array of tables", "none", "values at points"},
        {"output", "table", "all results", "what is written and where"}}},
      {"parameters",
       "[parameters]",
       "Named numbers or expressions, evaluated in the order of the file; a parameter may use earlier ones, and also x, y, z and t. --set "
       "parameters.L=2 "
       "(or --set L=2) overrides one.",
       {}},
      {"mesh",
       "[mesh]",
       "A file or a generator. Generators and their arguments: karcher doc mesh.generate",
       {{"file", "path", "-", "Gmsh MSH 2.2 or 4.1, ASCII or binary, cells of order 1 to 3; relative to the problem file"},
        {"generate", "name", "-", "a generator instead of a file; its arguments are further keys of this table"},
        {"refine", "whole number", "0", "uniform refinements; generated curved surfaces refine onto the exact surface"}}},
      {"regions",
       "[regions.NAME]",
       "Entities of one dimension whose every node satisfies a predicate (on the refined mesh).",
       {{"dim", "0..3", "-", "0 nodes, 1 edges, 2 faces or surface cells, 3 cells"},
        {"where", "expression", "-", "true (not 0) at every node of the entities"},
        {"boundary", "true or false", "false", "only entities on the boundary of the mesh"}}},
      {"reference",
       "[reference]",
       "Stress-free configuration, if it is not the mesh itself.",
       {{"position", "3 expressions", "-", "its place, as function of the mesh point; its Lagrange interpolant gives tangents, normal and curvature"},
        {"order", "1..3", "2", "Lagrange order of the interpolant"}}},
      {"fields",
       "[fields.NAME]",
       "A map from a region into a manifold. Manifolds: karcher list manifolds",
       {{"manifold", "name", "-", join_names(manifold_names(), " ")},
        {"order", "1..3", "1", "Lagrange order"},
        {"interpolation", "projection or geodesic", "projection where the manifold has it, else geodesic",
         "rule that makes a function of nodal values; without meaning for R^n"},
        {"on", "region", "all", "region that carries the field"},
        {"initial", "point",
         "reference position for a deformation, else 0 for R^n, identity for groups and SPD, the last axis for spheres and hyperbolic spaces",
         "initial values: numbers or expressions, \"identity\" (SO3, SU2, SPD), \"reference\" (R^n: the reference position), \"exact\" (that of "
         "[exact]). SO3: a "
         "rotation vector (3 entries), a matrix by rows (9, projected) or a quaternion (4, w first); S^n: n+1 entries, normalised; SPD(n): n*n "
         "entries"}}},
      {"energies",
       "[[energies]]",
       "An integral over a region of a density of some fields; further keys by type. Types: karcher list energies",
       {{"type", "name", "-", "karcher list energies"}, {"on", "region", "all", "region of integration"}}},
      {"loads",
       "[[loads]]",
       "A potential that counts in the energy with a minus sign; further keys by type. Types: karcher list energies",
       {{"type", "name", "-", "karcher list energies"}, {"on", "region", "all", "region of integration"}}},
      {"dirichlet",
       "[[dirichlet]]",
       "Fixes a field on a region; values may depend on t and are set anew for every load step.",
       {{"field", "name", "-", "the field"},
        {"on", "region", "-", "where"},
        {"value", "point", "-",
         "as `initial` of a field; in R^n also \"free\" or \"initial\" for a component; \"initial\" fixes the initial value; {axis-free = \"e3\"} "
         "(SO3) fixes the "
         "director d_3 of the initial rotation and leaves the rotation about it free (also e1, e2: axes of the body)"}}},
      {"continuation",
       "[continuation]",
       "Load steps t = from + k/steps (to - from), k = 1 .. steps, each from the result of the last.",
       {{"from", "number", "0", "before the first step"},
        {"to", "number", "1", "last step"},
        {"steps", "whole number", "1", "number of steps"},
        {"adaptive", "true or false", "false", "a failed step is halved, an easy one is followed by a longer one"},
        {"smallest", "number", "1e-4", "adaptive: give up when a step is shorter than this part of to - from"}}},
      {"solver",
       "[solver]",
       "Riemannian trust region (docs/numerics.md).",
       {{"method", "name", "trust-region",
         "trust-region, or gradient-flow: one implicit Euler step of the L2 gradient flow for each load step, t is time"},
        {"subproblem", "name", "direct", "direct: sparse L D L^T with inertia"},
        {"norm", "name", "mass", "norm of steps"},
        {"gradient_tolerance", "number", "1e-8", "stop when the dual norm of the gradient is below this times the largest seen"},
        {"absolute_gradient_tolerance", "number", "0", "or below this"},
        {"step_tolerance", "number", "0", "or when an accepted full Newton step is at most this long (0: never)"},
        {"max_iterations", "whole number", "200", "trial steps for each load step"},
        {"initial_radius", "number", "0", "first radius of the trust region; 0: 1, in the norm of steps, which is free of units"},
        {"max_corrections", "whole number", "20", "simplified Newton steps for each trial step"},
        {"escape", "true or false", "false", "leave a saddle along a direction of negative curvature"}}},
      {"quadrature",
       "[quadrature]",
       "Degree of exactness of quadrature, instead of each energy's default.",
       {{"degree", "whole number", "by energy", "for all cells"},
        {"line", "whole number", "degree", "for lines"},
        {"triangle", "whole number", "degree", "for triangles"},
        {"quadrilateral", "whole number", "degree", "for quadrilaterals"},
        {"tetrahedron", "whole number", "degree", "for tetrahedra"},
        {"hexahedron", "whole number", "degree", "for hexahedra"}}},
      {"exact",
       "[exact.FIELD]",
       "Known solution: errors are reported by run, evaluate and converge. Differentiated automatically.",
       {{"value", "expressions", "-", "as `initial` of the field, in ambient coordinates"}}},
      {"probes",
       "[[probes]]",
       "A value at a reference point after every load step.",
       {{"name", "string", "-", "key in summary.json"},
        {"field", "name", "-", "the field"},
        {"at", "3 numbers", "-", "reference point"},
        {"quantity", "name", "value",
         "value (ambient coordinates), displacement (R^n: value - reference position), rotation-vector, director1, director2, director3 (SO3)"}}},
      {"output",
       "[output]",
       "What is written and where.",
       {{"directory", "path", "the problem file without its ending", "directory of results, relative to the problem file"},
        {"vtu", "true or false", "true", "files for ParaView"},
        {"report", "true or false", "true", "the page report.html"},
        {"every", "whole number", "1", "write the fields after every so many load steps, and after the last"}}},
  };
  return sections;
}

const SectionInfo& section_info(const std::string& name) {
  for (const SectionInfo& s : schema())
    if (s.name == name) return s;
  throw std::logic_error("no section " + name);
}

std::vector<std::string> key_names(const std::string& section) {
  std::vector<std::string> names;
  for (const KeyInfo& k : section_info(section).keys) names.push_back(k.name);
  return names;
}

}  // namespace karcher::app
