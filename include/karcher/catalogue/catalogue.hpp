#pragma once
/// \file
/// Catalogue: all energies and loads by name, and the terms made of them.
///
/// An energy is two files: its density with the formula in include/karcher/energy/, and its entry in src/catalogue/ with the table of its parameters and the types that it is
/// compiled for. docs/architecture.md has the recipe.

#include <memory>
#include <string>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/energy/energy_info.hpp"

namespace karcher {

/// In the order of their types.
const std::vector<EnergyInfo>& energy_catalogue();
const std::vector<EnergyInfo>& load_catalogue();

/// \param info  an entry of one of the catalogues
/// \throws InputError with a full sentence if the combination makes no sense (manifold, dimension, thickness against curvature, non-finite data).
std::unique_ptr<Term> make_term(const EnergyInfo& info, TermInput input);
/// \param name  EnergyInfo::term_name() \throws InputError besides for an unknown name
std::unique_ptr<Term> make_term(const std::string& name, TermInput input);

}  // namespace karcher
