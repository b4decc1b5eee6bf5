#include "karcher/assembly/cell_batches.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "karcher/error.hpp"
#include "karcher/math/scalar.hpp"
#include "karcher/mesh/orientation.hpp"

namespace karcher {
namespace {

constexpr int W = native_width;

KindData make_kind(CellKind kind, const TermInput& input, int degree) {
  KindData data;
  data.kind = kind;
  data.quadrature = &quadrature(kind, degree);
  for (int f : input.fields) {
    const Field& field = input.all_fields[static_cast<std::size_t>(f)];
    ShapeTable& table = data.shapes.emplace_back();
    table.nodes = node_count(kind, field.space->order());
    for (const auto& xi : data.quadrature->points) {
      const Shape shape = lagrange(kind, field.space->order(), xi);
      table.value.insert(table.value.end(), shape.value.begin(), shape.value.end());
      table.gradient.insert(table.gradient.end(), shape.gradient.begin(), shape.gradient.end());
    }
    data.first_block.push_back(static_cast<int>(data.blocks.size()));
    for (int n = 0; n < table.nodes; ++n) data.blocks.push_back({f, field.manifold->dim});
    data.unknowns += table.nodes * field.manifold->dim;
  }
  return data;
}

/// The orientation of the whole region, of which this rank may hold a part.
Orientation orientation_of(const TermInput& input) {
  const auto whole = input.mesh->regions.find(input.region.name);
  return {*input.mesh, whole != input.mesh->regions.end() ? whole->second : input.region};
}

void set_reference(BatchReference& r, int lane, const GeometryJet& jet, const CellFrame& frame, int dim, int sign) {
  set_lane(r.x, lane, jet.x);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) set_lane(r.tangent[a], lane, frame.t[a]);
  if (dim == 1) set_lane(r.normal, lane, static_cast<double>(sign) * cross(frame.t[0], Vec3<double>{{0, 0, 1}}));
  if (dim != 2) return;
  const Vec3<double> own = cross(jet.d[0], jet.d[1]), normal = (sign / std::sqrt(norm2(own))) * own;
  set_lane(r.normal, lane, normal);
  const double b[2][2] = {{dot(normal, jet.dd[0]), dot(normal, jet.dd[1])}, {dot(normal, jet.dd[1]), dot(normal, jet.dd[3])}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      double sum = 0;
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l) sum += frame.to_frame(i, k) * b[k][l] * frame.to_frame(j, l);
      set_lane(r.b(i, j), lane, sum);
    }
}

}  // namespace

CellBatches::CellBatches(const TermInput& input, const std::function<int(CellKind)>& default_degree, bool with_reference) : region_(input.region) {
  std::map<CellKind, std::vector<int>> by_kind;
  for (std::size_t c = 0; c < region_.cells.size(); ++c) by_kind[region_.cells[c].kind].push_back(static_cast<int>(c));
  kinds_.reserve(by_kind.size());
  const ReferenceGeometry reference(*input.mesh, input.reference_position, input.reference_order);
  std::optional<Orientation> orientation;
  if (with_reference && (region_.dim == 2 || (region_.dim == 1 && input.mesh->dim == 2))) {
    orientation.emplace(orientation_of(input));
    oriented_ = orientation->exists();
  }

  for (const auto& [kind, cells] : by_kind) {
    const auto chosen = input.quadrature_degree.find(kind);
    const KindData& data =
        kinds_.emplace_back(make_kind(kind, input, chosen != input.quadrature_degree.end() ? chosen->second : default_degree(kind)));
    const int dim = dimension(kind);
    for (std::size_t begin = 0; begin < cells.size(); begin += W) {
      Batch& batch = batches_.emplace_back();
      kind_.push_back(static_cast<int>(kinds_.size()) - 1);
      first_point_.push_back(points_.size());
      batch.cells_used = static_cast<int>(std::min<std::size_t>(W, cells.size() - begin));
      batch.blocks = &data.blocks;
      batch.nodes.resize(data.blocks.size() * W);
      points_.resize(points_.size() + static_cast<std::size_t>(data.quadrature->size()));
      for (std::size_t lane = 0; lane < W; ++lane) {
        const int c = cells[std::min(begin + lane, cells.size() - 1)];
        batch.cells[lane] = c;
        const Cell& cell = region_.cells[static_cast<std::size_t>(c)];
        std::size_t block = 0;
        for (int f : input.fields) {
          const Field& field = input.all_fields[static_cast<std::size_t>(f)];
          const std::vector<int> nodes = field.space->entity_nodes(cell);
          if (nodes.empty())
            throw InputError(fmt::format("Field \"{}\" lives on region \"{}\", which does not contain all of region \"{}\".", field.name,
                                         field.space->region().name, region_.name));
          for (int n : nodes) batch.nodes[block++ * W + lane] = n;
        }
        if (with_reference) references_.resize(points_.size());
        const int sign = orientation ? orientation->sign(cell) : 1;
        const auto jets = reference.at(cell, data.quadrature->points);
        for (std::size_t q = 0; q < jets.size(); ++q) {
          const CellFrame frame = cell_frame(jets[q], dim);
          BatchPoint& p = points_[first_point_.back() + q];
          const auto l = static_cast<int>(lane);
          set_lane(p.weight, l, data.quadrature->weights[q] * frame.measure);
          if (with_reference) set_reference(references_[first_point_.back() + q], l, jets[q], frame, dim, sign);
          // Expressions are functions of the mesh point, wherever the stress-free configuration puts it.
          const Vec3<double> x = input.reference_position ? geometry(*input.mesh, cell, data.quadrature->points[q]).x : jets[q].x;
          for (int a = 0; a < 3; ++a) {
            set_lane(p.x[a], l, x[a]);
            for (int b = 0; b < 3; ++b) set_lane(p.to_frame[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)], l, frame.to_frame(a, b));
          }
        }
      }
    }
  }
}

}  // namespace karcher
