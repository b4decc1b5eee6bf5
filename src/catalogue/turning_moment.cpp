#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "catalogue/entry.hpp"
#include "karcher/assembly/cell_batches.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher::catalogue {
namespace {

constexpr std::size_t W = native_width;

/// A moment M on rotations that turn about one axis only: the potential - sum_i (int N_i M) . a_i theta_i over the nodes, a_i the axis in space, theta_i the angle from the start.
///
/// Where all three axes are free, M . dtheta is no differential: M about e_1 and then about e_2 works otherwise than in the other order.
class TurningMoment : public Term {
 public:
  TurningMoment(const EnergyInfo& info, const TermInput& input)
      : info_(term_info(info, input)),
        field_(input.fields.front()),
        batches_(input, [&](CellKind) { return 2 * input.field(0).space->order(); }),
        axes_(input.free_axes) {
    if (axes_.size() != static_cast<std::size_t>(input.field(0).space->node_count()))
      throw InputError(fmt::format("A moment on \"{}\" needs to be told the axis about which its nodes turn.", input.field(0).name));
    const Configuration start = input.start();
    for (std::size_t i = 0; i < axes_.size(); ++i) start_.push_back(manifold_detail::read<4>(start.at(field_, static_cast<int>(i), 4)));
    for (int c = 0; c < 3; ++c) value_.push_back(input.parameters.at(fmt::format("value[{}]", c)));
    for (int b = 0; b < batches_.count(); ++b) moments_.emplace_back(batches_.kind(b).blocks.size() * W);
    integrate(input.t);
  }

  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return batches_.count(); }
  const Batch& batch(int b) const override { return batches_.batch(b); }
  const Cell& cell(int c) const override { return batches_.cell(c); }
  void set_load_parameter(double t) override {
    for (const ParameterValue& v : value_)
      if (v.depends_on_t) return integrate(t);
  }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    const Batch& cells = batches_.batch(b);
    out.energy.fill(0);
    out.trouble.fill(Trouble::none);
    for (std::size_t n = 0; n < batches_.kind(b).blocks.size(); ++n)
      for (std::size_t lane = 0; lane < W; ++lane) {
        const int node = cells.nodes[n * W + lane];
        const auto q = manifold_detail::read<4>(u.at(field_, node, 4));
        const Vec3<double>& moment = moments_[static_cast<std::size_t>(b)][n * W + lane];
        if (const int axis = axes_[static_cast<std::size_t>(node)]; axis >= 0)
          out.energy[lane] -= work(moment, start_[static_cast<std::size_t>(node)], q, axis);
        if (want == Want::energy) continue;
        // Also of what is held: the work in any direction, of which the support's reaction is made.
        const Vec3<double> along = transpose_times(rotation_matrix(q), moment);
        for (std::size_t c = 0; c < 3; ++c) out.gradient[(3 * n + c) * W + lane] = -along[static_cast<int>(c)];
      }
    if (want == Want::hessian) std::fill(out.hessian.begin(), out.hessian.end(), 0.0);
  }

 private:
  /// moment . a theta. A unit quaternion tells an angle up to 4 pi; of these the one between -pi and 3 pi in the direction in which the moment turns.
  static double work(const Vec3<double>& moment, const Vec<double, 4>& start, const Vec<double, 4>& q, int axis) {
    constexpr double pi = std::numbers::pi;
    const Vec<double, 4> turn = quaternion_product(conjugate(start), q);
    const double strength = dot(moment, Rotation::director(start, axis));
    double theta = 2 * std::atan2(turn[1 + axis], turn[0]);
    if (strength < 0) theta = -theta;
    if (theta < -pi) theta += 4 * pi;
    return std::fabs(strength) * theta;
  }

  /// int N_i M over every cell.
  void integrate(double t) {
    for (int b = 0; b < batches_.count(); ++b) {
      const KindData& kind = batches_.kind(b);
      const std::size_t nodes = kind.blocks.size();
      std::vector<Vec3<double>>& sums = moments_[static_cast<std::size_t>(b)];
      std::fill(sums.begin(), sums.end(), Vec3<double>{});
      for (int p = 0; p < kind.quadrature->size(); ++p)
        for (std::size_t lane = 0; lane < W; ++lane) {
          const BatchPoint& point = batches_.point(b, p);
          const auto l = static_cast<int>(lane);
          Vec3<double> x, moment;
          for (int c = 0; c < 3; ++c) x[c] = karcher::lane(point.x[c], l);
          for (int c = 0; c < 3; ++c) moment[c] = karcher::lane(point.weight, l) * value_[static_cast<std::size_t>(c)](x, t);
          for (std::size_t n = 0; n < nodes; ++n) sums[n * W + lane] += kind.shapes[0].value[static_cast<std::size_t>(p) * nodes + n] * moment;
        }
    }
  }

  TermInfo info_;
  int field_;
  CellBatches batches_;
  std::vector<signed char> axes_;                   ///< by node
  std::vector<Vec<double, 4>> start_;               ///< by node
  std::vector<ParameterValue> value_;               ///< components of M
  std::vector<std::vector<Vec3<double>>> moments_;  ///< by batch: [node * W + lane]
};

}  // namespace

std::vector<Entry> turning_moment_entries() {
  EnergyInfo e;
  e.type = "moment";
  e.load = true;
  e.description =
      "Moment that keeps its direction in space, per reference length or area, or at every node of the region: - sum (int N_i M).a_i theta_i over "
      "the nodes.\n"
      "Only where the rotation turns about one axis a: value = {axis-free = \"e3\"} under [[dirichlet]], or a plane of symmetry. theta is the angle "
      "from the start, "
      "between -pi and 3 pi in the direction of the moment.";
  e.dimensions = {0, 1, 2};
  e.fields = {{.key = "field", .manifolds = {&manifold_ops<Rotation>()}, .description = "the rotation on which it works"}};
  e.parameters = {{.name = "value",
                   .unit = "force*length/measure",
                   .description = "the moment as a vector in space; what is across the free axis, the support takes",
                   .default_value = {},
                   .size = 3}};
  e.one_axis = true;
  return {{e, [](const EnergyInfo& info, const TermInput& input) -> std::unique_ptr<Term> { return std::make_unique<TurningMoment>(info, input); }}};
}

}  // namespace karcher::catalogue
