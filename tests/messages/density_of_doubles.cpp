#include "karcher/karcher.hpp"

struct OfDoubles {
  double operator()(const karcher::FieldJet<karcher::Sphere<2>, 2, double>& u) const { return norm2(u.d[0]); }
};

void f(const karcher::GeometricSpace<karcher::Sphere<2>, 2>& space) { karcher::integral(space, OfDoubles{}); }
