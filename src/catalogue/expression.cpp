#include "catalogue/of_manifolds.hpp"
#include "karcher/assembly/formula_term.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<FieldKernel> expression_kernel(const Field& field, int directions);

}  // namespace karcher::catalogue

#ifdef KARCHER_MANIFOLD

namespace karcher::catalogue {

template <class M>
std::unique_ptr<FieldKernel> expression_kernel(const Field& field, int directions) {
  return directions == 0   ? field_kernel<M, 0>(field)
         : directions == 1 ? field_kernel<M, 1>(field)
         : directions == 2 ? field_kernel<M, 2>(field)
                           : field_kernel<M, 3>(field);
}
template std::unique_ptr<FieldKernel> expression_kernel<KARCHER_MANIFOLD>(const Field&, int);

}  // namespace karcher::catalogue

#else

namespace karcher::catalogue {

std::vector<Entry> expression_entries() {
  EnergyInfo info;
  info.type = "expression";
  info.description = "Any density of one to three fields, a formula in their values, derivatives, body rates and directors; derivatives are exact.";
  info.dimensions = {0, 1, 2, 3};
  info.formula = true;
  return {{info, [](const EnergyInfo& entry, const TermInput& input) {
             if (!input.formula) throw InputError("An energy of the type \"" + entry.type + "\" needs a formula for its density.");
             return formula_term(term_info(entry, input), input, *input.formula, [](const Field& field, int directions) {
               return of_manifolds(EveryManifold{}, field, [&]<class M>() { return expression_kernel<M>(field, directions); });
             });
           }}};
}

}  // namespace karcher::catalogue

#endif
