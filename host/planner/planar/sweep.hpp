#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "host/planner/planar/candidate.hpp"
#include "host/planner/planar/piece.hpp"

namespace pinjaw::planner::planar {

/// Told after each share of a sweep; a stop request is looked at as often.
struct Watch {
  std::function<void(double)> progress;
  std::stop_token stop;
};

/// Two pins a jaw, theta in [0, pi]: crossings of the left pairs' curves with the right pairs' (the left ones
/// turned). In no order and perhaps twice; the same set for any number of threads.
std::vector<Candidate> two_and_two(const std::vector<Piece>& pieces, const Judge& judge,
                                   const model::Kit& kit, const Watch& watch);

/// Three pins on the left jaw, one on the right, theta in [0, 2 pi): crossings of the curves of two left
/// pairs that share their lowest pin, then every right contact in every row. In no order and perhaps twice.
std::vector<Candidate> three_and_one(const std::vector<Piece>& pieces,
                                     const std::vector<ContactCurve>& curves, const Judge& judge,
                                     const model::Kit& kit, const Watch& watch);

}  // namespace pinjaw::planner::planar
