#include "karcher/manifold/spd.hpp"
#include "single_field_terms.hpp"

namespace karcher {

template std::unique_ptr<Term> make_harmonic_term<Spd<2>>(TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Spd<2>>(TermInput);

}  // namespace karcher
