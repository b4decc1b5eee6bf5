#include "solve/subproblems.hpp"

#include "solve/direct_subproblem.hpp"

namespace karcher {
namespace {

template <class S>
std::unique_ptr<Subproblem> make(const SubproblemInput& input) {
  return std::make_unique<S>(input);
}

constexpr SubproblemKind table[] = {
    {"direct", make<DirectSubproblem>},
};

}  // namespace

std::span<const SubproblemKind> subproblems() { return table; }

}  // namespace karcher
