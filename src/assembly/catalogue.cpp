#include "karcher/assembly/catalogue.hpp"

#include <algorithm>
#include <map>

#include "director_terms.hpp"
#include "karcher/assembly/shell_term.hpp"
#include "karcher/energy/chiral_skyrmion.hpp"
#include "karcher/energy/cosserat_shell.hpp"
#include "karcher/energy/dead_load.hpp"
#include "karcher/energy/frank_oseen.hpp"
#include "karcher/energy/harmonic.hpp"
#include "karcher/energy/l2_distance.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/manifold/unitary.hpp"
#include "karcher/text.hpp"

namespace karcher {

// Defined, one manifold at a time, in terms_<manifolds>.cpp.
template <class M>
std::unique_ptr<Term> make_harmonic_term(TermInput input);
template <class M>
std::unique_ptr<Term> make_l2_distance_term(TermInput input);
template <class M>
std::unique_ptr<Term> make_dead_load_term(const std::string& name, TermInput input);

namespace {

template <class... Ms>
struct ManifoldList {};
using EveryManifold = ManifoldList<Euclidean<1>, Euclidean<2>, Euclidean<3>, Sphere<1>, Sphere<2>, Sphere<3>, Rotation, Unitary, Spd<2>, Spd<3>,
                                   Hyperbolic<2>, Hyperbolic<3>>;
using LoadManifold = ManifoldList<Euclidean<1>, Euclidean<2>, Euclidean<3>, Sphere<1>, Sphere<2>, Sphere<3>>;

/// Calls make<M>() for the manifold of the term's first field.
template <class... Ms, class Make>
std::unique_ptr<Term> with_manifold(ManifoldList<Ms...>, const TermInput& input, Make make) {
  const Field& field = input.all_fields[static_cast<std::size_t>(input.fields.front())];
  std::unique_ptr<Term> term;
  const auto attempt = [&]<class M>() {
    if (field.manifold->name == M::name) term = make.template operator()<M>();
  };
  (attempt.template operator()<Ms>(), ...);
  if (!term) throw InputError("Field \"" + field.name + "\" has values in " + field.manifold->name + ", for which this term is not defined.");
  return term;
}

}  // namespace

const std::vector<EnergyInfo>& energy_catalogue() {
  static const std::vector<EnergyInfo> catalogue{cosserat_shell_info(), HarmonicModel::info(), ChiralSkyrmionModel::info(), FrankOseenModel::info(),
                                                 l2_distance_info()};
  return catalogue;
}

const std::vector<EnergyInfo>& load_catalogue() {
  static const std::vector<EnergyInfo> catalogue = dead_load_infos();
  return catalogue;
}

std::unique_ptr<Term> make_term(const std::string& type, TermInput input) {
  if (type == "cosserat-shell") return make_shell_term(std::move(input));
  if (type == "harmonic") return with_manifold(EveryManifold{}, input, [&]<class M>() { return make_harmonic_term<M>(input); });
  if (type == "l2-distance") return with_manifold(EveryManifold{}, input, [&]<class M>() { return make_l2_distance_term<M>(input); });
  if (type == "chiral-skyrmion") return make_chiral_skyrmion_term(std::move(input));
  if (type == "frank-oseen") return make_frank_oseen_term(std::move(input));
  for (const EnergyInfo& load : load_catalogue())
    if (type == load.type + "-load") return with_manifold(LoadManifold{}, input, [&]<class M>() { return make_dead_load_term<M>(type, input); });

  std::vector<std::string> known;
  for (const EnergyInfo& energy : energy_catalogue()) known.push_back(energy.type);
  for (const EnergyInfo& load : load_catalogue()) known.push_back(load.type + "-load");
  throw InputError("There is no energy or load \"" + type + "\". " + suggestion(type, known));
}

}  // namespace karcher
