#include "app/point_value.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/section.hpp"

namespace karcher::app {

PointValue::PointValue(const Value& value, const std::string& key, const ManifoldOps& manifold, const Scope& scope)
    : manifold_(&manifold), key_(key), place_(value.place) {
  if (value.is(Value::Kind::text) && value.text == "identity") {
    if (!manifold.has_identity) refuse(place_, key + ": " + manifold.name + " has no identity; write " + manifold.entries.wanted + ".");
    for (const double d : manifold.standard_point) entries_.emplace_back(d);
    return;
  }
  const bool array = value.is(Value::Kind::array);
  if (!array && manifold.ambient > 1)
    refuse(place_, key + " must be " + (array ? "" : "an array: ") + manifold.entries.wanted + ", not " + value.kind_name() + ".");
  const std::size_t count = array ? value.items.size() : 1;
  const std::vector<int>& counts = manifold.entries.counts;
  if (std::find(counts.begin(), counts.end(), static_cast<int>(count)) == counts.end())
    refuse(place_, fmt::format("{} has {} entries, but a point of {} is {}.", key, count, manifold.name, manifold.entries.wanted));
  for (std::size_t i = 0; i < count; ++i)
    entries_.push_back(expression_of(array ? value.items[i] : value, array ? fmt::format("{}.{}", key, i) : key, scope));
  if (std::all_of(entries_.begin(), entries_.end(), [](const Expression& e) { return e.is_constant(); })) {
    std::vector<double> p(static_cast<std::size_t>(manifold.ambient));
    evaluate({}, 0, p.data());
  }
}

PointValue PointValue::constant(std::vector<double> point, const std::string& key, const ManifoldOps& manifold) {
  PointValue v;
  v.manifold_ = &manifold;
  v.key_ = key;
  for (const double d : point) v.entries_.emplace_back(d);
  return v;
}

PointFunction PointValue::function() const {
  return {.value = [self = *this](const MeshPoint& s, double t, double* point) { self.evaluate(s.x, t, point); },
          .depends_on_t = uses_t(),
          .with_derivatives = [self = *this](const Vec3<double>& x, double t) { return self.with_derivatives(x, t); }};
}

bool PointValue::uses_t() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Expression& e) { return e.uses_t(); });
}

void PointValue::evaluate(const Vec3<double>& x, double t, double* point) const {
  std::vector<double> e;
  e.reserve(entries_.size());
  for (const Expression& entry : entries_) e.push_back(entry(x, t));
  if (manifold_->entries.make_point(e.data(), static_cast<int>(e.size()), point)) return;
  std::string numbers;
  for (const double d : e) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", d);
  const bool constant = std::all_of(entries_.begin(), entries_.end(), [](const Expression& entry) { return entry.is_constant(); });
  refuse(place_, fmt::format("{} is [{}]{}, which is no point of {} and cannot be projected to one.", key_, numbers,
                             constant ? std::string() : fmt::format(" at ({}, {}, {}), t = {}", x[0], x[1], x[2], t), manifold_->name));
}

std::vector<Dual<double, 3>> PointValue::with_derivatives(const Vec3<double>& x, double t) const {
  std::vector<Dual<double, 3>> e;
  for (const Expression& entry : entries_) e.push_back(entry.derivative(x, t));
  std::vector<Dual<double, 3>> coordinates(static_cast<std::size_t>(manifold_->error_size));
  manifold_->entries.error_coordinates(e.data(), static_cast<int>(e.size()), coordinates.data());
  return coordinates;
}

}  // namespace karcher::app
