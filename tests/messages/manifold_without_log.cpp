#include "karcher/manifold/any_manifold.hpp"
#include "karcher/manifold/sphere.hpp"

struct WithoutLog {
  static constexpr std::string_view name = "without log";
  static constexpr int ambient = 3, dim = 2;
  static constexpr double injectivity_radius = 1;
  template <class T>
  static karcher::Vec3<T> exp(const karcher::Vec3<T>& p, const karcher::Vec3<T>& a) {
    return karcher::Sphere<2>::exp(p, a);
  }
  template <class T>
  static T inner(const karcher::Vec3<T>&, const karcher::Vec3<T>& a, const karcher::Vec3<T>& b) {
    return dot(a, b);
  }
  template <class T>
  static karcher::Mat<T, 3, 2> frame(const karcher::Vec3<T>& p) {
    return karcher::Sphere<2>::frame(p);
  }
};

const karcher::ManifoldOps& ops = karcher::manifold_ops<WithoutLog>();
