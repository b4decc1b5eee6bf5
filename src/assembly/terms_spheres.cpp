#include "karcher/manifold/sphere.hpp"
#include "single_field_terms.hpp"

namespace karcher {

template std::unique_ptr<Term> make_harmonic_term<Sphere<1>>(TermInput);
template std::unique_ptr<Term> make_dead_load_term<Sphere<1>>(const std::string&, TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Sphere<1>>(TermInput);
template std::unique_ptr<Term> make_harmonic_term<Sphere<2>>(TermInput);
template std::unique_ptr<Term> make_dead_load_term<Sphere<2>>(const std::string&, TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Sphere<2>>(TermInput);
template std::unique_ptr<Term> make_harmonic_term<Sphere<3>>(TermInput);
template std::unique_ptr<Term> make_dead_load_term<Sphere<3>>(const std::string&, TermInput);
template std::unique_ptr<Term> make_l2_distance_term<Sphere<3>>(TermInput);

}  // namespace karcher
