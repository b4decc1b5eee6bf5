// Formulas: every line of the input but the last defines a name (a, b, ... z, then a again, which is refused); the last is compiled, linked and evaluated.

#include <array>
#include <bit>
#include <cmath>

#include "fuzz/fuzzing.hpp"
#include "karcher/expression/symbols.hpp"
#include "karcher/math/dual.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karcher;
  using Slope = Dual<double, 3>;
  fuzzing::take_or_refuse([&] {
    std::string_view rest = fuzzing::text_of(data, size);
    Symbols symbols({"x", "y", "z", "t"});
    char name = 'a';
    for (std::size_t end; (end = rest.find('\n')) != std::string_view::npos;
         rest.remove_prefix(end + 1), name = name == 'w' ? 'a' : static_cast<char>(name + 1))
      symbols.define(std::string(1, name), symbols.compile(rest.substr(0, end)));
    const Program program = symbols.link(symbols.compile(rest));
    for (const double s : {0.0, -0.75, 3.0, 1e300}) {
      const std::array<double, 4> at{s, 0.5, s + 1, 2};
      std::array<Slope, 4> slopes;
      for (std::size_t i = 0; i < 4; ++i) {
        slopes[i] = at[i];
        if (i < 3) slopes[i].d[i] = 1;
      }
      program.evaluate<double>(at);
      program.evaluate<Slope>(slopes);
    }
  });
  return 0;
}
