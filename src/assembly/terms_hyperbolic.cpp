#include "karcher/manifold/hyperbolic.hpp"
#include "single_field_terms.hpp"

namespace karcher {

template std::unique_ptr<Term> make_harmonic_term<Hyperbolic<2>>(TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Hyperbolic<2>>(TermInput);
template std::unique_ptr<Term> make_harmonic_term<Hyperbolic<3>>(TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Hyperbolic<3>>(TermInput);

}  // namespace karcher
