#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/unitary.hpp"
#include "single_field_terms.hpp"

namespace karcher {

template std::unique_ptr<Term> make_harmonic_term<Rotation>(TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Rotation>(TermInput);
template std::unique_ptr<Term> make_harmonic_term<Unitary>(TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Unitary>(TermInput);

}  // namespace karcher
