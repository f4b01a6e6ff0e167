#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "host/planner/plan/check.hpp"

/// Private to check.
namespace pinjaw::planner {

/// Collects claims about one design.
class ClaimList {
 public:
  explicit ClaimList(std::string subject) : subject_(std::move(subject)) {}

  void claim(std::string what, bool holds, std::string found = {}) {
    claims_.push_back({subject_, std::move(what), holds, holds ? std::string() : std::move(found)});
  }
  void equal(const std::string& what, double stated, double recomputed, double tolerance) {
    const bool holds =
        std::abs(stated - recomputed) <= tolerance || (std::isinf(stated) && stated == recomputed);
    claim(what, holds, fmt::format("stated {:.9g}, recomputed {:.9g}", stated, recomputed));
  }
  std::vector<Claim> take() { return std::move(claims_); }

 private:
  std::string subject_;
  std::vector<Claim> claims_;
};

}  // namespace pinjaw::planner
