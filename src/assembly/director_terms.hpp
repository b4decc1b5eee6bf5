#pragma once

#include <memory>

#include "karcher/assembly/catalogue.hpp"

namespace karcher {

std::unique_ptr<Term> make_chiral_skyrmion_term(TermInput input);
std::unique_ptr<Term> make_frank_oseen_term(TermInput input);

}  // namespace karcher
