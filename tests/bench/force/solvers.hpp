#pragma once

#include "tests/bench/force/cases.hpp"

/// The squeeze program's peers, each with the options that suit it best of those tried. Each solves every
/// load of a case and returns the sum of the forces, so that nothing is optimised away and answers can be
/// compared.
namespace pinjaw::bench {

/// GLPK's dual simplex from the last load's basis, or its primal simplex from the slack basis.
double sum_by_glpk(const Case& one, bool warm);

/// CLP's dual simplex from the last load's basis, plain or with its factorisation kept too: dual(0, 7).
double sum_by_clp(const Case& one, bool keep_factorisation);

/// A dense two-phase tableau on Eigen's fixed sizes, largest reduced cost, from nothing for each load: what
/// one writes in an hour.
double sum_by_tableau(const Case& one);

}  // namespace pinjaw::bench
