#pragma once

#include <string>
#include <vector>

#include "host/planner/why/suggest.hpp"

/// What `why` says of near misses and suggestions, as text and as JSON.
namespace pinjaw::app {

struct Advice {
  std::vector<planner::NearMiss> misses;
  planner::Suggestions suggestions;  ///< empty where the plan has designs
};

inline constexpr const char* kSuggestionsHeading = "what would help, each tried with a whole plan:";

std::string misses_text(const std::vector<planner::NearMiss>& misses);
/// One line.
std::string suggestion_text(const planner::Suggestion& suggestion);
/// What was tried in vain and what was not tried.
std::string rest_text(const Advice& advice);

std::string why_json(const planner::Plan& plan, const Advice& advice);

}  // namespace pinjaw::app
