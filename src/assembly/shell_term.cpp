#include "karcher/assembly/shell_term.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/shell_constants.hpp"
#include "karcher/assembly/selective_integration.hpp"
#include "karcher/assembly/shell_kernel.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "karcher/mesh/reference_geometry.hpp"
#include "karcher/mesh/surface_geometry.hpp"

namespace karcher {
namespace {

constexpr int W = native_width;
constexpr std::size_t lanes_per_batch = W;

/// What all batches of one kind of cell share.
struct Kind {
  const Quadrature* quadrature = nullptr;
  shell::Tables tables;
  std::vector<LocalBlock> blocks;
  std::array<shell::Kernel, 3> kernels{};  ///< by Want
};

/// What the constants of the shell are applied to at a quadrature point.
struct Place {
  std::array<double, 2> curvature{};
  double weight = 0;  ///< quadrature weight times sqrt(det a)
};

/// Whether the upper triangle of a symmetric 4 x 4 matrix is that of a positive semidefinite one, up to rounding: Cholesky of the matrix scaled to a
/// unit
/// diagonal (so that one tolerance fits stretching and bending) and shifted a little.
bool semidefinite(const std::array<double, 10>& upper) {
  double a[4][4], scale[4];
  for (int i = 0; i < 4; ++i) {
    const double d = upper[ShellForm<double>::index(i, i)];
    if (!(d >= 0)) return false;
    scale[i] = d > 0 ? 1 / std::sqrt(d) : 0;
  }
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) a[i][j] = a[j][i] = scale[i] * scale[j] * upper[ShellForm<double>::index(i, j)] + (i == j ? 1e-9 : 0.0);
  for (int p = 0; p < 4; ++p) {
    if (!(a[p][p] > 0)) return false;
    for (int i = p + 1; i < 4; ++i)
      for (int j = p + 1; j < 4; ++j) a[i][j] -= a[i][p] * a[p][j] / a[p][p];
  }
  return true;
}

class ShellTerm final : public Term {
 public:
  ShellTerm(TermInfo info, TermInput input)
      : info_(std::move(info)),
        input_(std::move(input)),
        constants_(input_.parameters),
        reference_(*input_.mesh, input_.reference_position, input_.reference_order),
        factors_(selective_factors(input_.part)) {
    if (input_.part != SelectivePart::whole) diameters_ = cell_diameters(input_);
    const auto choice = input_.choices.find("coupling");
    if (choice != input_.choices.end() && choice->second == "birsan-2021") coupling_ = ShellCoupling::birsan_2021;
    info_.quantities = {{"strain", "1", 1, "size of the strains, |E| + h/2 |E b + c K|, root mean squares over the cell", 0.2}};
    check_fields();
    std::map<CellKind, std::vector<int>> cells;
    for (std::size_t c = 0; c < input_.region.cells.size(); ++c) cells[input_.region.cells[c].kind].push_back(static_cast<int>(c));
    kinds_.reserve(cells.size());  // batches point into it
    for (const auto& [kind, list] : cells) {
      add_kind(kind);
      for (std::size_t begin = 0; begin < list.size(); begin += lanes_per_batch) add_batch(std::span(list).subspan(begin));
    }
    apply_constants();
  }

  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return static_cast<int>(batches_.size()); }
  const Batch& batch(int b) const override { return batches_[static_cast<std::size_t>(b)]; }
  const Cell& cell(int cell) const override { return input_.region.cells[static_cast<std::size_t>(cell)]; }
  std::vector<std::string> warnings() const override { return warnings_; }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    run(u, b, want, points_.data() + first_entry_[static_cast<std::size_t>(b)],
        {out.energy.data(), out.trouble.data(), out.gradient.data(), out.hessian.data()});
  }

  std::vector<std::array<double, lanes_per_batch>> batch_part_energies(const Configuration& u, int b) const override {
    std::vector<std::array<double, lanes_per_batch>> parts;
    for (const ShellParts& part : {ShellParts{true, false, false}, {false, true, false}, {false, false, true}})
      parts.push_back(integrals(u, b, [&](std::size_t place, int c) {
        const auto& k = places_[place].curvature;
        const ShellMaterial<double> m = material(place, {});
        return counted(shell_form(k[0], k[1], m, coupling_, part), part.membrane, m, c);
      }));
    return parts;
  }

  std::vector<std::array<double, lanes_per_batch>> batch_quantities(const Configuration& u, int b) const override {
    const auto membrane = integrals(u, b, [](std::size_t, int) { return strain_square<double>(); });
    const auto bending = integrals(u, b, [&](std::size_t place, int) {
      return bending_strain_square(places_[place].curvature[0], places_[place].curvature[1], material(place, {}).thickness);
    });
    std::array<double, lanes_per_batch> strain{};
    for (std::size_t lane = 0; lane < lanes_per_batch; ++lane) {
      double area = 0;
      for (std::size_t p = 0; p < static_cast<std::size_t>(kind(b).tables.points); ++p)
        area += places_[first_place_[static_cast<std::size_t>(b)] + p * lanes_per_batch + lane].weight;
      const double sum = std::sqrt(membrane[lane] / area) + std::sqrt(bending[lane] / area);
      strain[lane] = std::isfinite(sum) ? sum : std::numeric_limits<double>::quiet_NaN();
    }
    return {strain};
  }

  void set_load_parameter(double t) override {
    if (t == input_.t) return;
    input_.t = t;
    if (!constants_.depend_on_t()) return;
    if (std::ranges::any_of(constants_.prestretch, &ParameterValue::depends_on_t))
      for (int b = 0; b < batch_count(); ++b) place(b);
    apply_constants();
  }

 private:
  const Kind& kind(int b) const { return kinds_[kind_[static_cast<std::size_t>(b)]]; }
  const Field& field(std::size_t slot) const { return input_.field(slot); }

  void check_fields() const {
    if (input_.region.dim != 2)
      throw InputError(
          fmt::format("A cosserat-shell lives on a surface, but region \"{}\" has dimension {}.", input_.region.name, input_.region.dim));
    constexpr std::array<const char*, 2> slots{"deformation", "rotation"};
    const std::array manifolds{&manifold_ops<Euclidean<3>>(), &manifold_ops<Rotation>()};
    for (std::size_t slot = 0; slot < 2; ++slot)
      if (field(slot).manifold != manifolds[slot])
        throw InputError(fmt::format("cosserat-shell: the field \"{}\" given as {} has values in {}; it must have values in {}.", field(slot).name,
                                     slots[slot], field(slot).manifold->name, manifolds[slot]->name));
  }

  void add_kind(CellKind cell_kind) {
    const int m_order = field(0).space->order(), r_order = field(1).space->order();
    const auto chosen = input_.quadrature_degree.find(cell_kind);
    Kind& k = kinds_.emplace_back();
    k.quadrature = &quadrature(
        cell_kind, chosen != input_.quadrature_degree.end() ? chosen->second : default_shell_degree(cell_kind, std::max(m_order, r_order)));
    shell::Tables& t = k.tables;
    t.points = k.quadrature->size();
    t.m_nodes = node_count(cell_kind, m_order);
    t.r_nodes = node_count(cell_kind, r_order);
    for (const auto& xi : k.quadrature->points) {
      const Shape m = lagrange(cell_kind, m_order, xi), r = lagrange(cell_kind, r_order, xi);
      for (const auto& g : m.gradient) t.m_gradient.insert(t.m_gradient.end(), {g[0], g[1]});
      t.r_value.insert(t.r_value.end(), r.value.begin(), r.value.end());
      for (const auto& g : r.gradient) t.r_gradient.insert(t.r_gradient.end(), {g[0], g[1]});
    }
    for (int i = 0; i < t.m_nodes; ++i) k.blocks.push_back({input_.fields[0], 3});
    for (int i = 0; i < t.r_nodes; ++i) k.blocks.push_back({input_.fields[1], 3});
    for (Want want : {Want::energy, Want::gradient, Want::hessian}) k.kernels[static_cast<std::size_t>(want)] = shell::kernel(field(1).rule, want);
  }

  /// Cells list[0 .. W - 1], or all of a shorter list and its last cell repeated.
  void add_batch(std::span<const int> list) {
    const Kind& k = kinds_.back();
    kind_.push_back(kinds_.size() - 1);
    Batch& batch = batches_.emplace_back();
    batch.cells_used = static_cast<int>(std::min(list.size(), lanes_per_batch));
    batch.blocks = &k.blocks;
    batch.nodes.resize(k.blocks.size() * lanes_per_batch);
    first_entry_.push_back(points_.size());
    first_place_.push_back(places_.size());
    const auto count = static_cast<std::size_t>(k.tables.points);
    points_.resize(points_.size() + count * static_cast<std::size_t>(shell::point_entries) * lanes_per_batch);
    places_.resize(places_.size() + count * lanes_per_batch);
    if (constants_.vary()) positions_.resize(places_.size());
    for (std::size_t lane = 0; lane < lanes_per_batch; ++lane) {
      const int c = list[std::min(lane, list.size() - 1)];
      batch.cells[lane] = c;
      const Cell& entity = cell(c);
      std::size_t block = 0;
      for (std::size_t slot = 0; slot < 2; ++slot) {
        const std::vector<int> nodes = field(slot).space->entity_nodes(entity);
        if (nodes.empty())
          throw InputError(fmt::format("Field \"{}\" lives on region \"{}\", which does not contain all of region \"{}\".", field(slot).name,
                                       field(slot).space->region().name, input_.region.name));
        for (int node : nodes) batch.nodes[block++ * lanes_per_batch + lane] = node;
      }
    }
    place(batch_count() - 1);
  }

  /// The geometry of a batch at the current t.
  void place(int b) {
    const Kind& k = kind(b);
    double* points = points_.data() + first_entry_[static_cast<std::size_t>(b)];
    for (std::size_t lane = 0; lane < lanes_per_batch; ++lane) {
      const Cell& entity = cell(batch(b).cells[lane]);
      const std::vector<GeometryJet> jets = reference_.at(entity, k.quadrature->points);
      for (std::size_t p = 0; p < jets.size(); ++p) {
        SurfaceGeometry g = surface_geometry(jets[p]);
        const std::size_t place = first_place_[static_cast<std::size_t>(b)] + p * lanes_per_batch + lane;
        if (constants_.vary()) positions_[place] = input_.reference_position ? geometry(*input_.mesh, entity, k.quadrature->points[p]).x : g.x;
        if (constants_.prestretched()) {
          const CellFrame frame = cell_frame(jets[p], 2);
          g = stretched(g, {frame.t[0], frame.t[1]}, constants_.prestretch_at(constants_.vary() ? positions_[place] : g.x, input_.t));
        }
        const double weight = k.quadrature->weights[p] * g.area;
        places_[place] = {g.curvature, weight};
        shell::store_point(points + p * static_cast<std::size_t>(shell::point_entries) * lanes_per_batch, static_cast<int>(lane), g.jacobian(),
                           g.frame, {}, weight);
      }
    }
  }

  Vec3<double> centre(int c) const {
    const CellKind k = cell(c).kind;
    return geometry(*input_.mesh, cell(c), k == CellKind::triangle ? Vec3<double>{{1.0 / 3, 1.0 / 3, 0}} : Vec3<double>{{0.5, 0.5, 0}}).x;
  }

  ShellMaterial<double> material(std::size_t place, const Vec3<double>& otherwise) const {
    return constants_(constants_.vary() ? positions_[place] : otherwise, input_.t);
  }

  /// What this part of selective integration counts of the form of the membrane (with transverse shear) and of the others in cell c.
  ShellForm<double> counted(ShellForm<double> f, bool membrane, const ShellMaterial<double>& m, int c) const {
    if (input_.part == SelectivePart::whole) return f;
    const double relative = m.thickness / diameters_[static_cast<std::size_t>(c)], alpha = std::min(1.0, relative * relative);
    const double in_plane = membrane ? factors_.membrane_constant + factors_.membrane_slope * alpha : factors_.rest;
    const double transverse = membrane ? factors_.shear_constant + factors_.shear_slope * alpha : factors_.rest;
    for (double& x : f.a) x *= in_plane;
    for (double& x : f.b) x *= in_plane;
    for (double& x : f.s) x *= transverse;
    return f;
  }
  ShellForm<double> counted_sum(const std::array<double, 2>& k, const ShellMaterial<double>& m, int c) const {
    ShellForm<double> sum = counted(shell_form(k[0], k[1], m, coupling_, {true, false, false}), true, m, c);
    const ShellForm<double> others = counted(shell_form(k[0], k[1], m, coupling_, {false, true, true}), false, m, c);
    for (std::size_t i = 0; i < sum.a.size(); ++i) sum.a[i] += others.a[i];
    for (std::size_t i = 0; i < sum.b.size(); ++i) sum.b[i] += others.b[i];
    for (std::size_t i = 0; i < sum.s.size(); ++i) sum.s[i] += others.s[i];
    return sum;
  }

  /// Evaluates the parameters at the current t into the data of the kernel. \throws InputError where they do not fit the surface.
  void apply_constants() {
    warnings_.clear();
    double worst = 0;
    std::string complaint;
    int indefinite = 0, first_indefinite = -1;
    bool soft_drilling = false;
    for (int b = 0; b < batch_count(); ++b) {
      double* points = points_.data() + first_entry_[static_cast<std::size_t>(b)];
      for (int lane = 0; lane < W; ++lane) {
        const int c = batch(b).cells[static_cast<std::size_t>(lane)];
        bool good = true;
        for (int p = 0; p < kind(b).tables.points; ++p) {
          const std::size_t place = first_place_[static_cast<std::size_t>(b)] + static_cast<std::size_t>(p * W + lane);
          const ShellMaterial<double> m = material(place, {});
          soft_drilling = soft_drilling || (m.mu_c == 0 && m.internal_length < m.thickness);
          const auto& k = places_[place].curvature;
          const double kappa = std::fabs(k[0]) > std::fabs(k[1]) ? k[0] : k[1], product = m.thickness * std::fabs(kappa);
          if (product >= 2 && product > worst) {
            worst = product;
            complaint = fmt::format(
                "The shell is too thick for the curvature of its reference surface: thickness {:.6g} times principal curvature {:.6g} is {:.6g} in "
                "the cell "
                "around ({:.6g}, {:.6g}, {:.6g}); the absolute value must be less than 2.",
                m.thickness, kappa, m.thickness * kappa, centre(c)[0], centre(c)[1], centre(c)[2]);
          }
          const ShellForm<double> f = shell_form(k[0], k[1], m, coupling_);
          shell::store_form(points + p * shell::point_entries * W, lane, input_.part == SelectivePart::whole ? f : counted_sum(k, m, c),
                            places_[place].weight);
          good = good && semidefinite(f.a) && semidefinite(f.b);
        }
        if (good || lane >= batch(b).cells_used) continue;
        ++indefinite;
        if (first_indefinite < 0) first_indefinite = c;
      }
    }
    if (worst > 0) throw InputError(complaint);
    if (soft_drilling)
      warnings_.emplace_back(
          "cosserat-shell: the couple modulus mu_c is 0 and L_c below the thickness, so hardly anything holds the drilling rotations, and the "
          "shell gives way to tension by wrinkling them. A classical shell has mu_c = mu.");
    if (indefinite > 0)
      warnings_.push_back(
          fmt::format("cosserat-shell: the shell is so thick for its curvature that the energy density is not positive definite in {} cells, the "
                      "first {}: terms of the "
                      "expansion in the thickness outweigh those they should correct.",
                      indefinite, shell_place(centre(first_indefinite))));
  }

  /// Integrals over the cells of batch b of the quadratic forms form(index into places_, cell) of the strains; infinite where the interpolation is not defined.
  template <class Form>
  std::array<double, lanes_per_batch> integrals(const Configuration& u, int b, const Form& form) const {
    const auto entries = static_cast<std::size_t>(kind(b).tables.points * shell::point_entries * W);
    const double* first = points_.data() + first_entry_[static_cast<std::size_t>(b)];
    AlignedVector<double> points(first, first + entries);
    for (int p = 0; p < kind(b).tables.points; ++p)
      for (int lane = 0; lane < W; ++lane) {
        const std::size_t place = first_place_[static_cast<std::size_t>(b)] + static_cast<std::size_t>(p * W + lane);
        shell::store_form(points.data() + p * shell::point_entries * W, lane, form(place, batch(b).cells[static_cast<std::size_t>(lane)]),
                          places_[place].weight);
      }
    alignas(64) std::array<double, lanes_per_batch> sum;
    std::array<Trouble, lanes_per_batch> trouble;
    run(u, b, Want::energy, points.data(), {sum.data(), trouble.data()});
    return sum;
  }

  void run(const Configuration& u, int b, Want want, const double* points, const shell::Output& out) const {
    const Kind& k = kind(b);
    alignas(64) double m[static_cast<std::size_t>(shell::max_nodes * 3 * W)], q[static_cast<std::size_t>(shell::max_nodes * 4 * W)];
    const int* nodes = batch(b).nodes.data();
    for (int i = 0; i < k.tables.m_nodes; ++i)
      for (int lane = 0; lane < W; ++lane) {
        const double* x = u.at(input_.fields[0], *nodes++, 3);
        for (int c = 0; c < 3; ++c) m[(3 * i + c) * W + lane] = x[c];
      }
    for (int i = 0; i < k.tables.r_nodes; ++i)
      for (int lane = 0; lane < W; ++lane) {
        const double* x = u.at(input_.fields[1], *nodes++, 4);
        for (int c = 0; c < 4; ++c) q[(4 * i + c) * W + lane] = x[c];
      }
    k.kernels[static_cast<std::size_t>(want)](k.tables, points, m, q, out);
  }

  TermInfo info_;
  TermInput input_;
  ShellConstants constants_;
  ReferenceGeometry reference_;
  SelectiveFactors factors_;
  std::vector<double> diameters_;  // by cell, with selective integration
  ShellCoupling coupling_ = ShellCoupling::standard;
  std::vector<Kind> kinds_;
  std::vector<Batch> batches_;
  std::vector<std::size_t> kind_, first_entry_, first_place_;  // of every batch
  AlignedVector<double> points_;                               // as the kernel reads them
  std::vector<Place> places_;                                  // [batch][point][lane]
  std::vector<Vec3<double>> positions_;                        // on the mesh, the same; only where parameters vary
  std::vector<std::string> warnings_;
};

}  // namespace

int default_shell_degree(CellKind kind, int highest_order) {
  if (highest_order == 1) return kind == CellKind::triangle ? 2 : 3;
  return highest_order == 2 ? 5 : 7;
}

std::unique_ptr<Term> make_shell_term(TermInfo info, TermInput input) { return std::make_unique<ShellTerm>(std::move(info), std::move(input)); }

}  // namespace karcher
