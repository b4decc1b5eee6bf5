#include "solve/multiply.hpp"

#include <gtest/gtest.h>

#include "solve/distributed.hpp"
#include "solve/random_matrix.hpp"

namespace karcher {
namespace {

using testing::Distributed;
using testing::random_vector;

TEST(Multiply, IsTheDenseProductForEveryBlockSizeWithAndWithoutFixedUnknowns) {
  for (const int bs : {1, 2, 3, 4, 6}) {
    const int n = 4 * bs;
    std::vector<double> eigenvalues;
    for (int k = 0; k < n; ++k) eigenvalues.push_back(k - 2.5);
    const auto a = testing::matrix_with(eigenvalues, 5);
    const Distributed d(bs, a, n);
    const auto x = random_vector(n, 6);
    for (const bool some_fixed : {false, true}) {
      std::vector<double> flags(static_cast<std::size_t>(n), 0.0), expected(flags);
      if (some_fixed) flags[1 % flags.size()] = flags[static_cast<std::size_t>(n) - 1] = 1;
      for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < x.size(); ++j)
          if (!flags[i] && !flags[j]) expected[i] += a[i * x.size() + j] * x[j];
      const auto local_flags = d.local(flags);
      const std::vector<char> fixed(local_flags.begin(), local_flags.end());
      std::vector<double> y(x.size(), 7.0);
      multiply(d.exchange, d.matrix, some_fixed ? std::span<const char>(fixed) : std::span<const char>(), d.local(x), y);
      const auto found = d.global(y);
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << bs << " " << i;
    }
  }
}

}  // namespace
}  // namespace karcher
