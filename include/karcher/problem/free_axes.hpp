#pragma once
/// \file
/// The axes about which rotations turn that can turn about one only.

#include <vector>

#include "karcher/problem/discrete_problem.hpp"

namespace karcher {

/// Of a term with EnergyInfo::one_axis: for every node of its first field, the tangent coordinate (axis of the body) that alone is free in all load steps; -1 where all are held, and off
/// the term's region. \throws InputError with the place of a node that is freer, or whose axis changes
std::vector<signed char> free_axes(const TermSpec& term, const Discretisation& d);

}  // namespace karcher
