#include "app/point_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "app/section.hpp"
#include "karcher/manifold/polar.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher::app {
namespace {

bool starts_with(const ManifoldOps& m, const char* prefix) { return m.name.starts_with(prefix); }

std::string entries_wanted(const ManifoldOps& m) {
  if (m.name == "SO3") return "a rotation vector (3 entries), a matrix by rows (9), a quaternion (4) or \"identity\"";
  return fmt::format("{} number{} or expression{}", m.ambient, m.ambient == 1 ? "" : "s", m.ambient == 1 ? "" : "s");
}

bool has_identity(const ManifoldOps& m) { return m.name == "SO3" || m.name == "SU2" || starts_with(m, "SPD"); }

template <class T>
std::vector<T> matrix_coordinates(const Mat3<T>& r) {
  std::vector<T> result;
  for (const T& x : r.e) result.push_back(x * (0.5 * std::numbers::sqrt2));
  return result;
}

/// \sa PointValue: the rotation that 3, 4 or 9 entries stand for.
template <class T>
Mat3<T> rotation_of(const std::vector<T>& e) {
  if (e.size() == 3) return rotation_matrix(quaternion_of_rotation_vector(Vec3<T>{{e[0], e[1], e[2]}}));
  if (e.size() == 4) return rotation_matrix(Quaternion<T>{{e[0], e[1], e[2], e[3]}});
  Mat3<T> r;
  std::copy(e.begin(), e.end(), r.e.begin());
  return r;
}

}  // namespace

PointValue::PointValue(const Value& value, const std::string& key, const ManifoldOps& manifold, const Scope& scope)
    : manifold_(&manifold), key_(key), place_(value.place) {
  if (value.is(Value::Kind::text) && value.text == "identity") {
    if (!has_identity(manifold)) refuse(place_, key + ": " + manifold.name + " has no identity; write " + entries_wanted(manifold) + ".");
    for (const double d : standard_point(manifold)) entries_.emplace_back(d);
    return;
  }
  const bool array = value.is(Value::Kind::array);
  if (!array && manifold.ambient > 1)
    refuse(place_, key + " must be " + (array ? "" : "an array: ") + entries_wanted(manifold) + ", not " + value.kind_name() + ".");
  const std::size_t count = array ? value.items.size() : 1;
  const bool right_count = count == static_cast<std::size_t>(manifold.ambient) || (manifold.name == "SO3" && (count == 3 || count == 9));
  if (!right_count) refuse(place_, fmt::format("{} has {} entries, but a point of {} is {}.", key, count, manifold.name, entries_wanted(manifold)));
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

bool PointValue::uses_t() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Expression& e) { return e.uses_t(); });
}

void PointValue::evaluate(const Vec3<double>& x, double t, double* point) const {
  std::vector<double> e;
  e.reserve(entries_.size());
  for (const Expression& entry : entries_) e.push_back(entry(x, t));
  bool good = true;
  if (manifold_->name == "SO3" && e.size() != 4) {
    Quaternion<double> q;
    if (e.size() == 3) {
      q = quaternion_of_rotation_vector(Vec3<double>{{e[0], e[1], e[2]}});
    } else {
      const auto polar = polar_factor(rotation_of(e));
      good = polar.defined;
      q = polar.q;
    }
    std::copy(q.e.begin(), q.e.end(), point);
  } else {
    good = manifold_->make_point(e.data(), point);
  }
  if (good) return;
  std::string numbers;
  for (const double d : e) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", d);
  const bool constant = std::all_of(entries_.begin(), entries_.end(), [](const Expression& entry) { return entry.is_constant(); });
  refuse(place_, fmt::format("{} is [{}]{}, which is no point of {} and cannot be projected to one.", key_, numbers,
                             constant ? std::string() : fmt::format(" at ({}, {}, {}), t = {}", x[0], x[1], x[2], t), manifold_->name));
}

std::vector<Dual<double, 3>> PointValue::with_derivatives(const Vec3<double>& x, double t) const {
  std::vector<Dual<double, 3>> e;
  for (const Expression& entry : entries_) e.push_back(entry.derivative(x, t));
  return manifold_->name == "SO3" ? matrix_coordinates(rotation_of(e)) : e;
}

std::vector<double> standard_point(const ManifoldOps& m) {
  std::vector<double> p(static_cast<std::size_t>(m.ambient), 0.0);
  if (m.name == "SO3" || m.name == "SU2" || starts_with(m, "H"))
    p.front() = 1;
  else if (starts_with(m, "SPD"))
    for (std::size_t i = 0, n = m.name == "SPD2" ? 2 : 3; i < n; ++i) p[i * n + i] = 1;
  else if (starts_with(m, "S"))
    p.back() = 1;
  return p;
}

std::vector<double> error_coordinates(const ManifoldOps& m, const double* p) {
  if (m.name == "SO3") return matrix_coordinates(rotation_matrix(Quaternion<double>{{p[0], p[1], p[2], p[3]}}));
  return {p, p + m.ambient};
}

std::vector<double> error_derivative(const ManifoldOps& m, const double* p, const double* dp) {
  if (m.name != "SO3") return {dp, dp + m.ambient};
  Quaternion<Dual<double, 1>> q;
  for (int i = 0; i < 4; ++i) {
    q[i] = Dual<double, 1>(p[i]);
    q[i].d[0] = dp[i];
  }
  std::vector<double> result;
  for (const auto& x : matrix_coordinates(rotation_matrix(q))) result.push_back(x.d[0]);
  return result;
}

}  // namespace karcher::app
