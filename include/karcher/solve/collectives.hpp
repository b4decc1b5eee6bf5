#pragma once
/// \file
/// Collectives: numbers and words on which all ranks agree; they need no layout of unknowns. Sums are taken in the order of the ranks: same ranks, same bits.

#include <span>
#include <string>

namespace karcher {

/// Entry by entry over all ranks, in place; as many entries on every rank.
void sum_over_ranks(std::span<double> values);
double sum_over_ranks(double x);
double max_over_ranks(double x);
bool on_any_rank(bool x);
/// Those of rank 0 become those of all; as many on every rank. For what every rank computes from the same numbers, but with routines that may round as memory
/// happens to lie.
void take_from_first_rank(std::span<double> values);
/// Text of the lowest rank that has one; empty if none has.
std::string first_text(const std::string& text);

}  // namespace karcher
